#pragma once
/// Options of the house as arguments of a command.
#include <stdexcept>
#include <string>

#include "cli/usage_error.hpp"
#include "gridmerge/base/options.hpp"

namespace CLI {
class App;
}

namespace gridmerge::cli {

/// One `--key` for each option, with its unit, meaning and range. What the list is bound to outlives the command.
void add_options(CLI::App& command, const OptionList& list);

/// @throws UsageError with every option that is out of range
template <typename Options>
void check_options(Options& options, const std::string& command) {
  try {
    require_valid(options, command);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace gridmerge::cli
