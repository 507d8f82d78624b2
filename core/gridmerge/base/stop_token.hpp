#pragma once
/// When to stop early: a deadline, a budget of iterations, or somebody's word.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <optional>

namespace gridmerge {

/// Polled by every long computation every few milliseconds. Copies share one cancel flag, which any thread may set.
/// A deadline makes an answer depend on the machine's speed; a budget of iterations does not.
class StopToken {
 public:
  using Clock = std::chrono::steady_clock;

  StopToken() = default;

  [[nodiscard]] static StopToken after(std::chrono::duration<double> time) {
    StopToken token;
    token.deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
    return token;
  }
  /// The same token, with at most `iterations` (>= 0) of a method's own iterations.
  [[nodiscard]] StopToken with_iterations(int iterations) const {
    StopToken token = *this;
    token.iterations_ = iterations;
    return token;
  }

  void cancel() const { *cancelled_ = true; }
  [[nodiscard]] bool stop_requested() const { return *cancelled_ || (deadline_ && Clock::now() >= *deadline_); }
  /// Until the deadline, 0 when it is past; none where there is no deadline.
  [[nodiscard]] std::optional<double> seconds_left() const {
    if (!deadline_) {
      return std::nullopt;
    }
    return std::max(0.0, std::chrono::duration<double>(*deadline_ - Clock::now()).count());
  }
  [[nodiscard]] int iteration_budget() const { return iterations_; }

 private:
  std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
  std::optional<Clock::time_point> deadline_;
  int iterations_ = std::numeric_limits<int>::max();
};

}  // namespace gridmerge
