#pragma once
/// What a random walk shows of itself.
#include <vector>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/trace.hpp"

namespace gridmerge {

/// One block of steps of all walkers.
struct BlockProgress {
  double best_delta = 0;
  double mean_delta = 0;
  double acceptance_percent = 0;
  double sigma_m = 0;  ///< mean width of the steps
};

/// Where the starts put the source's centre, over the target.
void show_starts(TraceSink& trace, const std::vector<ScoredPose>& starts);
/// Where the walks took it: a line a walk, the longest first. Paths of fewer than two points are left out.
void show_walks(TraceSink& trace, const std::vector<std::vector<Point2>>& paths);
/// Delta, acceptance and step widths, block by block.
void show_progress(TraceSink& trace, const std::vector<BlockProgress>& blocks);

}  // namespace gridmerge
