#pragma once
/// From which side the walls of a map were seen, in eighths of a turn, so that two maps' walls can be told to be the
/// same surface and not the two faces of one wall.
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
};

/// Of each of the map's walls, in their order.
[[nodiscard]] std::vector<WallSide> wall_sides(const PreparedMap& map);

/// For each cell of level 0, a bit for every octant from which a wall within `reach_m` may have been seen: its own and
/// the two beside it, so that normals up to about 60 degrees apart agree; all eight where its side is not known. 0: no
/// wall within reach.
/// @param sides  wall_sides of the map
[[nodiscard]] std::vector<std::uint8_t> sides_within(const PreparedMap& map, const std::vector<WallSide>& sides,
                                                     double reach_m);

}  // namespace gridmerge
