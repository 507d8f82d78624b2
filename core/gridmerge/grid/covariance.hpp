#pragma once
/// How uncertain a pose is, and how that uncertainty travels through SE(2).
#include <Eigen/Core>
#include <optional>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// Covariance of (x [m], y [m], theta [rad]) of a pose, in the pose's own (left, target) frame: symmetric, >= 0.
using PoseCovariance = Eigen::Matrix3d;

struct PoseEstimate {
  Pose2 pose;
  std::optional<PoseCovariance> covariance;  ///< none: not known
};

/// First-order propagation of independent errors through Eq. 3.1 (Smith, Self, Cheeseman 1990, "compounding").
[[nodiscard]] PoseEstimate compose(const PoseEstimate& a_from_b, const PoseEstimate& b_from_c);

/// First-order propagation through Eq. 3.3.
[[nodiscard]] PoseEstimate inverse(const PoseEstimate& a_from_b);

}  // namespace gridmerge
