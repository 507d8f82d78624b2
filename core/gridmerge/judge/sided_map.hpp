#pragma once
/// A map as the Evaluator reads it: its walls with the side they were seen from, and for every cell which walls are
/// near.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"
#include "gridmerge/grid/wall_sides.hpp"

namespace gridmerge {

/// What a wall is part of, by how wide the piece of occupied cells is.
enum class Piece : std::uint8_t {
  kLegs,       ///< less than 0.4 m: of chairs and tables, people, specks; they are elsewhere every day
  kFurniture,  ///< to 2 m
  kFittings,   ///< to 4 m: counters, shelves, stubs of wall between doors
  kWall
};
inline constexpr std::size_t kPieceKinds = 4;

struct SidedWall {
  Point2f at;  ///< local frame
  WallSide side;
  Piece piece = Piece::kWall;
};

/// Borrows the map.
struct SidedMap {
  const PreparedMap* map = nullptr;
  std::vector<SidedWall> walls;  ///< of more than the limit, every n-th
  double metres_a_wall = 0;
  std::vector<std::uint8_t> seen_from;       ///< sides_within the tolerance, by cell of level 0
  std::vector<std::uint8_t> seen_from_near;  ///< sides_within half of it
  std::vector<std::uint8_t> clear_of_near;   ///< 1 for free cells farther than that, and a cell, from any wall
};

[[nodiscard]] SidedMap sided_map(const PreparedMap& map, double tolerance_m, int max_points);

/// The bit that is set in SidedMap::seen_from where a wall was seen from this one's side, after its map was turned; all
/// bits where its side is not known.
[[nodiscard]] inline std::uint8_t sides_of(const SidedWall& wall, int turn_64ths) {
  if (!wall.side.known) {
    return 0xFF;
  }
  return static_cast<std::uint8_t>(1U << wall.side.octant_after_64ths(turn_64ths));
}

/// 1 where the wall was seen from a side that `seen_from` holds, after its map was turned; 0 where from another; a half
/// where its own is not known.
[[nodiscard]] inline double same_side(const SidedWall& wall, std::uint8_t seen_from, int turn_64ths) {
  return !wall.side.known ? 0.5 : (seen_from & sides_of(wall, turn_64ths)) != 0 ? 1 : 0;
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
