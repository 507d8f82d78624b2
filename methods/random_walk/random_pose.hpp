#pragma once
/// Where walks start.
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/base/random.hpp"

namespace gridmerge {

/// Lays a wall of the source, drawn at random, on one of the target so that both were seen from the same side. The more
/// walls a pose lays on walls, the likelier it, or one beside it, is drawn. None where no wall's side is known.
[[nodiscard]] std::optional<Pose2> wall_on_wall_pose(const AlignRequest& request, RandomStream& random);

/// The same with any two walls, turned anyhow: for walls that were seen from all round.
[[nodiscard]] Pose2 point_on_point_pose(const AlignRequest& request, RandomStream& random);

/// At most `count` poses, all in the window. Half of them are uniform where there is a window; where there is none, a
/// quarter lays a point on a point. The others lay a wall on a wall.
[[nodiscard]] std::vector<Pose2> start_poses(const AlignRequest& request, const std::optional<PoseWindow>& window,
                                             std::size_t count, RandomStream& random);

}  // namespace gridmerge
