#pragma once
/// The one exception of the command line, and how the program ends.
#include <stdexcept>

namespace gridmerge::cli {

/// What the shell sees. Documented in `--help` and README.md.
enum ExitStatus : int {
  kDone = 0,        ///< merged; or the command has nothing to merge and did what it was asked
  kInputError = 1,  ///< a file is wrong or cannot be written
  kWrongUsage = 2,  ///< the command line is wrong
  kNotMerged = 3,   ///< the maps are not to be merged, or the user stopped the program
};

/// Wrong on the command line, not in a file. The text names option, value and rule.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace gridmerge::cli
