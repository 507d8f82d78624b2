#pragma once
/// The occupancy grid with the exact meaning of ROS `nav_msgs/OccupancyGrid`, and the one place of world <-> cell
/// arithmetic.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// Column and row of a cell. `column` runs along the grid's x axis, `row` along its y axis, both from the lower left.
struct CellIndex {
  int column = 0;
  int row = 0;
  friend constexpr bool operator==(CellIndex, CellIndex) = default;
};

/// Where the cells of a grid lie in its map frame.
///
/// `map_from_grid` is the `origin` of a ROS map: the pose, *with yaw*, of the lower-left corner of cell (0, 0). In the
/// grid frame, cell (column, row) covers [column, column+1) x [row, row+1) times the resolution.
struct GridGeometry {
  int width = 0;            ///< columns, >= 0
  int height = 0;           ///< rows, >= 0
  double resolution_m = 0;  ///< side of a cell, > 0
  Pose2 map_from_grid;

  friend constexpr bool operator==(const GridGeometry&, const GridGeometry&) = default;

  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  [[nodiscard]] bool contains(CellIndex cell) const {
    return cell.column >= 0 && cell.row >= 0 && cell.column < width && cell.row < height;
  }
  /// Offset of a cell in row-major storage. The cell must be inside.
  [[nodiscard]] std::size_t offset(CellIndex cell) const {
    return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(cell.column);
  }
  /// The cell's centre, in the map frame [m]. The cell may lie outside.
  [[nodiscard]] Point2 cell_centre(CellIndex cell) const {
    return map_from_grid * Point2{(cell.column + 0.5) * resolution_m, (cell.row + 0.5) * resolution_m};
  }
  /// The cell that covers a point of the map frame. It may lie outside.
  [[nodiscard]] CellIndex cell_at(Point2 in_map) const {
    const Point2 in_grid = inverse(map_from_grid) * in_map;
    return {static_cast<int>(std::floor(in_grid.x_m / resolution_m)),
            static_cast<int>(std::floor(in_grid.y_m / resolution_m))};
  }
};

inline constexpr std::int8_t kUnknown = -1;
inline constexpr std::int8_t kFree = 0;
inline constexpr std::int8_t kOccupied = 100;

/// A map: -1 unknown, 0 (free) .. 100 (occupied) probability in percent; row-major from the lower left.
struct OccupancyGrid {
  GridGeometry geometry;
  std::vector<std::int8_t> cells;  ///< geometry.cell_count() values in -1..100

  friend bool operator==(const OccupancyGrid&, const OccupancyGrid&) = default;

  [[nodiscard]] std::int8_t at(CellIndex cell) const { return cells[geometry.offset(cell)]; }
  [[nodiscard]] std::int8_t& at(CellIndex cell) { return cells[geometry.offset(cell)]; }
};

/// A grid of that geometry, all cells unknown.
/// @throws std::invalid_argument if width or height are negative, or the resolution is not finite and positive.
[[nodiscard]] OccupancyGrid unknown_grid(const GridGeometry& geometry);

/// @throws std::invalid_argument naming the rule, if the geometry is unusable (negative size, resolution not finite
/// and positive, origin not finite) or there are not as many cells as it says, or a cell is outside -1..100.
void check_grid(const OccupancyGrid& grid);

}  // namespace gridmerge
