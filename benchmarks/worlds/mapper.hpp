#pragma once
/// From scans to an occupancy grid, by log-odds.
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::worlds {

class Mapper {
 public:
  /// @param geometry  of the grid drawn on; what falls outside is lost
  explicit Mapper(const GridGeometry& geometry);

  /// One turn of a lidar: the points hit, in its own frame. A cell is told once a turn, and a hit outweighs what
  /// passes.
  void add(const Pose2& map_from_lidar, const std::vector<Point2>& hits);

  /// What is known, with a margin of a few unknown cells. Ternary: -1, 0, 100; otherwise 0..100 in percent.
  [[nodiscard]] OccupancyGrid grid(bool probabilistic) const;

 private:
  GridGeometry geometry_;
  std::vector<std::int16_t> log_odds_;  // [1/100]; 0: even, or not seen
  std::vector<std::uint16_t> turn_;     // the last one that told of a cell; 0: not seen
  std::uint16_t now_ = 0;
};

}  // namespace gridmerge::worlds
