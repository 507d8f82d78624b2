#pragma once
/// What is thrown when the outside world is wrong: a file, a YAML document, a message.
#include <stdexcept>
#include <string>

namespace gridmerge {

/// Something that came from outside breaks a rule. The text names the file, the key, the value and the rule.
/// Caught only in `main` and in the ROS node. (That two maps cannot be aligned is no error: it is an Outcome.)
class InputError : public std::runtime_error {
 public:
  /// @param where  file name, command-line option or topic
  /// @param what   key, value and the rule broken, in one sentence without a full stop
  InputError(const std::string& where, const std::string& what) : std::runtime_error(where + ": " + what) {}
};

}  // namespace gridmerge
