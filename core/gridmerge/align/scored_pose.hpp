#pragma once
/// Poses with a score, as methods pass them from one step to the next.
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/align/wall_fit.hpp"

namespace gridmerge {

struct ScoredPose {
  Pose2 pose;        ///< between local frames
  double score = 0;  ///< higher is better
};

/// How near two poses are that count as one answer: both bounds must be kept.
struct PoseReach {
  double distance_m = 0;  ///< between what they make of the source's local origin
  double angle_rad = 0;
};

/// The best of every neighbourhood, best first: a pose is left out where a better one lies within reach.
[[nodiscard]] std::vector<ScoredPose> distinct_poses(std::vector<ScoredPose> poses, PoseReach reach,
                                                     std::size_t at_most);

/// Uphill from a pose: the best of the neighbours one step away each way in x, y and angle, until none is better; then
/// with half the step, down to the `last` one. Never leaves the window, and never ends lower than it began.
[[nodiscard]] ScoredPose climb(const WallFit& fitness, const Pose2& start, PoseReach first_step, PoseReach last_step,
                               const std::optional<PoseWindow>& window);

/// As candidates, between the map frames.
[[nodiscard]] std::vector<Candidate> candidates_of(const std::vector<ScoredPose>& poses, const AlignRequest& request);

}  // namespace gridmerge
