#include "gridmerge/judge/elastic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/align/drawn_place.hpp"
#include "gridmerge/judge/evaluator.hpp"

namespace gridmerge {
namespace {

constexpr double kTolerance = 0.2;

/// The grid with each of its columns pushed up by so many cells.
OccupancyGrid pushed_up(const OccupancyGrid& grid, const std::function<int(int column)>& cells) {
  OccupancyGrid result = grid;
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      const CellIndex from = {column, row - cells(column)};
      result.at({column, row}) = grid.geometry.contains(from) ? grid.at(from) : kUnknown;
    }
  }
  return result;
}

/// Its right half by so many cells.
OccupancyGrid bent(const OccupancyGrid& grid, int cells) {
  return pushed_up(grid, [&](int column) { return column < grid.geometry.width / 2 ? 0 : cells; });
}

/// By the square of the distance from the left border, `cells` at the right one: what drift makes of a long place.
OccupancyGrid curved(const OccupancyGrid& grid, int cells) {
  return pushed_up(grid, [&](int column) {
    const double along = static_cast<double>(column) / grid.geometry.width;
    return static_cast<int>(std::lround(cells * along * along));
  });
}

double conflict(const ElasticMeeting& met) { return met.in_free_m / (met.in_free_m + met.same_side_m); }

ElasticMeeting meet(const OccupancyGrid& fixed, const OccupancyGrid& moving, const Pose2& local) {
  const PreparedMap a(fixed, 0.05);
  const PreparedMap b(moving, 0.05);
  const Pose2 aligned = to_local(local, a, b);
  return meet_elastically(sided_map(a, kTolerance, 100000), sided_map(b, kTolerance, 100000), aligned);
}

TEST(Elastic, AMapFitsItselfWithoutAShift) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const ElasticMeeting met = meet(grid, grid, {});
  EXPECT_GT(met.same_side_m, 50);
  EXPECT_LT(conflict(met), 0.01);
  EXPECT_EQ(met.astray_m2, 0);
  EXPECT_GT(met.expected_m, 0);
}

TEST(Elastic, ABentMapFitsWithShiftsThatDiffer) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const ElasticMeeting met = meet(grid, bent(grid, 8), {});  // 0.4 m, twice the tolerance
  EXPECT_LT(conflict(met), 0.08);
  EXPECT_GT(met.astray_m2 / met.expected_m, 0.01);  // of those at the fault alone
}

TEST(Elastic, ABendIsFollowedFartherThanAPatchMayStray) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const OccupancyGrid moving = curved(grid, 20);  // 1 m, where a patch is looked for 0.4 m off
  const ElasticMeeting met = meet(grid, moving, {});
  EXPECT_LT(conflict(met), 0.08);
  const PreparedMap a(grid, 0.05);
  const PreparedMap b(moving, 0.05);
  EXPECT_GT(Evaluator(a, b, {}).wall_figures({}).conflict_share, 0.2);
}

/// What is read there is a property of the maps: the same from every pose near by.
TEST(Elastic, SaysAboutTheSameFromPosesBesideEachOther) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const OccupancyGrid moving = curved(grid, 20);
  const double same_side_m = meet(grid, moving, {}).same_side_m;
  for (const Pose2& beside : {Pose2{0.1, 0, 0}, Pose2{-0.1, 0, 0}, Pose2{0, 0.1, 0}, Pose2{0, -0.1, 0},
                              Pose2{0, 0, radians(0.4)}, Pose2{0, 0, radians(-0.4)}}) {
    const ElasticMeeting met = meet(grid, moving, beside);
    EXPECT_NEAR(met.same_side_m, same_side_m, 0.1 * same_side_m)
        << beside.x_m << ", " << beside.y_m << ", " << beside.theta_rad;
    EXPECT_LT(conflict(met), 0.1) << beside.x_m << ", " << beside.y_m << ", " << beside.theta_rad;
  }
}

/// A pose beside the right one bends into it: its patches go where those of the right one are.
TEST(Elastic, PatchesGoToTheSamePlaceFromPosesBesideEachOther) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const std::vector<LaidPatch> right = meet(grid, grid, {}).layout;
  const std::vector<LaidPatch> beside = meet(grid, grid, {0.3, -0.2, radians(1)}).layout;
  ASSERT_GE(right.size(), 6U);
  ASSERT_EQ(beside.size(), right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_EQ(beside[i].patch, right[i].patch);
    EXPECT_NEAR(beside[i].at.x_m, right[i].at.x_m, 0.15);
    EXPECT_NEAR(beside[i].at.y_m, right[i].at.y_m, 0.15);
    EXPECT_GT(beside[i].same_side_m, 0.8 * right[i].same_side_m);
  }
}

TEST(Elastic, AWrongPoseFitsNoBetterForIt) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const ElasticMeeting met = meet(grid, grid, {1.7, 1.3, radians(40)});
  EXPECT_GT(conflict(met), 0.25);
}

/// A hall of 18 m by 14 m whose middle holds nothing but boxes of a metre, pushed up by so many cells.
OccupancyGrid hall_with_boxes(int pushed_cells) {
  OccupancyGrid grid = unknown_grid({.width = 360, .height = 280, .resolution_m = 0.05, .map_from_grid = {}});
  for (int row = 0; row < 280; ++row) {
    for (int column = 0; column < 360; ++column) {
      const bool border = column < 2 || column >= 358 || row < 2 || row >= 278;
      const int up = row - pushed_cells;
      const bool box = column >= 90 && column < 270 && up >= 90 && up < 190 && column % 60 < 20 && up % 50 < 20;
      grid.at({column, row}) = border || box ? kOccupied : kFree;
    }
  }
  return grid;
}

TEST(Elastic, FurnitureThatWasPushedBendsNoMap) {
  const ElasticMeeting met = meet(hall_with_boxes(0), hall_with_boxes(8), {});
  EXPECT_LT(conflict(met), 0.05);  // its patches did shift ...
  EXPECT_GT(met.expected_m, 0);
  EXPECT_NEAR(met.astray_m2 / met.expected_m, 0, 0.005);  // ... but those of the walls did not
}

TEST(Elastic, NothingIsSaidWhereTheMapsDoNotMeet) {
  const OccupancyGrid grid = drawn(Place::kFlat, {});
  const ElasticMeeting met = meet(grid, grid, {1000, 0, 0});
  EXPECT_EQ(met.same_side_m, 0);
  EXPECT_EQ(met.in_free_m, 0);
  EXPECT_EQ(met.expected_m, 0);
}

}  // namespace
}  // namespace gridmerge
