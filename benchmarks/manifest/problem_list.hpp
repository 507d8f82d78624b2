#pragma once
/// Problems of several files, told all at once.
#include <string>

#include "gridmerge/base/error.hpp"

namespace gridmerge {

/// Collects what is wrong, and throws it as one exception.
class ProblemList {
 public:
  /// @param problem  "file: rule", as the text of an InputError is
  void add(const std::string& problem) { text_ += (text_.empty() ? "" : "\n") + problem; }

  /// Calls; what it throws of the outside world is a problem.
  template <typename Call>
  void collect(Call&& call) {
    try {
      call();
    } catch (const InputError& error) {
      add(error.what());
    }
  }

  /// @throws InputError with a line or more for each problem, if there are any
  void throw_if_any() const {
    if (!text_.empty()) {
      const std::size_t colon = text_.find(": ");  // InputError puts it back
      throw InputError(text_.substr(0, colon), text_.substr(colon + 2));
    }
  }

 private:
  std::string text_;
};

}  // namespace gridmerge
