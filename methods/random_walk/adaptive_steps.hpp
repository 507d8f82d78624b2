#pragma once
/// The steps of an adaptive random walk: Gaussian, their mean and covariance learnt from the steps that were accepted.
#include <array>
#include <cstddef>
#include <deque>

#include "gridmerge/base/random.hpp"
#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// A displacement in the space of poses: x [m], y [m], theta [rad].
using PoseStep = std::array<double, 3>;

/// The pose moved and turned by a step.
[[nodiscard]] Pose2 stepped(const Pose2& pose, const PoseStep& step);

struct StepRules {
  PoseStep first_sigma{};     ///< standard deviations until steps have been accepted
  double floor_share = 0.25;  ///< no standard deviation falls below this share of the first
  std::size_t memory = 8;     ///< how many accepted steps are remembered, at least 1
  double on_accepted = 1;     ///< factor on the width of all steps
  double on_rejected = 1;     ///< the same
  double mean_fade = 1;       ///< factor on the mean at each rejection
  double least_width = 1;     ///< bounds of the width
  double most_width = 1;
};

/// Steps ~ N(mean, covariance) of the last accepted ones, times a width that success widens and failure narrows. With
/// the factors at 1 it is the published rule.
class AdaptiveSteps {
 public:
  explicit AdaptiveSteps(const StepRules& rules);

  [[nodiscard]] PoseStep draw(RandomStream& random) const;
  void accepted(const PoseStep& step);
  void rejected();
  /// Standard deviation of a step along x and y, root of the mean of the two squares [m].
  [[nodiscard]] double sigma_m() const;

 private:
  void learn();

  StepRules rules_;
  std::deque<PoseStep> last_;  ///< in units of the width that they were drawn with
  PoseStep mean_{};
  std::array<double, 6> root_{};  ///< lower triangle of the Cholesky factor: 00, 10, 11, 20, 21, 22
  double width_ = 1;
  double mean_share_ = 1;
};

}  // namespace gridmerge
