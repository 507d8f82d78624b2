#pragma once
/// What both profiles tell a watcher of one rotation that was tried.
#include <cstddef>
#include <vector>

#include "gridmerge/align/scored_pose.hpp"

namespace gridmerge {

/// @param so_far  the poses of this rotation and of all before it
[[nodiscard]] inline IterationRecord rotation_record(std::size_t rotation, std::size_t rotations,
                                                     const std::vector<ScoredPose>& so_far,
                                                     const AlignRequest& request) {
  IterationRecord record{.stage = "propose/translation",
                         .iteration = static_cast<int>(rotation),
                         .iterations = static_cast<int>(rotations),
                         .best_score = 0,
                         .mean_score = 0,
                         .best_target_from_source = {},
                         .population = {}};
  const ScoredPose* best = nullptr;
  for (const ScoredPose& one : so_far) {
    best = best == nullptr || one.score > best->score ? &one : best;
    record.mean_score += one.score / static_cast<double>(so_far.size());
    record.population.push_back(from_local(one.pose, request.target, request.source));
  }
  if (best != nullptr) {
    record.best_score = best->score;
    record.best_target_from_source = from_local(best->pose, request.target, request.source);
  }
  return record;
}

}  // namespace gridmerge
