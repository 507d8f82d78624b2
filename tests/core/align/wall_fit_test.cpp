#include "gridmerge/align/wall_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/align/drawn_place.hpp"
#include "gridmerge/base/random.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

constexpr std::size_t kAllPoints = 1000000;

PreparedMap flat(const Pose2& place_from_map, double from_x_m = 0, double to_x_m = 12) {
  return PreparedMap(drawn(Place::kFlat, {.place_from_map = place_from_map, .from_x_m = from_x_m, .to_x_m = to_x_m}),
                     0.05);
}

/// The fitness from one map into the other, in double precision; `doubtful`: how many points lie on a cell's edge.
struct Sum {
  double fitness = 0;
  int doubtful = 0;
};

Sum sum_by_hand(const PreparedMap& table_map, const PreparedMap& points_map, int k, const Pose2& table_from_points,
                const WallFitOptions& options) {
  const MapLevel& level = table_map.level(k);
  const double sigma = std::max(options.tolerance_m, 0.7 * level.resolution_m);
  Sum sum;
  for (const ThinnedWall& wall : thinned_walls(points_map, points_map.level(k))) {
    const Point2 at = table_from_points * Point2{wall.at.x_m, wall.at.y_m};
    const double u = (at.x_m - level.lower_left.x_m) / level.resolution_m;
    const double v = (at.y_m - level.lower_left.y_m) / level.resolution_m;
    sum.doubtful += std::abs(u - std::round(u)) < 1e-3 || std::abs(v - std::round(v)) < 1e-3 ? 1 : 0;
    const int column = static_cast<int>(std::floor(u));
    const int row = static_cast<int>(std::floor(v));
    if (!level.contains(column, row)) {
      continue;
    }
    const double d = level.wall_distance_m[level.offset(column, row)];
    const bool open = level.state[level.offset(column, row)] == CellState::kOpen;
    sum.fitness += wall.weight * (open && d > 2 * sigma ? -options.free_space_penalty
                                  : d < 4 * sigma       ? std::exp(-0.5 * d * d / (sigma * sigma))
                                                        : 0);
  }
  return sum;
}

TEST(FitTable, RewardsWallsAndPunishesFreeSpace) {
  const PreparedMap map(text_map({"??????????????????????????????", "??????????????????????????????",
                                  "#.............................", "??????????????????????????????"},
                                 0.1),
                        0.1);
  const MapLevel& level = map.level(0);
  const FitTable table(level, {.tolerance_m = 0.21, .free_space_penalty = 1.5});
  const int row = 16;  // one row of known cells within a margin of 16
  for (int column = 0; column < 30; ++column) {
    const double d = 0.1 * column;
    const double expected = d > 2 * 0.21 ? -1.5 : std::exp(-0.5 * d * d / (0.21 * 0.21));
    EXPECT_NEAR(table.value[level.offset(16 + column, row)], 30 * expected, 0.51) << column;
  }
  // Nobody knows what lies behind the wall: a reward near it, nothing beyond.
  EXPECT_NEAR(table.value[level.offset(14, row)], 30 * std::exp(-0.5 * 0.04 / (0.21 * 0.21)), 0.51);
  EXPECT_EQ(table.value[level.offset(7, row)], 0);
}

TEST(FitTable, IsNoSharperThanItsCells) {
  const PreparedMap map(text_map({"#????????"}, 0.1), 0.1);
  const MapLevel& level = map.level(2);  // cells of 0.4 m: sigma 0.28 m
  const FitTable table(level, {.tolerance_m = 0.05});
  EXPECT_EQ(table.value[level.offset(4, 4)], 30);
  EXPECT_NEAR(table.value[level.offset(5, 4)], 30 * std::exp(-0.5 * 0.16 / (0.28 * 0.28)), 0.51);
}

TEST(ThinnedWalls, CountAThickWallNoMoreThanAThinOneAndASpeckLittle) {
  const PreparedMap map(text_map({"##..........", "##..........", "............", "....##......",  //
                                  "............", "............", "............", ".........#.."},
                                 0.05),
                        0.05);
  const std::vector<ThinnedWall> fine = thinned_walls(map, map.level(0));
  ASSERT_EQ(fine.size(), 7U);
  for (const ThinnedWall& wall : fine) {
    EXPECT_EQ(wall.weight, 1);
  }
  std::vector<ThinnedWall> coarse = thinned_walls(map, map.level(1));
  ASSERT_EQ(coarse.size(), 3U);
  std::sort(coarse.begin(), coarse.end(), [](const auto& a, const auto& b) { return a.at.x_m < b.at.x_m; });
  EXPECT_EQ(coarse[0].weight, 1);                                    // four cells of the two that cross it
  EXPECT_EQ(coarse[1].weight, 1);                                    // two cells: crosses it
  EXPECT_EQ(coarse[2].weight, 0.5);                                  // a speck
  EXPECT_NEAR(coarse[1].at.x_m - coarse[0].at.x_m, 4 * 0.05, 1e-6);  // means of the cells in it
  EXPECT_NEAR(coarse[1].at.y_m - coarse[0].at.y_m, -2.5 * 0.05, 1e-6);
}

TEST(ThinnedWalls, KeepEveryWallInExactlyOnePoint) {
  const PreparedMap map = flat({1, 2, 0.3});
  for (int k = 0; k < PreparedMap::kLevels; ++k) {
    const MapLevel& level = map.level(k);
    std::size_t wall_cells = 0;
    for (const CellState state : level.state) {
      wall_cells += state == CellState::kWall ? 1 : 0;
    }
    const std::vector<ThinnedWall> points = thinned_walls(map, level);
    EXPECT_EQ(points.size(), wall_cells) << "level " << k;
    for (const ThinnedWall& point : points) {
      ASSERT_GT(point.weight, 0);
      ASSERT_LE(point.weight, 1);
    }
  }
}

TEST(WallFit, EqualsASumByHandAtRandomPoses) {
  const PreparedMap target = flat({0.3, -0.4, 0.2}, 0, 8);
  const PreparedMap source = flat({2, 5, -1.1}, 4, 12);
  const WallFitOptions options{.tolerance_m = 0.12, .free_space_penalty = 0.8};
  for (int k = 0; k < PreparedMap::kLevels; ++k) {
    const WallFit fit(target, source, k, options, kAllPoints);
    RandomStream random(1, "poses");
    for (int i = 0; i < 40; ++i) {
      const Pose2 pose{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-kPi, kPi)};
      const Sum forth = sum_by_hand(target, source, k, pose, options);
      const Sum back = sum_by_hand(source, target, k, inverse(pose), options);
      const double rounding = 0.5 / FitTable::kFull * static_cast<double>(fit.point_count());
      EXPECT_NEAR(fit(pose), forth.fitness + back.fitness, rounding + 2 * (forth.doubtful + back.doubtful))
          << "level " << k << ", pose " << i;
    }
  }
}

TEST(WallFit, StaysWhenTheMapsAreSwappedAndThePoseInverted) {
  const PreparedMap target = flat({0.3, -0.4, 0.2}, 0, 8);
  const PreparedMap source = flat({2, 5, -1.1}, 4, 12);
  const WallFit forth(target, source, 1, {}, kAllPoints);
  const WallFit back(source, target, 1, {}, kAllPoints);
  RandomStream random(2, "poses");
  int equal = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-kPi, kPi)};
    EXPECT_NEAR(forth(pose), back(inverse(pose)), 6);  // two points that rounding puts into another cell
    equal += std::abs(forth(pose) - back(inverse(pose))) < 1e-3 ? 1 : 0;
  }
  EXPECT_GE(equal, 80);
}

TEST(WallFit, IsTheNumberOfPointsWhereAMapLiesOnItself) {
  const PreparedMap map = flat({});
  const WallFit fit(map, map, 0, {}, kAllPoints);
  EXPECT_EQ(fit.point_count(), 2 * map.walls().size());
  EXPECT_NEAR(fit({}), static_cast<double>(fit.point_count()), 1e-3);
  EXPECT_LT(fit({0.3, 0, 0}), 0.8 * fit({}));
  EXPECT_LT(fit({0, 0, radians(5)}), 0.8 * fit({}));
}

TEST(WallFit, IsGreatestAtTheTruth) {
  const Pose2 place_from_target{0.3, -0.4, 0.2};
  const Pose2 place_from_source{2, 5, -1.1};
  const PreparedMap target = flat(place_from_target, 0, 8);
  const PreparedMap source = flat(place_from_source, 4, 12);
  const Pose2 truth = to_local(inverse(place_from_target) * place_from_source, target, source);
  for (const int k : {0, 1, 2}) {
    const WallFit fit(target, source, k, {}, kAllPoints);
    const double at_truth = fit(truth);
    EXPECT_GT(at_truth, 0.3 * static_cast<double>(fit.point_count()));
    RandomStream random(3, "poses");
    for (int i = 0; i < 100; ++i) {
      const Pose2 other{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-kPi, kPi)};
      EXPECT_LT(fit(other), at_truth);
    }
  }
}

TEST(WallFit, IsNothingWhereTheMapsDoNotTouch) {
  const PreparedMap map = flat({});
  const WallFit fit(map, map, 1, {}, kAllPoints);
  for (const Pose2& apart :
       {Pose2{40, 0, 0}, Pose2{-40, 0, 1}, Pose2{0, 40, 2}, Pose2{0, -40, 3}, Pose2{1e7, 1e7, 0}}) {
    EXPECT_EQ(fit(apart), 0);
  }
}

TEST(WallFit, TakesEveryNthPointOfTooMany) {
  const PreparedMap map = flat({});
  const std::size_t points = thinned_walls(map, map.level(0)).size();
  const WallFit all(map, map, 0, {}, points);
  EXPECT_EQ(all.point_count(), 2 * points);
  const WallFit some(map, map, 0, {}, 200);
  EXPECT_LE(some.point_count(), 400U);
  EXPECT_GT(some.point_count(), 200U);
  EXPECT_NEAR(some({}), static_cast<double>(some.point_count()), 1e-3);
  const Pose2 beside{0.2, 0.1, 0.02};
  EXPECT_NEAR(some(beside) / some({}), all(beside) / all({}), 0.1);
}

}  // namespace
}  // namespace gridmerge
