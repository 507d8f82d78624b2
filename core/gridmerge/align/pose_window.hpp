#pragma once
/// Where a search may look.
#include <optional>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/random.hpp"

namespace gridmerge {

/// Where to look: all poses that put the source's local origin within `radius_m` of where `centre` puts it, turned by
/// at most `angle_rad`.
struct PoseWindow {
  Pose2 centre;  ///< between local frames
  double radius_m = 0;
  double angle_rad = kPi;
};

/// The window that a request's prior allows; none: anywhere. (A prior without radius and angle is no fence.)
[[nodiscard]] std::optional<PoseWindow> window_of(const AlignRequest& request);

/// Whether a pose between local frames lies in the window; always, where there is none.
[[nodiscard]] bool inside(const Pose2& local_target_from_source, const std::optional<PoseWindow>& window);

/// Uniform over the window; over every pose at which the maps could touch, where there is none. Between local frames.
[[nodiscard]] Pose2 uniform_pose(const AlignRequest& request, const std::optional<PoseWindow>& window,
                                 RandomStream& random);

}  // namespace gridmerge
