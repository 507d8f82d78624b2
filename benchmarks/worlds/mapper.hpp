#pragma once
/// From scans and the poses they were taken from to an occupancy grid.
#include <vector>

#include "worlds/log_odds_map.hpp"

namespace gridmerge::worlds {

class Mapper {
 public:
  /// @param geometry  of the grid drawn on; what falls outside is lost
  explicit Mapper(const GridGeometry& geometry) : map_(geometry, {}) {}

  /// One turn of a lidar: the points hit, in its own frame.
  void add(const Pose2& map_from_lidar, const std::vector<Point2>& hits) { map_.add(map_from_lidar, hits); }

  /// What is known, with a margin of a few unknown cells. Ternary: -1, 0, 100; otherwise 0..100 in percent.
  [[nodiscard]] OccupancyGrid grid(bool probabilistic) const { return map_.grid(probabilistic); }

 private:
  LogOddsMap map_;
};

}  // namespace gridmerge::worlds
