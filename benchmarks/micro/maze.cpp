#include "micro/maze.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "gridmerge/base/random.hpp"

namespace gridmerge::micro {
namespace {

constexpr int kSide = 2048;
constexpr double kResolution = 0.04;
constexpr int kCorridor = 50;  // cells
constexpr int kThickness = 3;  // cells

void draw_wall(OccupancyGrid& grid, CellIndex from, int columns, int rows) {
  for (int row = from.row; row < std::min(from.row + rows, kSide); ++row) {
    for (int column = from.column; column < std::min(from.column + columns, kSide); ++column) {
      grid.at({column, row}) = kOccupied;
    }
  }
}

}  // namespace

OccupancyGrid draw_maze(double width_m, double height_m) {
  OccupancyGrid grid = unknown_grid(
      {.width = kSide, .height = kSide, .resolution_m = kResolution, .map_from_grid = {-40.98, -40.98, 0}});
  const int columns = static_cast<int>(width_m / kResolution) / kCorridor;
  const int rows = static_cast<int>(height_m / kResolution) / kCorridor;
  const int left = (kSide - columns * kCorridor) / 2;
  const int bottom = (kSide - rows * kCorridor) / 2;
  for (int row = bottom; row < bottom + rows * kCorridor; ++row) {
    std::fill_n(&grid.at({left, row}), columns * kCorridor, kFree);
  }
  // A "binary tree" maze: every room but the last keeps its upper or its right wall.
  RandomStream random(1, "maze");
  const int length = kCorridor + kThickness;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const CellIndex room{left + x * kCorridor, bottom + y * kCorridor};
      if (y == 0) {
        draw_wall(grid, room, length, kThickness);
      }
      if (x == 0) {
        draw_wall(grid, room, kThickness, length);
      }
      const bool open_to_the_right = random.below(2) == 0;
      if (open_to_the_right || y + 1 == rows) {
        draw_wall(grid, {room.column, room.row + kCorridor}, length, kThickness);
      }
      if (!open_to_the_right || x + 1 == columns) {
        draw_wall(grid, {room.column + kCorridor, room.row}, kThickness, length);
      }
    }
  }
  return grid;
}

OccupancyGrid seen_from_middle(const OccupancyGrid& maze, int occupied_cells) {
  const auto distance2 = [](CellIndex cell) {
    const int x = cell.column - kSide / 2;
    const int y = cell.row - kSide / 2;
    return x * x + y * y;
  };
  std::vector<CellIndex> walls;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if (maze.at({column, row}) == kOccupied) {
        walls.push_back({column, row});
      }
    }
  }
  const auto wanted = static_cast<std::size_t>(occupied_cells);
  if (occupied_cells < 1 || walls.size() < wanted) {
    throw std::invalid_argument("the maze has not that many occupied cells");
  }
  std::stable_sort(walls.begin(), walls.end(), [&](CellIndex a, CellIndex b) { return distance2(a) < distance2(b); });

  OccupancyGrid part = unknown_grid(maze.geometry);
  part.geometry.map_from_grid = {3, -2, 0.7};
  const int reach2 = distance2(walls[wanted - 1]);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      if (distance2({column, row}) <= reach2 && maze.at({column, row}) != kUnknown) {
        part.at({column, row}) = kFree;
      }
    }
  }
  std::for_each_n(walls.begin(), wanted, [&](CellIndex wall) { part.at(wall) = kOccupied; });
  return part;
}

Pose2 maze_from_part(const OccupancyGrid& maze, const OccupancyGrid& part) {
  return maze.geometry.map_from_grid * inverse(part.geometry.map_from_grid);
}

}  // namespace gridmerge::micro
