#pragma once
/// A map as the Evaluator reads it: its walls with the side they were seen from, and for every cell which walls are
/// near.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"
#include "gridmerge/grid/wall_sides.hpp"
#include "gridmerge/judge/patch_ground.hpp"
#include "gridmerge/judge/wall_patch.hpp"

namespace gridmerge {

/// Borrows the map.
struct SidedMap {
  const PreparedMap* map = nullptr;
  std::vector<SidedWall> walls;  ///< of more than the limit, every n-th
  double metres_a_wall = 0;
  std::vector<std::uint8_t> cells;  ///< by cell of level 0, meeting_cells.hpp: of walls within the tolerance, and clear
                                    ///< of any by a cell more; far is three times the tolerance
  PatchGround ground;               ///< of sides within half of it
  std::vector<WallPatch> patches;   ///< of the walls
};

[[nodiscard]] SidedMap sided_map(const PreparedMap& map, double tolerance_m, int max_points);

/// The bit of octants_seen_from that is this wall's side after its map was turned; all bits where its side is not
/// known.
[[nodiscard]] inline std::uint8_t sides_of(const SidedWall& wall, int turn_64ths) {
  if (!wall.side.known) {
    return 0xFF;
  }
  return static_cast<std::uint8_t>(1U << wall.side.octant_after_64ths(turn_64ths));
}

/// A turn in 1/64 of a full one, as WallSide has it.
[[nodiscard]] inline int turn_64ths(const Pose2& pose) {
  return static_cast<int>(std::lround(pose.theta_rad / (2 * kPi) * 64));
}

/// An affine map from points of one local frame to cells of a level of the other.
struct ToCells {
  float c, s, x0, y0;

  ToCells(const MapLevel& level, const Pose2& level_from_points) {
    const double scale = 1 / level.resolution_m;
    c = static_cast<float>(std::cos(level_from_points.theta_rad) * scale);
    s = static_cast<float>(std::sin(level_from_points.theta_rad) * scale);
    x0 = static_cast<float>((level_from_points.x_m - level.lower_left.x_m) * scale);
    y0 = static_cast<float>((level_from_points.y_m - level.lower_left.y_m) * scale);
  }
  [[nodiscard]] int column(Point2f p) const { return cell(c * p.x_m - s * p.y_m + x0); }
  [[nodiscard]] int row(Point2f p) const { return cell(s * p.x_m + c * p.y_m + y0); }
  /// The cell that holds a coordinate. Far outside of any map it stops counting, so that sums cannot overflow.
  [[nodiscard]] static int cell(float coordinate) {
    // Rounded down by hand: floor is a call on processors of before 2008, and this is asked for every cell.
    const float within = std::clamp(coordinate, -1e6F, 1e6F);
    const int towards_zero = static_cast<int>(within);
    return towards_zero - (within < static_cast<float>(towards_zero) ? 1 : 0);
  }
};

}  // namespace gridmerge
