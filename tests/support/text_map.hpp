#pragma once
/// Maps drawn as text, the way a person sees them: the first row is the top, y points up.
///
///     '#' occupied (100)   '.' free (0)   '?' or ' ' unknown (-1)   '1'..'9' 10..90 percent
#include <initializer_list>
#include <iosfwd>
#include <string>
#include <string_view>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// @param map_from_grid  where the lower-left corner lies; by default on the map frame's origin
/// @throws std::invalid_argument for rows of unequal length or a character without a meaning
[[nodiscard]] OccupancyGrid text_map(std::initializer_list<std::string_view> rows_from_top, double resolution_m = 1,
                                     const Pose2& map_from_grid = {});

/// The grid as text, one line a row, each ended by a newline. Values between are rounded to tens; '?' is unknown.
[[nodiscard]] std::string to_text(const OccupancyGrid& grid);

// What GoogleTest prints when an expectation fails.
void PrintTo(CellIndex cell, std::ostream* out);
void PrintTo(Point2 point, std::ostream* out);
void PrintTo(const Pose2& pose, std::ostream* out);
void PrintTo(const GridGeometry& geometry, std::ostream* out);
void PrintTo(const OccupancyGrid& grid, std::ostream* out);  ///< with the cells where they fit on a screen

}  // namespace gridmerge
