#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/scenes.hpp"
#include "support/text_map.hpp"
#include "worlds/lidar.hpp"
#include "worlds/mapper.hpp"
#include "worlds/route.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {
namespace {

constexpr Share kEverywhere = {-1e9, 1e9};

bool wall_near(const OccupancyGrid& grid, CellIndex cell, int reach_cells) {
  for (int row = cell.row - reach_cells; row <= cell.row + reach_cells; ++row) {
    for (int column = cell.column - reach_cells; column <= cell.column + reach_cells; ++column) {
      if (grid.geometry.contains({column, row}) && grid.at({column, row}) == kOccupied) {
        return true;
      }
    }
  }
  return false;
}

/// Of the source's walls that fall on known cells of the target: the share that has a wall within `reach_cells`.
double confirmed_walls(const MapPair& pair, const Pose2& target_from_source, int reach_cells) {
  int both = 0;
  int confirmed = 0;
  for (int row = 0; row < pair.source.geometry.height; ++row) {
    for (int column = 0; column < pair.source.geometry.width; ++column) {
      if (pair.source.at({column, row}) != kOccupied) {
        continue;
      }
      const Point2 in_source = pair.source.geometry.cell_centre({column, row});
      const CellIndex cell = pair.target.geometry.cell_at(target_from_source * in_source);
      if (pair.target.geometry.contains(cell) && pair.target.at(cell) != kUnknown) {
        ++both;
        confirmed += wall_near(pair.target, cell, reach_cells) ? 1 : 0;
      }
    }
  }
  return both == 0 ? 0 : static_cast<double>(confirmed) / both;
}

/// FNV-1a over the cells: short enough to be written down.
std::uint64_t fingerprint(const OccupancyGrid& grid) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::int8_t cell : grid.cells) {
    hash = (hash ^ static_cast<std::uint8_t>(cell)) * 0x100000001b3U;
  }
  return hash;
}

class EveryKind : public testing::TestWithParam<std::string> {};

TEST_P(EveryKind, IsDrawnTheSameFromTheSameSeed) {
  const SceneOptions options = {.kind = GetParam(), .seed = 4, .drift_m = 0.01, .drift_deg = 0.1};
  const MapPair first = make_scene(options);
  const MapPair second = make_scene(options);
  EXPECT_EQ(first.target, second.target);
  EXPECT_EQ(first.source, second.source);
  EXPECT_EQ(first.target_from_source, second.target_from_source);
  EXPECT_EQ(first.overlap, second.overlap);
}

TEST_P(EveryKind, HoldsItsTruth) {
  for (const int seed : {1, 2, 3}) {
    const MapPair pair = make_scene({.kind = GetParam(), .seed = seed, .target_share = 0.8, .source_share = 0.8});
    check_grid(pair.target);
    check_grid(pair.source);
    EXPECT_GT(pair.overlap, 0.2) << "seed " << seed;
    EXPECT_GT(confirmed_walls(pair, pair.target_from_source, 2), 0.93) << "seed " << seed;
    EXPECT_NEAR(pair.target_from_source.theta_rad, radians(110), 1e-9);
    const Pose2 off = pair.target_from_source * Pose2{0.6, 0.6, 0.1};
    EXPECT_LT(confirmed_walls(pair, off, 2), 0.6) << "seed " << seed;
  }
}

TEST_P(EveryKind, HasFreeSpaceWallsAndWhatNobodySaw) {
  const MapPair pair = make_scene({.kind = GetParam()});
  for (const OccupancyGrid* grid : {&pair.target, &pair.source}) {
    const std::set<std::int8_t> values(grid->cells.begin(), grid->cells.end());
    EXPECT_THAT(values, testing::ElementsAre(kUnknown, kFree, kOccupied));
  }
}

TEST_P(EveryKind, StartsWithTheRobotInFreeSpaceAtTheMapsOrigin) {
  const MapPair pair = make_scene({.kind = GetParam(), .origin_yaw_deg = 30});
  for (const OccupancyGrid* grid : {&pair.target, &pair.source}) {
    EXPECT_EQ(grid->at(grid->geometry.cell_at({0, 0})), kFree);
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryKind, testing::ValuesIn(world_kinds()), [](const auto& kind) { return kind.param; });

TEST(Scene, NeverChanges) {
  const MapPair pair = make_scene({.kind = "flat", .seed = 1});
  EXPECT_EQ(fingerprint(pair.target), 5607859293170141150U);
  EXPECT_EQ(fingerprint(pair.source), 13612121759775301931U);
}

TEST(Scene, ChangesWithTheSeed) {
  EXPECT_NE(make_scene({.kind = "flat", .seed = 1}).target, make_scene({.kind = "flat", .seed = 2}).target);
}

TEST(Scene, SharesSteerTheOverlap) {
  const auto overlap = [](double share) {
    return make_scene({.kind = "office", .target_share = share, .source_share = share}).overlap;
  };
  const double little = overlap(0.4);
  const double half = overlap(0.6);
  const double all = overlap(1);
  EXPECT_LT(little, half);
  EXPECT_LT(half, all);
  EXPECT_GT(all, 0.9);
}

TEST(Scene, TwoEndsShareNothing) {
  for (const char* kind : {"office", "forest", "corridor"}) {
    EXPECT_EQ(make_scene({.kind = kind, .relation = "two_ends"}).overlap, 0) << kind;
  }
}

TEST(Scene, TwoWorldsStandFarApart) {
  for (const char* relation : {"two_worlds", "mirrored"}) {
    const MapPair pair = make_scene({.kind = "flat", .relation = relation});
    EXPECT_EQ(pair.overlap, 0) << relation;
    EXPECT_GT(norm(pair.target_from_source.translation()), 900) << relation;
  }
}

TEST(Scene, RotationAndYawOfTheOriginArePartOfTheTruth) {
  for (const double yaw_deg : {0.0, 25.0, -140.0}) {
    const MapPair pair = make_scene({.kind = "flat",
                                     .seed = 2,
                                     .target_share = 1,
                                     .source_share = 1,
                                     .target_heading_deg = 20,
                                     .rotation_deg = -75,
                                     .origin_yaw_deg = yaw_deg});
    EXPECT_NEAR(pair.source.geometry.map_from_grid.theta_rad, radians(yaw_deg), 1e-9);
    EXPECT_NEAR(pair.target_from_source.theta_rad, radians(-75), 1e-9);
    EXPECT_GT(confirmed_walls(pair, pair.target_from_source, 2), 0.93) << yaw_deg;
  }
}

TEST(Scene, ResolutionChangesTheCellsAndNotTheTruth) {
  const MapPair fine = make_scene({.kind = "flat", .resolution_m = 0.025});
  const MapPair coarse = make_scene({.kind = "flat", .resolution_m = 0.1});
  EXPECT_EQ(fine.target_from_source, coarse.target_from_source);
  EXPECT_EQ(coarse.target.geometry.resolution_m, 0.1);
  EXPECT_GT(confirmed_walls(coarse, coarse.target_from_source, 1), 0.9);
}

TEST(Scene, ProbabilisticMapsHaveValuesBetween) {
  const MapPair pair = make_scene({.kind = "flat", .probabilistic = true});
  EXPECT_NO_THROW(check_grid(pair.target));
  EXPECT_TRUE(std::any_of(pair.target.cells.begin(), pair.target.cells.end(),
                          [](std::int8_t cell) { return cell > kFree && cell < kOccupied; }));
}

TEST(Scene, DriftBendsTheMapAndNotTheTruth) {
  const SceneOptions straight = known_pair("office");
  SceneOptions bent = straight;
  bent.drift_deg = 0.5;
  const MapPair first = make_scene(straight);
  const MapPair second = make_scene(bent);
  EXPECT_EQ(first.target_from_source, second.target_from_source);
  EXPECT_LT(confirmed_walls(second, second.target_from_source, 1),
            confirmed_walls(first, first.target_from_source, 1) - 0.1);
}

TEST(Scene, RefusesOptionsOutOfRange) {
  try {
    static_cast<void>(make_scene({.kind = "ship", .dropout = 2}));
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "scene: kind = 'ship' is not one of: office, maze, flat, forest, corridor, hall, warehouse, cave, "
                 "spiral, floors, "
                 "bush_forest; "
                 "dropout = 2 is out of range: 0 .. 1");
  }
}

TEST(Scene, BlindRobotsDrawUnknownMaps) {
  const MapPair pair = make_scene({.kind = "flat", .dropout = 1});
  EXPECT_THAT(pair.target.cells, testing::Each(kUnknown));
  EXPECT_EQ(pair.overlap, 0);
}

TEST(KnownPairs, AreWhatTheySay) {
  for (const KnownPair& known : known_pairs()) {
    const MapPair pair = make_scene(known.options);
    EXPECT_EQ(pair.overlap > 0.15, known.overlaps) << known.name << ": " << pair.overlap;
    EXPECT_EQ(pose_error(pair, pair.target_from_source).distance_m, 0) << known.name;
  }
  EXPECT_THROW(static_cast<void>(known_pair("nowhere")), std::invalid_argument);
}

TEST(World, MirroredTwiceIsTheSame) {
  const World world = make_world("office", 1);
  const World twice = mirrored(mirrored(world));
  ASSERT_EQ(world.walls.size(), twice.walls.size());
  for (std::size_t i = 0; i < world.walls.size(); ++i) {
    EXPECT_NEAR(world.walls[i].from.y_m, twice.walls[i].from.y_m, 1e-12);
  }
  EXPECT_THROW(static_cast<void>(make_world("ship", 1)), std::invalid_argument);
}

/// A room of 4 x 2 m with a column in it.
World small_room() {
  World world;
  world.length_m = 4;
  world.depth_m = 2;
  world.walls = {{{0, 0}, {4, 0}}, {{4, 0}, {4, 2}}, {{4, 2}, {0, 2}}, {{0, 2}, {0, 0}}};
  world.discs = {{{3, 1}, 0.25}};
  world.places = {{0.6, 1}, {3.55, 1.5}};
  return world;
}

TEST(Lidar, MeasuresWallsAndColumnsExactly) {
  const Lidar lidar({.range_m = 10, .step_rad = radians(90), .noise_m = 0, .dropout = 0});
  RandomStream random(1, "lidar");
  const std::vector<Point2> hits = lidar.scan(small_room(), kEverywhere, {1, 1, radians(90)}, random);
  ASSERT_EQ(hits.size(), 4U);  // looking up: the upper wall, the left one, the lower one, the column on the right
  const std::vector<Point2> expected = {{1, 0}, {0, 1}, {-1, 0}, {0, -1.75}};
  for (std::size_t i = 0; i < hits.size(); ++i) {
    EXPECT_NEAR(hits[i].x_m, expected[i].x_m, 1e-7);
    EXPECT_NEAR(hits[i].y_m, expected[i].y_m, 1e-7);
  }
}

TEST(Lidar, EveryBeamInAClosedRoomHitsAWall) {
  const Lidar lidar({.range_m = 10, .step_rad = radians(0.25), .noise_m = 0, .dropout = 0});
  RandomStream random(1, "lidar");
  for (const double heading_rad : {0.0, 0.4, -3.0}) {
    const Pose2 world_from_lidar = {2.0, 0.7, heading_rad};
    const std::vector<Point2> hits = lidar.scan(small_room(), kEverywhere, world_from_lidar, random);
    EXPECT_EQ(hits.size(), 1440U);
    for (const Point2& hit : hits) {
      const Point2 at = world_from_lidar * hit;
      const double to_wall = std::min({at.x_m, 4 - at.x_m, at.y_m, 2 - at.y_m});
      const double to_column = norm(at - Point2{3, 1}) - 0.25;
      EXPECT_NEAR(std::min(std::abs(to_wall), std::abs(to_column)), 0, 1e-6);
    }
  }
}

TEST(Lidar, SeesNoFartherThanItsRangeAndOnlyWhatIsInSight) {
  const Lidar lidar({.range_m = 1.2, .step_rad = radians(1), .noise_m = 0, .dropout = 0});
  RandomStream random(1, "lidar");
  const std::vector<Point2> hits = lidar.scan(small_room(), kEverywhere, {1, 1, 0}, random);
  EXPECT_LT(hits.size(), 360U);
  for (const Point2& hit : hits) {
    EXPECT_LT(norm(hit), 1.2);
  }
  for (const Point2& hit : lidar.scan(small_room(), {0.5, 1.5}, {1, 1, 0}, random)) {
    EXPECT_LE(std::abs(hit.x_m), 0.5 + 1e-9);
  }
}

TEST(Lidar, LosesTheShareOfBeamsItIsTold) {
  const Lidar lidar({.range_m = 10, .step_rad = radians(0.05), .noise_m = 0, .dropout = 0.25});
  RandomStream random(1, "lidar");
  const std::vector<Point2> hits = lidar.scan(small_room(), kEverywhere, {1, 1, 0}, random);
  EXPECT_NEAR(static_cast<double>(hits.size()), 0.75 * 7200, 4 * std::sqrt(7200 * 0.1875));
}

TEST(Mapper, CarvesUpToTheHitAndLeavesTheRestUnknown) {
  Mapper mapper({.width = 20, .height = 20, .resolution_m = 1, .map_from_grid = {-10, -10, 0}});
  mapper.add({0.5, 0.5, 0}, {{3, 0}});
  EXPECT_EQ(to_text(mapper.grid(false)),
            "????????????\n????????????\n????????????\n????????????\n"
            "????...#????\n"
            "????????????\n????????????\n????????????\n????????????\n");
}

TEST(Mapper, AHitOutweighsABeamThatPassesInTheSameTurn) {
  Mapper mapper({.width = 20, .height = 20, .resolution_m = 1, .map_from_grid = {-10, -10, 0}});
  mapper.add({0.5, 0.5, 0}, {{2, 0}, {5, 0}});
  const OccupancyGrid grid = mapper.grid(false);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({2.5, 0.5})), kOccupied);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({5.5, 0.5})), kOccupied);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({3.5, 0.5})), kFree);
}

TEST(Mapper, ForgetsAWallThatIsGone) {
  Mapper mapper({.width = 20, .height = 20, .resolution_m = 1, .map_from_grid = {-10, -10, 0}});
  mapper.add({0.5, 0.5, 0}, {{2, 0}});
  for (int turn = 0; turn < 3; ++turn) {
    mapper.add({0.5, 0.5, 0}, {{5, 0}});
  }
  const OccupancyGrid grid = mapper.grid(false);
  EXPECT_EQ(grid.at(grid.geometry.cell_at({2.5, 0.5})), kFree);
}

TEST(Mapper, LosesWhatFallsOutsideItsCanvas) {
  Mapper mapper({.width = 4, .height = 4, .resolution_m = 1, .map_from_grid = {}});
  mapper.add({2.5, 2.5, 0}, {{100, 3}, {-100, -40}});
  EXPECT_NO_THROW(check_grid(mapper.grid(false)));
}

TEST(Route, GoesRoundObstaclesFromPlaceToPlace) {
  const World world = small_room();
  const std::vector<Point2> route = plan_route(world, kEverywhere, kEverywhere, 0, 0.1);
  ASSERT_GT(route.size(), 20U);
  EXPECT_LT(norm(route.front() - world.places[0]), 0.2);
  EXPECT_LT(norm(route.back() - world.places[1]), 0.3);
  for (std::size_t i = 1; i < route.size(); ++i) {
    EXPECT_GT(norm(route[i] - world.discs[0].centre), 0.25 + 0.15);
    EXPECT_LE(norm(route[i] - route[i - 1]), 0.1 + 1e-9);
  }
}

TEST(Route, StaysWithinItsBounds) {
  const World world = make_world("office", 1);
  for (const Point2& point : plan_route(world, {0, 15}, {0, 18}, 5, 0.5)) {
    EXPECT_LT(point.x_m, 18);
  }
}

TEST(Route, IsOnePointWhereThereIsNoPlace) {
  EXPECT_EQ(plan_route(small_room(), {1.9, 2.1}, kEverywhere, 3, 0.5).size(), 1U);
}

}  // namespace
}  // namespace gridmerge::worlds
