#include "gridmerge/align/scored_pose.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

std::vector<ScoredPose> distinct_poses(std::vector<ScoredPose> poses, PoseReach reach, std::size_t at_most) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  std::vector<ScoredPose> kept;
  for (const ScoredPose& one : poses) {
    if (kept.size() == at_most) {
      break;
    }
    const bool taken = std::any_of(kept.begin(), kept.end(), [&](const ScoredPose& better) {
      return std::abs(wrap_angle(better.pose.theta_rad - one.pose.theta_rad)) < reach.angle_rad &&
             norm(better.pose.translation() - one.pose.translation()) < reach.distance_m;
    });
    if (!taken) {
      kept.push_back(one);
    }
  }
  return kept;
}

ScoredPose climb(const WallFit& fitness, const Pose2& start, PoseReach first_step, PoseReach last_step,
                 const std::optional<PoseWindow>& window) {
  ScoredPose best{start, fitness(start)};
  for (PoseReach step = first_step; step.distance_m >= last_step.distance_m || step.angle_rad >= last_step.angle_rad;
       step = {step.distance_m / 2, step.angle_rad / 2}) {
    for (bool better = true; better;) {
      better = false;
      const Pose2 from = best.pose;
      for (const Pose2& move :
           {Pose2{step.distance_m, 0, 0}, Pose2{-step.distance_m, 0, 0}, Pose2{0, step.distance_m, 0},
            Pose2{0, -step.distance_m, 0}, Pose2{0, 0, step.angle_rad}, Pose2{0, 0, -step.angle_rad}}) {
        const Pose2 pose{from.x_m + move.x_m, from.y_m + move.y_m, wrap_angle(from.theta_rad + move.theta_rad)};
        const double score = inside(pose, window) ? fitness(pose) : best.score;
        if (score > best.score) {
          best = {pose, score};
          better = true;
        }
      }
    }
  }
  return best;
}

std::vector<Candidate> candidates_of(const std::vector<ScoredPose>& poses, const AlignRequest& request) {
  std::vector<Candidate> candidates;
  candidates.reserve(poses.size());
  for (const ScoredPose& one : poses) {
    candidates.push_back({from_local(one.pose, request.target, request.source), one.score});
  }
  return candidates;
}

}  // namespace gridmerge
