#include "worlds/slam.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "worlds/lidar.hpp"
#include "worlds/mapper.hpp"
#include "worlds/route.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {
namespace {

constexpr Share kEverywhere = {-1e9, 1e9};
constexpr GridGeometry kCanvas = {.width = 400, .height = 400, .resolution_m = 0.05, .map_from_grid = {-10, -10, 0}};

/// Somewhere in the room, with no wall along the cells.
constexpr Pose2 kHere = {2.02, 2.03, 0.1};

/// A room of 8 x 5 m with an alcove and a column.
World room() {
  World world;
  world.length_m = 8;
  world.depth_m = 5;
  world.walls = {{{0, 0}, {8, 0}},     {{8, 0}, {8, 5}},   {{8, 5}, {5, 5}}, {{5, 5}, {5, 3.5}},
                 {{5, 3.5}, {3, 3.5}}, {{3, 3.5}, {3, 5}}, {{3, 5}, {0, 5}}, {{0, 5}, {0, 0}}};
  world.discs = {{{6, 1.5}, 0.3}};
  return world;
}

/// Two walls without an end, 3 m apart; and columns along them, where there are to be any.
World corridor(bool columns) {
  World world;
  world.length_m = 120;
  world.depth_m = 3;
  world.walls = {{{-40, 0}, {80, 0}}, {{-40, 3}, {80, 3}}};
  for (double x_m = -39.3; columns && x_m < 80; x_m += 2.7) {
    world.discs.push_back({{x_m, 0.1}, 0.2});
  }
  return world;
}

LidarModel exact() { return {.range_m = 12, .step_rad = radians(0.5), .noise_m = 0, .dropout = 0}; }

/// What a robot believes when it has gone along a route with nothing but its lidar, and where it really is.
struct Drive {
  OccupancyGrid map;
  Pose2 end;       // map_from_lidar as matched
  Pose2 true_end;  // map_from_lidar
  double worst_m = 0;
};

/// @param odometry  whether the guess knows the way (exactly); otherwise it is where the lidar was matched last
Drive drive(const World& world, const std::vector<Point2>& route, const GridGeometry& canvas, bool odometry) {
  const Lidar lidar(LidarModel{});
  RandomStream chance(1, "lidar");
  HectorMapper mapper(canvas);
  Drive drive;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const Point2 before = route[i == 0 ? 0 : i - 1];
    const Point2 way = odometry ? route[i] - before : Point2{};
    const Pose2 guess = {drive.end.x_m + way.x_m, drive.end.y_m + way.y_m, drive.end.theta_rad};
    const Pose2 world_from_lidar = {route[i].x_m, route[i].y_m, 0};
    drive.end = mapper.add(guess, lidar.scan(world, kEverywhere, world_from_lidar, chance));
    drive.true_end = {route[i].x_m - route[0].x_m, route[i].y_m - route[0].y_m, 0};
    drive.worst_m = std::max(drive.worst_m, norm(drive.end.translation() - drive.true_end.translation()));
  }
  drive.map = mapper.grid(false);
  return drive;
}

std::vector<Point2> straight_way(Point2 from, double length_m, double step_m) {
  std::vector<Point2> route;
  for (int i = 0; i * step_m <= length_m; ++i) {
    route.push_back({from.x_m + i * step_m, from.y_m});
  }
  return route;
}

/// FNV-1a over the cells: short enough to be written down.
std::uint64_t fingerprint(const OccupancyGrid& grid) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::int8_t cell : grid.cells) {
    hash = (hash ^ static_cast<std::uint8_t>(cell)) * 0x100000001b3U;
  }
  return hash;
}

std::vector<Point2> scan_of_room(const Pose2& world_from_lidar, const LidarModel& model = exact()) {
  RandomStream chance(1, "lidar");
  return Lidar(model).scan(room(), kEverywhere, world_from_lidar, chance);
}

TEST(HectorMapper, DrawsTheFirstScanWhereItIsThoughtToBe) {
  const Pose2 guess = {0.25, -0.125, 0.5};
  HectorMapper slam(kCanvas);
  EXPECT_EQ(slam.add(guess, scan_of_room(kHere)), guess);
  Mapper given(kCanvas);
  given.add(guess, scan_of_room(kHere));
  EXPECT_EQ(slam.grid(false), given.grid(false));
}

TEST(HectorMapper, RecoversAnOffsetToAFractionOfACell) {
  for (const Pose2& offset : {Pose2{0.2, 0, 0}, Pose2{-0.07, 0.12, 0}, Pose2{0, 0, radians(6)},
                              Pose2{0.1, -0.15, radians(-4)}, Pose2{0, 0, 0}}) {
    HectorMapper slam(kCanvas);
    slam.add({}, scan_of_room(kHere));
    const Pose2 matched = slam.add(offset, scan_of_room(kHere));
    EXPECT_LT(norm(matched.translation()), 0.01) << offset.x_m << " " << offset.y_m << " " << offset.theta_rad;
    EXPECT_LT(std::abs(degrees(matched.theta_rad)), 0.2);
  }
}

TEST(HectorMapper, FindsTheSamePoseWhateverTheYawOfItsGrid) {
  const Pose2 start = {1, 2, 0.5};
  for (const double yaw_deg : {0.0, 30.0, -120.0, 180.0}) {
    GridGeometry canvas = kCanvas;
    canvas.map_from_grid = start * Pose2{0, 0, radians(yaw_deg)} * Pose2{-10, -10, 0};
    HectorMapper slam(canvas);
    slam.add(start, scan_of_room(kHere));
    const Pose2 truth = start * Pose2{0.2, 0.1, 0.05};
    const Pose2 matched = slam.add(start, scan_of_room(kHere * Pose2{0.2, 0.1, 0.05}));
    EXPECT_LT(norm(matched.translation() - truth.translation()), 0.02) << yaw_deg;
    EXPECT_NEAR(matched.theta_rad, truth.theta_rad, radians(0.4)) << yaw_deg;
  }
}

TEST(HectorMapper, CoarseLevelsMendWhatTheFinestAloneCannot) {
  const Pose2 offset = {0.3, 0.3, radians(8)};
  const auto error_m = [&](int levels) {
    HectorMapper slam(kCanvas, {.levels = levels});
    slam.add({}, scan_of_room(kHere));
    return norm(slam.add(offset, scan_of_room(kHere)).translation());
  };
  EXPECT_LT(error_m(3), 0.02);
  EXPECT_GT(error_m(1), 0.05);
}

TEST(HectorMapper, DrawsAScanOnlyAfterAWayOrATurn) {
  HectorMapper slam(kCanvas);
  const auto move_to = [&](const Pose2& map_from_lidar) {
    slam.add(map_from_lidar, scan_of_room(kHere * map_from_lidar));
    return slam.grid(true);
  };
  const OccupancyGrid first = move_to({});
  EXPECT_EQ(move_to({0.2, 0.1, 0.5}), first);
  EXPECT_NE(move_to({0.5, 0.1, 0.5}), first);
  HectorMapper turned(kCanvas, {.update_angle_deg = 20});
  turned.add({}, scan_of_room(kHere));
  EXPECT_NE((turned.add({0, 0, 0.5}, scan_of_room(kHere * Pose2{0, 0, 0.5})), turned.grid(true)), first);
}

TEST(HectorMapper, DriftsALittleOnItsWayThroughAnOffice) {
  const World office = make_world("office", 1);
  const std::vector<Point2> route = plan_route(office, {0, 8}, kEverywhere, 3, 0.2);
  ASSERT_GT(route.size(), 50U);
  const GridGeometry canvas = {.width = static_cast<int>((office.length_m + 6) / 0.05),
                               .height = static_cast<int>((office.depth_m + 6) / 0.05),
                               .resolution_m = 0.05,
                               .map_from_grid = {-route[0].x_m - 3, -route[0].y_m - 3, 0}};
  const Drive told = drive(office, route, canvas, true);
  EXPECT_LT(told.worst_m, 0.15);
  EXPECT_GT(told.worst_m, 0.005);
  const Drive alone = drive(office, route, canvas, false);
  EXPECT_LT(alone.worst_m, 0.2);
  EXPECT_GT(alone.worst_m, 0.005);
}

TEST(HectorMapper, LosesItsPlaceAlongABareCorridorAndNotAcrossIt) {
  GridGeometry canvas = kCanvas;
  canvas.width = 1200;
  const Drive bare = drive(corridor(false), straight_way({0, 1.4}, 20, 0.1), canvas, false);
  EXPECT_GT(std::abs(bare.end.x_m - bare.true_end.x_m), 2);
  EXPECT_NEAR(bare.end.y_m, 0, 0.1);
  EXPECT_NEAR(degrees(bare.end.theta_rad), 0, 1);
  const Drive marked = drive(corridor(true), straight_way({0, 1.4}, 20, 0.1), canvas, false);
  EXPECT_LT(marked.worst_m, 0.3);
}

TEST(HectorMapper, KeepsTheGuessWhereThereIsNothingToMatch) {
  const Pose2 guess = {1, 2, 0.5};
  HectorMapper blind(kCanvas);
  EXPECT_EQ(blind.add(guess, {}), guess);
  EXPECT_THAT(blind.grid(false).cells, testing::Each(kUnknown));

  HectorMapper slam(kCanvas);
  slam.add({}, scan_of_room(kHere));
  for (const std::vector<Point2>& hits :
       {std::vector<Point2>{}, {{1, 0.5}}, {{1, 0}, {0, 1}}, {{3, 3}, {3, 3}, {3, 3}}}) {
    const Pose2 matched = slam.add({0.1, 0.1, 0.1}, hits);
    EXPECT_LT(norm(matched.translation() - Point2{0.1, 0.1}), 1e-6) << hits.size();
    EXPECT_NEAR(matched.theta_rad, 0.1, 1e-6);
  }
}

TEST(HectorMapper, LosesWhatFallsOutsideItsCanvas) {
  HectorMapper slam({.width = 40, .height = 30, .resolution_m = 0.1, .map_from_grid = {}});
  slam.add({2, 1.5, 0}, scan_of_room(kHere));
  const Pose2 astray = {-500, 300, 1};
  const Pose2 matched = slam.add(astray, scan_of_room(kHere));
  EXPECT_LT(norm(matched.translation() - astray.translation()), 1e-6);
  EXPECT_NO_THROW(check_grid(slam.grid(true)));
  HectorMapper tiny({.width = 1, .height = 1, .resolution_m = 0.1, .map_from_grid = {}});
  tiny.add({}, scan_of_room(kHere));
  tiny.add({}, scan_of_room(kHere));
  EXPECT_NO_THROW(check_grid(tiny.grid(false)));
}

TEST(HectorMapper, NeverChanges) {
  const std::vector<Point2> route = straight_way({1.5, 2.2}, 5, 0.1);
  const Drive along = drive(room(), route, kCanvas, false);
  EXPECT_EQ(fingerprint(along.map), 209272383918224524U);
  EXPECT_EQ(static_cast<std::int64_t>(std::nearbyint(along.end.x_m * 0x1p30)), 5368619926);
  EXPECT_EQ(static_cast<std::int64_t>(std::nearbyint(along.end.theta_rad * 0x1p30)), 10041177);
}

TEST(HectorMapper, RefusesOptionsOutOfRange) {
  try {
    HectorMapper slam(kCanvas, {.levels = 0, .update_distance_m = -1});
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "slam: levels = 0 is out of range: 1 .. 6; update_distance_m = -1 m is out of range: 0 .. 10");
  }
}

}  // namespace
}  // namespace gridmerge::worlds
