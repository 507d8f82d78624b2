#include "gridmerge/grid/wall_sides.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

WallSide::WallSide(const WallPoint& wall) : known(wall.free_normal.x_m != 0 || wall.free_normal.y_m != 0) {
  if (known) {
    const double turn = std::atan2(wall.free_normal.y_m, wall.free_normal.x_m) / (2 * kPi);
    direction = static_cast<std::uint8_t>(std::lround(turn * 64) & 63);
  }
}

std::vector<WallSide> wall_sides(const PreparedMap& map) {
  std::vector<WallSide> sides;
  sides.reserve(map.walls().size());
  for (const WallPoint& wall : map.walls()) {
    sides.emplace_back(wall);
  }
  return sides;
}

std::vector<std::uint8_t> sides_within(const PreparedMap& map, const std::vector<WallSide>& sides, double reach_m) {
  const MapLevel& level = map.level(0);
  std::vector<std::uint8_t> seen_from(level.state.size(), 0);
  const double reach_cells = reach_m / level.resolution_m + 1e-6;
  const int reach = static_cast<int>(reach_cells);
  std::vector<int> half_width(static_cast<std::size_t>(reach) + 1);
  for (int dy = 0; dy <= reach; ++dy) {
    half_width[static_cast<std::size_t>(dy)] = static_cast<int>(std::sqrt(reach_cells * reach_cells - dy * dy));
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const WallPoint& wall = map.walls()[i];
    const WallSide side = sides[i];
    const int octant = side.octant_after_64ths(0);
    const auto bits =
        side.known ? static_cast<std::uint8_t>((1 << octant) | (1 << ((octant + 1) & 7)) | (1 << ((octant + 7) & 7)))
                   : std::uint8_t{0xff};
    const auto [column, row] = level.cell_at(wall.at);
    for (int dy = std::max(-reach, -row); dy <= std::min(reach, level.height - 1 - row); ++dy) {
      const int half = half_width[static_cast<std::size_t>(std::abs(dy))];
      const int low = std::max(0, column - half);
      const int high = std::min(level.width - 1, column + half);
      std::uint8_t* cell = &seen_from[level.offset(low, row + dy)];
      for (int c = low; c <= high; ++c) {
        *cell++ |= bits;
      }
    }
  }
  return seen_from;
}

}  // namespace gridmerge
