#pragma once
/// The pieces that occupied cells form: walls hang together over metres, furniture, trunks and specks do not.
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// For each of the map's walls, in their order: whether the piece of occupied cells that it is part of (cells that
/// touch, also by a corner) is less than `width_m` wide each way.
[[nodiscard]] std::vector<bool> in_small_pieces(const PreparedMap& map, double width_m);

}  // namespace gridmerge
