#pragma once
/// A map's walls, cut into square patches: what an elastic fit moves as one.
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

/// What is asked of a patch's pieces: its fixtures, walls and fittings, alone say where it goes.
enum class Part : std::uint8_t { kFixtures, kFurniture, kLegs };
inline constexpr std::size_t kParts = 3;
[[nodiscard]] Part part_of(Piece piece);

struct WallPatch {
  static constexpr float kSide_m = 4;
  static constexpr std::size_t kMostWalls = 60;

  Point2f centre;                ///< local frame
  std::vector<SidedWall> walls;  ///< part by part; of more than kMostWalls, every so many-th
  double metres_a_wall = 0;
};

/// By row and column of their lattice, whose corners lie about the local frame's origin.
[[nodiscard]] std::vector<WallPatch> cut_in_patches(const std::vector<SidedWall>& walls, double metres_a_wall);

}  // namespace gridmerge
