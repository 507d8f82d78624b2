#pragma once
/// From which side the walls of a map were seen, in eighths of a turn, so that two maps' walls can be told to be the
/// same surface and not the two faces of one wall.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// The side a wall point was seen from, in 1/64 of a turn in the map's local frame.
struct WallSide {
  std::uint8_t direction = 0;
  bool known = false;

  explicit WallSide(const WallPoint& wall);
  /// The octant (0..7) of the side after the map was turned by `turn_rad`.
  [[nodiscard]] int octant_after(double turn_rad) const {
    return octant_after_64ths(static_cast<int>(std::lround(turn_rad / (2 * kPi) * 64)));
  }
  [[nodiscard]] int octant_after_64ths(int turn_64ths) const { return ((direction + turn_64ths + 4) >> 3) & 7; }
  /// A bit for its octant and the two beside it, so that normals up to about 60 degrees apart agree; all eight where it
  /// is not known.
  [[nodiscard]] std::uint8_t octants_seen_from() const {
    const int octant = octant_after_64ths(0);
    return known ? static_cast<std::uint8_t>((1 << octant) | (1 << ((octant + 1) & 7)) | (1 << ((octant + 7) & 7)))
                 : std::uint8_t{0xff};
  }
};

/// Of each of the map's walls, in their order.
[[nodiscard]] std::vector<WallSide> wall_sides(const PreparedMap& map);

/// Calls mark(row, from, to, bits) for the cells of level 0 within `reach_m` of each wall: those of a row in the
/// columns from .. to, and the wall's octants_seen_from.
/// @param sides  wall_sides of the map
template <typename Mark>
void mark_sides_within(const PreparedMap& map, const std::vector<WallSide>& sides, double reach_m, const Mark& mark) {
  const MapLevel& level = map.level(0);
  const double reach_cells = reach_m / level.resolution_m + 1e-6;
  const int reach = static_cast<int>(reach_cells);
  std::vector<int> half_width(static_cast<std::size_t>(reach) + 1);
  for (int dy = 0; dy <= reach; ++dy) {
    half_width[static_cast<std::size_t>(dy)] = static_cast<int>(std::sqrt(reach_cells * reach_cells - dy * dy));
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::uint8_t bits = sides[i].octants_seen_from();
    const auto [column, row] = level.cell_at(map.walls()[i].at);
    for (int dy = std::max(-reach, -row); dy <= std::min(reach, level.height - 1 - row); ++dy) {
      const int half = half_width[static_cast<std::size_t>(std::abs(dy))];
      mark(row + dy, std::max(0, column - half), std::min(level.width - 1, column + half), bits);
    }
  }
}

/// For each cell of level 0, octants_seen_from of the walls within `reach_m`; 0: no wall within reach.
/// @param sides  wall_sides of the map
[[nodiscard]] std::vector<std::uint8_t> sides_within(const PreparedMap& map, const std::vector<WallSide>& sides,
                                                     double reach_m);
/// The same, set beside what `cells` holds.
void add_sides_within(const PreparedMap& map, const std::vector<WallSide>& sides, double reach_m,
                      std::vector<std::uint8_t>& cells);

}  // namespace gridmerge
