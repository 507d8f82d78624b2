#pragma once
/// The pose between two maps from points that somebody marked in both.
#include <utility>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// One spot in both maps.
struct PointMatch {
  Point2 in_target;
  Point2 in_source;
};

/// A rigid fit, and how well it fits.
struct PointFit {
  Pose2 target_from_source;
  double residual_m = 0;  ///< root mean square of what is left between the points
};

/// Least squares over rotation and translation [umeyama1991, without scale], for at least two points.
[[nodiscard]] PointFit fit_points(const std::vector<PointMatch>& matches);

/// How many target units a source unit measures: the ratio of the spreads of both sets round their centres
/// [horn1987, the symmetric form]; 0 or not finite, if all points of one map are the same.
[[nodiscard]] double scale_between(const std::vector<PointMatch>& matches);

}  // namespace gridmerge
