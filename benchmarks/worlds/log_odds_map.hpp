#pragma once
/// Log-odds of occupancy, cell by cell: what every mapper draws on.
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::worlds {

/// Log-odds [1/100]: what one turn of the lidar tells of a cell, and where they saturate: a wall passed by a stray beam
/// stays a wall.
struct LogOddsSteps {
  int hit = 85;
  int pass = -40;
  int least = -350;
  int most = 350;
};

class LogOddsMap {
 public:
  /// @param geometry  of the grid drawn on; what falls outside is lost
  LogOddsMap(const GridGeometry& geometry, const LogOddsSteps& steps);

  /// One turn of a lidar: the points hit, in its own frame. A cell is told once a turn, and a hit outweighs what
  /// passes.
  void add(const Pose2& map_from_lidar, const std::vector<Point2>& hits);

  /// What is known, with a margin of a few unknown cells. Ternary: -1, 0, 100; otherwise 0..100 in percent.
  [[nodiscard]] OccupancyGrid grid(bool probabilistic) const;

  [[nodiscard]] const GridGeometry& geometry() const { return geometry_; }

  /// [1/100], row-major; 0: even, or not seen.
  [[nodiscard]] const std::vector<std::int16_t>& log_odds() const { return log_odds_; }

 private:
  GridGeometry geometry_;
  LogOddsSteps steps_;
  std::vector<std::int16_t> log_odds_;
  std::vector<std::uint16_t> turn_;  // the last one that told of a cell; 0: not seen
  std::uint16_t now_ = 0;
};

}  // namespace gridmerge::worlds
