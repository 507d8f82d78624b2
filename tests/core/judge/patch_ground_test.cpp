#include "gridmerge/judge/patch_ground.hpp"

#include <gtest/gtest.h>

#include "core/align/drawn_place.hpp"
#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

constexpr double kNear = 0.1;

/// Spots at random, those that touch: most on the map, some off its border.
struct Thrown {
  std::vector<CellIndex> cells;
  std::vector<PatchGround::Spot> spots;
};

Thrown thrown_at(const PatchGround& ground, const MapLevel& level) {
  Thrown thrown;
  RandomStream random(7, "patch ground", 0);
  while (thrown.spots.size() < 60) {
    const int column = static_cast<int>(random.uniform(-20, level.width + 20));
    const int row = static_cast<int>(random.uniform(-20, level.height + 20));
    const auto sides = static_cast<std::uint8_t>(1U << random.below(8));
    const auto halves = static_cast<std::uint8_t>(1 + random.below(2));
    if (ground.touches(column, row)) {
      thrown.cells.push_back({column, row});
      thrown.spots.push_back({ground.first_of(column, row), sides, halves});
    }
  }
  return thrown;
}

TEST(PatchGround, CountsAtEveryPlaceWhatSpotsLaidThereMeet) {
  for (const double resolution_m : {0.02, 0.03, 0.05, 0.1, 0.2}) {
    const PreparedMap map(drawn(Place::kFlat, {.place_from_map = {}, .resolution_m = resolution_m}), resolution_m);
    const PatchGround ground(map, wall_sides(map), kNear);
    const Thrown here = thrown_at(ground, map.level(0));
    const PatchGround::Tally tally = ground.around(here.spots);
    int met_any = 0;
    const int step = ground.step_cells();
    EXPECT_NEAR(step * resolution_m, 0.1, resolution_m == 0.2 ? 0.1 : 0.02);
    for (int row = -PatchGround::kSteps; row <= PatchGround::kSteps; ++row) {
      for (int column = -PatchGround::kSteps; column <= PatchGround::kSteps; ++column) {
        // The same spots, each by itself: one that is off the map there meets nothing.
        Met met;
        for (std::size_t i = 0; i < here.spots.size(); ++i) {
          const int c = here.cells[i].column + step * column;
          const int r = here.cells[i].row + step * row;
          if (map.level(0).contains(c, r)) {
            PatchGround::Spot moved = here.spots[i];
            moved.first = ground.first_of(c, r);
            const Met one = ground.met({&moved, 1});
            met.same_side += one.same_side;
            met.in_free += one.in_free;
          }
        }
        const Met counted = tally.at(static_cast<std::size_t>(row + PatchGround::kSteps),
                                     static_cast<std::size_t>(column + PatchGround::kSteps));
        EXPECT_EQ(counted.same_side, met.same_side) << resolution_m << " m, " << column << ", " << row;
        EXPECT_EQ(counted.in_free, met.in_free) << resolution_m << " m, " << column << ", " << row;
        met_any += met.same_side + met.in_free;
      }
    }
    EXPECT_GT(met_any, 1000);
  }
}

TEST(PatchGround, ASpotMeetsAWallSeenFromItsSideOrFreeSpaceOffAnyWall) {
  const PreparedMap map(drawn(Place::kFlat, {}), 0.05);
  const PatchGround ground(map, wall_sides(map), kNear);
  const MapLevel& level = map.level(0);
  const std::vector<std::uint8_t> seen_from = sides_within(map, wall_sides(map), kNear);
  const auto clear_m = static_cast<float>(kNear + level.resolution_m);
  int sides_met = 0;
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      const std::size_t at = level.offset(column, row);
      const bool free = level.state[at] == CellState::kOpen && level.wall_distance_m[at] > clear_m;
      for (const unsigned octant : {0U, 3U}) {
        const PatchGround::Spot spot{ground.first_of(column, row), static_cast<std::uint8_t>(1U << octant), 2};
        const Met met = ground.met({&spot, 1});
        const bool seen = (seen_from[at] >> octant & 1U) != 0;
        ASSERT_EQ(met.same_side, seen ? 2 : 0) << column << ", " << row;
        ASSERT_EQ(met.in_free, free ? 2 : 0) << column << ", " << row;
        sides_met += met.same_side;
      }
    }
  }
  EXPECT_GT(sides_met, 0);
}

TEST(PatchGround, ACellTouchesAsLongAsItsNeighbourhoodHoldsOneOfTheMap) {
  const PreparedMap map(drawn(Place::kFlat, {}), 0.05);
  const PatchGround ground(map, wall_sides(map), kNear);
  const int reach = PatchGround::kSteps * ground.step_cells();
  EXPECT_TRUE(ground.touches(-reach, 0));
  EXPECT_FALSE(ground.touches(-reach - 1, 0));
  EXPECT_TRUE(ground.touches(0, map.level(0).height - 1 + reach));
  EXPECT_FALSE(ground.touches(0, map.level(0).height + reach));
}

}  // namespace
}  // namespace gridmerge
