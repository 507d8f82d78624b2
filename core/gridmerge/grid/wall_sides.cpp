#include "gridmerge/grid/wall_sides.hpp"

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

void add_sides_within(const PreparedMap& map, const std::vector<WallSide>& sides, double reach_m,
                      std::vector<std::uint8_t>& cells) {
  const MapLevel& level = map.level(0);
  mark_sides_within(map, sides, reach_m, [&](int row, int from, int to, std::uint8_t bits) {
    std::uint8_t* cell = &cells[level.offset(from, row)];
    for (int column = from; column <= to; ++column) {
      *cell++ |= bits;
    }
  });
}

std::vector<std::uint8_t> sides_within(const PreparedMap& map, const std::vector<WallSide>& sides, double reach_m) {
  std::vector<std::uint8_t> seen_from(map.level(0).state.size(), 0);
  add_sides_within(map, sides, reach_m, seen_from);
  return seen_from;
}

}  // namespace gridmerge
