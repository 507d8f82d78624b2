#include "gridmerge/judge/meeting_cells.hpp"

namespace gridmerge {

void mark_free(const MapLevel& level, int row, float clear_m, float far_m, std::uint8_t* cells) {
  const std::size_t from = level.offset(0, row);
  const CellState* state = level.state.data() + from;
  const float* wall_m = level.wall_distance_m.data() + from;
  for (int column = 0; column < level.width; ++column) {
    const int clear = static_cast<int>(wall_m[column] > clear_m) + static_cast<int>(wall_m[column] > far_m);
    cells[column] = static_cast<std::uint8_t>(state[column] == CellState::kOpen ? clear : 0);
  }
}

}  // namespace gridmerge
