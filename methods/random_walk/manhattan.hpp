#pragma once
/// Distance maps in linear time (Birk & Carpin 2006, after Borgefors).
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// Of every cell of a level, the Manhattan distance to the nearest cell of a state [cells], by two passes over the map;
/// width + height where no cell has that state. Row-major, as the level's own.
[[nodiscard]] std::vector<int> manhattan_distances(const MapLevel& level, CellState state);

}  // namespace gridmerge
