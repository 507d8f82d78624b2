#include "worlds/lidar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace gridmerge::worlds {
namespace {

constexpr Share kEverywhere = {-1e9, 1e9};
constexpr LidarModel kExact = {.range_m = 10, .step_rad = radians(1), .noise_m = 0, .dropout = 0};

/// A room of 4 x 2 m with a column in it.
World small_room() {
  World world;
  world.length_m = 4;
  world.depth_m = 2;
  world.walls = {{{0, 0}, {4, 0}}, {{4, 0}, {4, 2}}, {{4, 2}, {0, 2}}, {{0, 2}, {0, 0}}};
  world.discs = {{{3, 1}, 0.25}};
  return world;
}

/// A wall of 20 m across the x axis.
World wall_ahead(double at_m) {
  World world;
  world.walls = {{{at_m, -10}, {at_m, 10}}};
  return world;
}

std::vector<Point2> scan(const LidarModel& model, const World& world, const Pose2& world_from_lidar,
                         const Attitude& attitude = {}, const std::vector<Disc>& others = {}) {
  RandomStream random(1, "lidar");
  return Lidar(model).scan(world, kEverywhere, world_from_lidar, random, attitude, others);
}

double bearing_deg(Point2 hit) { return degrees(std::atan2(hit.y_m, hit.x_m)); }

struct Sheet {
  std::string name;
  std::size_t beams;
  double widest_deg;
  double range_m;
};

class KnownLidar : public testing::TestWithParam<Sheet> {};

TEST_P(KnownLidar, SeesAsWideAndAsFarAsItsDataSheetSays) {
  LidarModel model = lidar_model(GetParam().name);
  model.noise_m = model.noise_share = model.dropout = 0;
  const std::vector<Point2> hits = scan(model, small_room(), {1, 1, 0.3});
  ASSERT_EQ(hits.size(), GetParam().beams);
  double widest_deg = 0;
  for (const Point2& hit : hits) {
    widest_deg = std::max(widest_deg, std::abs(bearing_deg(hit)));
  }
  EXPECT_NEAR(widest_deg, GetParam().widest_deg, 0.2);
  EXPECT_NEAR(std::abs(bearing_deg(hits[1]) - bearing_deg(hits[0])), degrees(model.step_rad), 1e-6);
  EXPECT_FALSE(scan(model, wall_ahead(GetParam().range_m - 0.1), {0, 0, 0}).empty());
  EXPECT_TRUE(scan(model, wall_ahead(GetParam().range_m + 0.1), {0, 0, 0}).empty());
}

INSTANTIATE_TEST_SUITE_P(, KnownLidar,
                         testing::Values(Sheet{"rplidar_a3", 1600, 180, 25}, Sheet{"hokuyo_utm30lx", 1081, 135, 30},
                                         Sheet{"hokuyo_urg04lx", 683, 120, 5.6}),
                         [](const auto& sheet) { return sheet.param.name; });

TEST(LidarModel, IsFoundByItsNameAndAnUnknownNameListsTheKnownOnes) {
  for (const std::string& name : lidar_names()) {
    EXPECT_GT(lidar_model(name).range_m, 0) << name;
  }
  try {
    static_cast<void>(lidar_model("sonar"));
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "lidar 'sonar' is not one of: rplidar_a3, hokuyo_utm30lx, hokuyo_urg04lx");
  }
}

TEST(LidarModel, NoiseGrowsWithTheRangeWhereItIsAShareOfIt) {
  const Lidar lidar({.range_m = 50, .step_rad = radians(180), .noise_m = 0.01, .dropout = 0, .noise_share = 0.005});
  for (const auto& [range_m, expected_m] : {std::pair{1.0, 0.01}, std::pair{20.0, 0.1}}) {
    const World world = wall_ahead(range_m);
    RandomStream random(1, "lidar");
    double sum2 = 0;
    constexpr int kScans = 2000;
    for (int i = 0; i < kScans; ++i) {
      const double error_m = lidar.scan(world, kEverywhere, {0, 0, 0}, random).at(0).x_m - range_m;
      sum2 += error_m * error_m;
    }
    EXPECT_NEAR(std::sqrt(sum2 / kScans), expected_m, 0.07 * expected_m) << range_m;
  }
}

TEST(LidarModel, SeesNothingNearerThanItsNearest) {
  LidarModel model = kExact;
  model.nearest_m = 1.2;
  const std::vector<Point2> hits = scan(model, small_room(), {1, 1, 0});
  ASSERT_FALSE(hits.empty());
  for (const Point2& hit : hits) {
    EXPECT_GE(norm(hit), 1.2 - 1e-9);
  }
}

TEST(LidarModel, WithoutAFieldOfViewOnlyTheBeamAheadIsLeft) {
  LidarModel model = kExact;
  model.field_of_view_rad = 0;
  EXPECT_THAT(scan(model, small_room(), {1, 1, 0}), testing::ElementsAre(Point2{1.75, 0}));
}

TEST(LidarScan, LooksTheSameWhereObstaclesOutOfRangeAreAdded) {
  World crowded = small_room();
  RandomStream random(7, "far");
  for (int i = 0; i < 2000; ++i) {
    const double x_m = random.uniform(20, 80);
    const double y_m = random.uniform(-40, 40);
    crowded.walls.push_back({{x_m, y_m}, {x_m + 1, y_m}});
    crowded.discs.push_back({{-x_m, y_m}, 0.5});
  }
  crowded.walls.push_back({{-100, 13}, {100, 14}});  // long, and its ends on either side
  EXPECT_EQ(scan(kExact, crowded, {1, 1, 0.3}), scan(kExact, small_room(), {1, 1, 0.3}));
}

TEST(LidarScan, SeesOtherRobotsLikeColumns) {
  World with_robot = small_room();
  with_robot.discs.push_back({{1, 1.6}, 0.2});
  const std::vector<Point2> hits = scan(kExact, small_room(), {1, 1, 0.3}, {}, {{{1, 1.6}, 0.2}});
  EXPECT_EQ(hits, scan(kExact, with_robot, {1, 1, 0.3}));
  EXPECT_NE(hits, scan(kExact, small_room(), {1, 1, 0.3}));
}

TEST(LidarScan, DoesNotSeeTheRobotThatCarriesIt) {
  EXPECT_EQ(scan(kExact, small_room(), {1, 1, 0}, {}, {{{1.02, 1}, 0.2}}), scan(kExact, small_room(), {1, 1, 0}));
}

TEST(Attitude, LevelGivesTheSamePoints) {
  LidarModel model = kExact;
  model.noise_m = 0.02;
  model.dropout = 0.1;
  const std::vector<Point2> hits = scan(model, small_room(), {1, 1, 0.3});
  EXPECT_EQ(hits, scan(model, small_room(), {1, 1, 0.3}, {.height_m = 0.4}));
  EXPECT_EQ(hits, scan(model, small_room(), {1, 1, 0.3}, {.height_m = 2, .levelled = false}));
}

TEST(Attitude, ARolledOneSeesTheGroundBesideIt) {
  LidarModel model = kExact;
  model.step_rad = radians(90);
  const double roll_rad = radians(20);
  const double height_m = 1.5;
  const double beside_m = height_m / std::tan(roll_rad);
  const std::vector<Point2> left_up = scan(model, {}, {}, {.roll_rad = roll_rad, .height_m = height_m});
  ASSERT_EQ(left_up.size(), 1U);
  EXPECT_NEAR(left_up[0].x_m, 0, 1e-8);
  EXPECT_NEAR(left_up[0].y_m, -beside_m, 1e-7);
  const std::vector<Point2> right_up = scan(model, {}, {}, {.roll_rad = -roll_rad, .height_m = height_m});
  ASSERT_EQ(right_up.size(), 1U);
  EXPECT_NEAR(right_up[0].y_m, beside_m, 1e-7);
  const std::vector<Point2> as_if_level =
      scan(model, {}, {}, {.roll_rad = roll_rad, .height_m = height_m, .levelled = false});
  EXPECT_NEAR(as_if_level.at(0).y_m, -height_m / std::sin(roll_rad), 1e-7);
}

TEST(Attitude, NoseDownItSeesTheGroundAheadAsAWallThatIsNotThere) {
  const double pitch_rad = radians(15);
  const double ahead_m = 1 / std::tan(pitch_rad);
  const std::vector<Point2> hits = scan(kExact, {}, {3, 4, 2}, {.pitch_rad = pitch_rad});
  ASSERT_GT(hits.size(), 100U);
  for (const Point2& hit : hits) {
    EXPECT_NEAR(hit.x_m, ahead_m, 1e-6);  // the lidar's plane meets the ground in a straight line
  }
}

TEST(Attitude, AWallIsFartherAwayAlongATiltedBeam) {
  LidarModel model = kExact;
  model.field_of_view_rad = 0;
  const double pitch_rad = radians(-15);
  const std::vector<Point2> levelled = scan(model, wall_ahead(5), {}, {.pitch_rad = pitch_rad});
  ASSERT_EQ(levelled.size(), 1U);
  EXPECT_NEAR(levelled[0].x_m, 5, 1e-7);
  const std::vector<Point2> as_if_level = scan(model, wall_ahead(5), {}, {.pitch_rad = pitch_rad, .levelled = false});
  ASSERT_EQ(as_if_level.size(), 1U);
  EXPECT_NEAR(as_if_level[0].x_m, 5 / std::cos(pitch_rad), 1e-7);
}

TEST(Attitude, ABeamThatPassesAboveTheWallsMeetsNothing) {
  LidarModel model = kExact;
  model.field_of_view_rad = 0;
  EXPECT_EQ(scan(model, wall_ahead(5), {}, {.pitch_rad = radians(-20)}).size(), 1U);  // 2.8 m up
  EXPECT_TRUE(scan(model, wall_ahead(5), {}, {.pitch_rad = radians(-23)}).empty());   // 3.1 m up
  EXPECT_TRUE(scan(model, wall_ahead(5), {}, {.height_m = 3.5}).empty());
}

TEST(Attitude, TiltedBeamsStillHitWallsAndColumnsWhereTheyAre) {
  for (const Attitude& attitude : {Attitude{.roll_rad = 0.1, .pitch_rad = -0.08}, Attitude{.roll_rad = -0.12},
                                   Attitude{.pitch_rad = 0.11, .height_m = 1.4}}) {
    for (const double heading_rad : {0.0, 0.7, -2.5}) {
      const Pose2 world_from_lidar = {1.7, 0.8, heading_rad};
      const std::vector<Point2> hits = scan(kExact, small_room(), world_from_lidar, attitude);
      EXPECT_EQ(hits.size(), 360U);
      int on_column = 0;
      for (const Point2& hit : hits) {
        const Point2 at = world_from_lidar * hit;
        const double to_wall = std::min({at.x_m, 4 - at.x_m, at.y_m, 2 - at.y_m});
        const double to_column = norm(at - Point2{3, 1}) - 0.25;
        EXPECT_NEAR(std::min(std::abs(to_wall), std::abs(to_column)), 0, 1e-6);
        on_column += std::abs(to_column) < 1e-6 ? 1 : 0;
      }
      EXPECT_NEAR(on_column, 22, 2);  // of asin(0.25 / 1.315) to either side
    }
  }
}

TEST(Attitude, TheGroundHidesWhatStandsBehindIt) {
  LidarModel model = kExact;
  model.field_of_view_rad = 0;
  const double pitch_rad = radians(20);  // meets the ground after 2.75 m
  EXPECT_NEAR(scan(model, wall_ahead(5), {}, {.pitch_rad = pitch_rad}).at(0).x_m, 1 / std::tan(pitch_rad), 1e-7);
  EXPECT_NEAR(scan(model, wall_ahead(2), {}, {.pitch_rad = pitch_rad}).at(0).x_m, 2, 1e-7);
}

}  // namespace
}  // namespace gridmerge::worlds
