#pragma once
/// Mazes drawn for measuring: any size, any number of occupied cells, with a known pose between them.
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::micro {

/// A maze of 2 m wide corridors with walls three cells thick, drawn in the middle of 2048 x 2048 cells of 0.04 m;
/// unknown around. The same on every machine.
[[nodiscard]] OccupancyGrid draw_maze(double width_m, double height_m);

/// The map of a robot that has seen only the middle of the maze: as far out as it takes to see `occupied_cells` walls.
/// It lies in a turned frame of its own.
/// @throws std::invalid_argument if the maze has fewer
[[nodiscard]] OccupancyGrid seen_from_middle(const OccupancyGrid& maze, int occupied_cells);

/// Where the part lies in the whole: every occupied cell on its own.
[[nodiscard]] Pose2 maze_from_part(const OccupancyGrid& maze, const OccupancyGrid& part);

}  // namespace gridmerge::micro
