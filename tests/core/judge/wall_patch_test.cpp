#include "gridmerge/judge/wall_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/align/drawn_place.hpp"
#include "gridmerge/judge/sided_map.hpp"

namespace gridmerge {
namespace {

SidedWall wall_at(Point2f at, Piece piece) { return {at, WallSide(WallPoint{}), piece}; }

TEST(WallPatches, HoldEveryWallWhereItStands) {
  const PreparedMap map(drawn(Place::kFlat, {}), 0.05);
  const SidedMap sided = sided_map(map, 0.2, 100000);
  double metres = 0;
  for (const WallPatch& patch : sided.patches) {
    EXPECT_LE(patch.walls.size(), WallPatch::kMostWalls);
    EXPECT_FALSE(patch.walls.empty());
    for (const SidedWall& wall : patch.walls) {
      EXPECT_LE(std::abs(wall.at.x_m - patch.centre.x_m), WallPatch::kSide_m / 2 + 1e-4);
      EXPECT_LE(std::abs(wall.at.y_m - patch.centre.y_m), WallPatch::kSide_m / 2 + 1e-4);
    }
    metres += static_cast<double>(patch.walls.size()) * patch.metres_a_wall;
  }
  const double all_m = static_cast<double>(sided.walls.size()) * sided.metres_a_wall;
  EXPECT_NEAR(metres, all_m, 0.05 * all_m);
}

TEST(WallPatches, KeepEverySoManyThOfMany) {
  std::vector<SidedWall> walls;
  for (int i = 0; i < 121; ++i) {
    walls.push_back(wall_at({0.01F * static_cast<float>(i), 1}, Piece::kWall));
  }
  const std::vector<WallPatch> patches = cut_in_patches(walls, 0.05);
  ASSERT_EQ(patches.size(), 1U);
  ASSERT_EQ(patches[0].walls.size(), 41U);  // every third
  EXPECT_NEAR(patches[0].metres_a_wall, 0.15, 1e-12);
  EXPECT_NEAR(patches[0].walls[1].at.x_m, 0.03, 1e-6);
}

TEST(WallPatches, ComePartByPartAndRowByRow) {
  const std::vector<WallPatch> patches = cut_in_patches(
      {wall_at({1, 5}, Piece::kLegs), wall_at({2, 5}, Piece::kWall), wall_at({3, 5}, Piece::kFurniture),
       wall_at({1, 6}, Piece::kFittings), wall_at({-1, 5}, Piece::kWall), wall_at({9, -0.5F}, Piece::kWall)},
      0.05);
  ASSERT_EQ(patches.size(), 3U);
  EXPECT_EQ(patches[0].centre.x_m, 10);
  EXPECT_EQ(patches[0].centre.y_m, -2);
  EXPECT_EQ(patches[1].centre.x_m, -2);
  EXPECT_EQ(patches[2].centre.x_m, 2);
  EXPECT_EQ(patches[2].centre.y_m, 6);
  const std::vector<SidedWall>& walls = patches[2].walls;
  ASSERT_EQ(walls.size(), 4U);
  EXPECT_EQ(part_of(walls[0].piece), Part::kFixtures);
  EXPECT_EQ(part_of(walls[1].piece), Part::kFixtures);
  EXPECT_EQ(part_of(walls[2].piece), Part::kFurniture);
  EXPECT_EQ(part_of(walls[3].piece), Part::kLegs);
}

TEST(WallPatches, AreNoneWithoutWalls) { EXPECT_TRUE(cut_in_patches({}, 0.05).empty()); }

}  // namespace
}  // namespace gridmerge
