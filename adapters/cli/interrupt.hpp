#pragma once
/// Ctrl-C ends a search, not the program: the best so far is still told.
#include <chrono>
#include <csignal>
#include <optional>

#include "gridmerge/base/stop_token.hpp"

namespace gridmerge::cli {

/// A token that stops after so many seconds from now; none: only when it is cancelled.
[[nodiscard]] inline StopToken stop_after(std::optional<double> seconds) {
  return seconds ? StopToken::after(std::chrono::duration<double>(*seconds)) : StopToken{};
}

/// While it lives, the first SIGINT cancels the token; a second one ends the program at once. One at a time.
class Interrupt {
 public:
  explicit Interrupt(StopToken token);
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;
  ~Interrupt();

  [[nodiscard]] bool happened() const;

 private:
  StopToken token_;
  struct sigaction previous_ = {};
};

}  // namespace gridmerge::cli
