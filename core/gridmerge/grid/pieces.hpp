#pragma once
/// The pieces that occupied cells form: walls hang together over metres, furniture, trunks and specks do not.
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// For each of the map's walls, in their order: how wide the piece of occupied cells is that it is part of (cells that
/// touch, also by a corner): the longer side of its bounding box along the grid's axes [m].
[[nodiscard]] std::vector<float> piece_widths_m(const PreparedMap& map);

}  // namespace gridmerge
