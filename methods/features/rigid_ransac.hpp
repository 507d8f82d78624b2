#pragma once
/// Rigid poses from matched points, many of them wrong (RANSAC, Fischler & Bolles 1981).
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/base/random.hpp"
#include "methods/features/keypoints.hpp"

namespace gridmerge {

/// The rotation and translation, without scale or reflection, that takes the source points nearest to the target points
/// in the least squares sense. At least two matches; none where the points do not say how to turn.
[[nodiscard]] std::optional<Pose2> rigid_fit(const std::vector<KeypointMatch>& matches);

struct RansacRules {
  int samples = 2000;
  double inlier_m = 0.15;  ///< farthest that a match may be off and still agrees
  double apart_m = 0.5;    ///< two points nearer to each other than this say little of the angle
  double turn_rad = kPi;   ///< farthest that a match's own turn may be off the pose's
};

struct RansacPose {
  Pose2 pose;  ///< between local frames
  std::vector<KeypointMatch> inliers;
};

/// The matches that a pose brings together.
[[nodiscard]] std::vector<KeypointMatch> inliers_of(const std::vector<KeypointMatch>& matches, const Pose2& pose,
                                                    const RansacRules& rules);

/// Of the rigid poses through two matches drawn at random, the one that brings most matches together, fitted to them.
/// None where no sample gives a pose in the window that two matches or more agree with.
[[nodiscard]] std::optional<RansacPose> rigid_ransac(const std::vector<KeypointMatch>& matches,
                                                     const RansacRules& rules, const std::optional<PoseWindow>& window,
                                                     RandomStream& random);

/// The poses of round after round; each takes the matches that those before it have left.
struct SequentialPoses {
  std::vector<RansacPose> poses;
  int rounds = 0;
};

/// Stops with the token, with its budget of iterations (a round is one), or when a round finds nothing. Each round goes
/// to the trace; its score is the number of inliers.
[[nodiscard]] SequentialPoses sequential_ransac(std::vector<KeypointMatch> matches, const RansacRules& rules,
                                                int rounds, const AlignRequest& request, const RunContext& context);

}  // namespace gridmerge
