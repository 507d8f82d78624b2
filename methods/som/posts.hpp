#pragma once
/// Walls that stand by themselves: posts, trunks, table legs. They face everywhere, so their normals tell nothing;
/// where they stand does.
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/grid/cluster_points.hpp"

namespace gridmerge::som {

struct Posts {
  std::vector<ClusterPoint> points;  ///< a group of touching walls each, without a normal; heaviest first
  double share = 0;                  ///< of all metres of wall
};

/// The groups of touching walls that are no wider than `widest_m`.
[[nodiscard]] Posts posts_of(const PreparedMap& map, double widest_m);

/// Turns a step apart, all round or all in the window.
[[nodiscard]] std::vector<double> even_turns(double step_rad, const std::optional<PoseWindow>& window);

}  // namespace gridmerge::som
