#pragma once
/// What a manifest says of a map's known cells.
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// Mean of the known cells' centres, in the map frame; the grid's lower-left corner, if nothing is known.
[[nodiscard]] Point2 centre_of_known(const OccupancyGrid& map);

/// The number with that many decimals. What was measured is written no finer than it is known.
[[nodiscard]] double with_decimals(double value, int decimals);

}  // namespace gridmerge
