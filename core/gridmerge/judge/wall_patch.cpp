#include "gridmerge/judge/wall_patch.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace gridmerge {
namespace {

/// Keeps every so many-th wall, so that there are not too many, in the order of their parts.
void thin_out(WallPatch& patch) {
  const std::size_t every = (patch.walls.size() + WallPatch::kMostWalls - 1) / WallPatch::kMostWalls;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < patch.walls.size(); i += every) {
    patch.walls[kept++] = patch.walls[i];
  }
  patch.walls.erase(patch.walls.begin() + static_cast<std::ptrdiff_t>(kept), patch.walls.end());
  std::stable_sort(patch.walls.begin(), patch.walls.end(),
                   [](const SidedWall& a, const SidedWall& b) { return part_of(a.piece) < part_of(b.piece); });
  patch.metres_a_wall *= static_cast<double>(every);
}

}  // namespace

Part part_of(Piece piece) {
  switch (piece) {
    case Piece::kLegs:
      return Part::kLegs;
    case Piece::kFurniture:
      return Part::kFurniture;
    default:
      return Part::kFixtures;
  }
}

std::vector<WallPatch> cut_in_patches(const std::vector<SidedWall>& walls, double metres_a_wall) {
  std::map<std::pair<int, int>, WallPatch> by_place;  // row, column
  const auto patch_of = [](float at_m) { return static_cast<int>(std::floor(at_m / WallPatch::kSide_m)); };
  for (const SidedWall& wall : walls) {
    const int column = patch_of(wall.at.x_m);
    const int row = patch_of(wall.at.y_m);
    WallPatch& patch = by_place[{row, column}];
    if (patch.walls.empty()) {
      patch.centre = {WallPatch::kSide_m * (static_cast<float>(column) + 0.5F),
                      WallPatch::kSide_m * (static_cast<float>(row) + 0.5F)};
      patch.metres_a_wall = metres_a_wall;
    }
    patch.walls.push_back(wall);
  }
  std::vector<WallPatch> patches;
  for (auto& [place, patch] : by_place) {
    thin_out(patch);
    patches.push_back(std::move(patch));
  }
  return patches;
}

}  // namespace gridmerge
