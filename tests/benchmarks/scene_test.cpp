#include "worlds/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "worlds/ground.hpp"
#include "worlds/route.hpp"
#include "worlds/swarm.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::worlds {
namespace {

/// FNV-1a over the cells: short enough to be written down.
std::uint64_t fingerprint(const std::vector<const OccupancyGrid*>& grids) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const OccupancyGrid* grid : grids) {
    for (const std::int8_t cell : grid->cells) {
      hash = (hash ^ static_cast<std::uint8_t>(cell)) * 0x100000001b3U;
    }
  }
  return hash;
}

std::uint64_t fingerprint(const MapPair& pair) { return fingerprint({&pair.target, &pair.source}); }

std::size_t known_cells(const OccupancyGrid& grid) {
  return static_cast<std::size_t>(
      std::count_if(grid.cells.begin(), grid.cells.end(), [](std::int8_t cell) { return cell != kUnknown; }));
}

double distance(const Pose2& pose) { return norm(pose.translation()); }

/// A scene that must come out the same on every machine.
struct Pinned {
  std::string name;
  SceneOptions options;
  std::uint64_t cells = 0;
};

void PrintTo(const Pinned& pinned, std::ostream* out) { *out << pinned.name; }

/// One of every kind, every mapping and every group of options, coarse for quickness.
std::vector<Pinned> pinned_scenes() {
  return {{"office",
           {.kind = "office", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           12511541503222495740U},
          {"maze",
           {.kind = "maze", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           7564922443063921926U},
          {"flat",
           {.kind = "flat", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           1800641569121856193U},
          {"forest",
           {.kind = "forest", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           14048392855030865995U},
          {"corridor",
           {.kind = "corridor", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           12303205923529970315U},
          {"hall",
           {.kind = "hall", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           4079179976252027945U},
          {"warehouse",
           {.kind = "warehouse", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           9904811935178592173U},
          {"cave",
           {.kind = "cave", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           3730765743329912654U},
          {"spiral",
           {.kind = "spiral", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           10514686956810883255U},
          {"floors",
           {.kind = "floors", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           16846431791115326314U},
          {"bush_forest",
           {.kind = "bush_forest", .seed = 2, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           5957963175341050701U},
          {"two_worlds",
           {.kind = "spiral", .relation = "two_worlds", .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           3236782376243022326U},
          {"two_ends",
           {.kind = "maze", .relation = "two_ends", .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           8070269129919153162U},
          {"mirrored", {.kind = "flat", .relation = "mirrored", .resolution_m = 0.1}, 4285467460732907852U},
          {"two_floors",
           {.kind = "floors", .relation = "two_floors", .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           12620961203740863524U},
          {"two_buildings",
           {.kind = "flat", .relation = "two_buildings", .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           2858125218451615297U},
          {"wanted_overlap",
           {.kind = "maze", .wanted_overlap = 0.3, .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           6169347750327006809U},
          {"start_same",
           {.kind = "maze", .start = "same", .resolution_m = 0.2, .beam_step_deg = 1, .scan_step_m = 1},
           6549345566285459815U},
          {"start_opposite", {.kind = "flat", .start = "opposite", .resolution_m = 0.1}, 9534321229596555041U},
          {"start_near",
           {.kind = "flat", .start = "near", .start_distance_m = 3, .resolution_m = 0.1},
           8920245312787490877U},
          {"length_m",
           {.kind = "office", .length_m = 70, .resolution_m = 0.2, .beam_step_deg = 2, .scan_step_m = 2},
           2526318697234023902U},
          {"canvas",
           {.kind = "flat",
            .target_heading_deg = 10,
            .rotation_deg = -60,
            .origin_yaw_deg = 20,
            .resolution_m = 0.1,
            .size_cells = 300,
            .probabilistic = true},
           4044540398316930314U},
          {"rplidar", {.kind = "flat", .resolution_m = 0.1, .lidar = "rplidar_a3"}, 7651102201477392650U},
          {"hokuyo_utm", {.kind = "flat", .resolution_m = 0.1, .lidar = "hokuyo_utm30lx"}, 10760301469397756204U},
          {"hokuyo_urg", {.kind = "flat", .resolution_m = 0.1, .lidar = "hokuyo_urg04lx"}, 5875618386028063614U},
          {"rolling", {.kind = "flat", .resolution_m = 0.1, .roll_deg = 5, .height_m = 0.8}, 5910945005588268267U},
          {"robots_seen", {.kind = "flat", .resolution_m = 0.1, .robots_seen = 2}, 18267949036851212219U},
          {"drift", {.kind = "flat", .resolution_m = 0.1, .drift_m = 0.02, .drift_deg = 0.3}, 1744268708040342474U},
          {"noisy",
           {.kind = "flat", .resolution_m = 0.1, .mapping = "noisy", .pose_noise_m = 0.05, .pose_noise_deg = 1},
           1539203543550391639U},
          {"slam", {.kind = "flat", .seed = 2, .mapping = "slam"}, 10045044616243090186U},
          {"slam_alone",
           {.kind = "flat", .resolution_m = 0.1, .scan_step_m = 0.1, .mapping = "slam", .odometry = false},
           12662578319867032561U},
          {"slam_rolling",
           {.kind = "flat",
            .resolution_m = 0.1,
            .lidar = "rplidar_a3",
            .roll_deg = 4,
            .robots_seen = 1,
            .mapping = "slam",
            .drift_m = 0.02,
            .drift_deg = 0.5},
           8890663808073351180U}};
}

class PinnedScene : public testing::TestWithParam<Pinned> {};

TEST_P(PinnedScene, HasTheSameBytesOnEveryMachine) {
  EXPECT_EQ(fingerprint(make_scene(GetParam().options)), GetParam().cells);
}

INSTANTIATE_TEST_SUITE_P(, PinnedScene, testing::ValuesIn(pinned_scenes()),
                         [](const auto& pinned) { return pinned.param.name; });

class EveryMapping : public testing::TestWithParam<std::string> {};

TEST_P(EveryMapping, FindsTheTruthAtTheStart) {
  const MapPair pair = make_scene({.kind = "flat", .seed = 3, .resolution_m = 0.1, .mapping = GetParam()});
  EXPECT_NEAR(pair.target_from_source.theta_rad, radians(110), 1e-9);
  EXPECT_EQ(pair.target.at(pair.target.geometry.cell_at({0, 0})), kFree);
  EXPECT_TRUE(pair.truth_is_same);
}

TEST_P(EveryMapping, SaysHowFarItsPosesAreOff) {
  const MapPair pair = make_scene({.kind = "flat", .resolution_m = 0.1, .mapping = GetParam()});
  if (GetParam() == "known") {
    EXPECT_LT(pair.pose_error_m, 1e-9);
  } else {
    EXPECT_GT(pair.pose_error_m, 0.001);
    EXPECT_LT(pair.pose_error_m, 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(, EveryMapping, testing::Values("known", "noisy", "slam"),
                         [](const auto& mapping) { return mapping.param; });

TEST(Slam, MendsWhatOdometryGetsWrong) {
  const SceneOptions reckoned = {.kind = "flat", .target_share = 1, .drift_m = 0.03, .drift_deg = 1};
  SceneOptions matched = reckoned;
  matched.mapping = "slam";
  EXPECT_LT(make_scene(matched).pose_error_m, 0.5 * make_scene(reckoned).pose_error_m);
}

TEST(Slam, NeedsNoOdometryWhereScansAreClose) {
  const MapPair pair = make_scene({.kind = "flat", .scan_step_m = 0.1, .mapping = "slam", .odometry = false});
  EXPECT_LT(pair.pose_error_m, 0.1);
}

TEST(Relation, TellsWhetherTheTruthIsOnePlace) {
  const auto same = [](const char* kind, const char* relation) {
    return make_scene({.kind = kind, .relation = relation, .resolution_m = 0.2}).truth_is_same;
  };
  EXPECT_TRUE(same("flat", "overlap"));
  for (const char* relation : {"two_ends", "two_worlds", "mirrored", "two_buildings"}) {
    EXPECT_FALSE(same("office", relation)) << relation;
  }
  EXPECT_FALSE(same("floors", "two_floors"));
}

TEST(Relation, TwoFloorsHaveTheSameWallsAndOtherFurniture) {
  const World lower = make_world("floors", 5);
  const World upper = make_world("floors", 5, {.storey = 1});
  EXPECT_EQ(lower.length_m, upper.length_m);
  EXPECT_EQ(lower.places, upper.places);
  std::size_t shared = 0;
  for (const Segment& wall : lower.walls) {
    shared += std::any_of(upper.walls.begin(), upper.walls.end(),
                          [&](const Segment& other) { return other.from == wall.from && other.to == wall.to; })
                  ? 1
                  : 0;
  }
  EXPECT_GT(shared, lower.walls.size() / 2);
  EXPECT_LT(shared, lower.walls.size());
}

TEST(Relation, TwoBuildingsAreOfDifferentKinds) {
  const Tracks tracks = tracks_of({.kind = "flat", .relation = "two_buildings"});
  EXPECT_NE(tracks.target.world.length_m, tracks.source.world.length_m);
  EXPECT_GT(distance(make_scene({.kind = "flat", .relation = "two_buildings", .resolution_m = 0.2}).target_from_source),
            900);
}

TEST(Start, SameIsOneSpot) {
  const MapPair pair = make_scene({.kind = "maze", .start = "same", .rotation_deg = 40, .resolution_m = 0.2});
  EXPECT_LT(distance(pair.target_from_source), 1e-9);
  EXPECT_NEAR(pair.target_from_source.theta_rad, radians(40), 1e-9);
  const Tracks tracks = tracks_of({.kind = "maze", .start = "same"});
  EXPECT_NEAR(tracks.target.world_from_map.x_m, tracks.target.world.length_m / 2, 3);
}

TEST(Start, OppositeIsFarApart) {
  const MapPair pair = make_scene({.kind = "maze", .start = "opposite", .resolution_m = 0.2});
  EXPECT_GT(distance(pair.target_from_source), 20);
}

TEST(Start, NearIsAsFarAsAskedFor) {
  for (const double wanted_m : {1.0, 4.0, 9.0}) {
    const MapPair pair =
        make_scene({.kind = "office", .seed = 2, .start = "near", .start_distance_m = wanted_m, .resolution_m = 0.2});
    EXPECT_NEAR(distance(pair.target_from_source), wanted_m, 0.2);
  }
}

TEST(WantedOverlap, IsComeNearTo) {
  for (const double wanted : {0.15, 0.5, 0.85}) {
    const MapPair pair = make_scene({.kind = "floors", .wanted_overlap = wanted, .resolution_m = 0.2});
    EXPECT_NEAR(pair.overlap, wanted, 0.03) << wanted;
  }
}

TEST(WantedOverlap, TellsTheSharesThatGiveIt) {
  const SceneOptions wanted = {.kind = "flat", .seed = 4, .wanted_overlap = 0.6, .resolution_m = 0.1};
  const MapPair pair = make_scene(wanted);
  EXPECT_NEAR(pair.overlap, 0.6, 0.03);
  EXPECT_LT(pair.target_flown, 1);
  const Tracks tracks = tracks_of(wanted);
  const Pose2 target_from_source = inverse(tracks.target.world_from_map) * tracks.source.world_from_map;
  EXPECT_EQ(target_from_source, pair.target_from_source);
  EXPECT_GE(pair.target_share, 0.05);
}

TEST(SizeCells, IsASquareWithTheStartInItsMiddle) {
  const SceneOptions cropped = {.kind = "flat", .origin_yaw_deg = 25, .resolution_m = 0.1};
  SceneOptions square = cropped;
  square.size_cells = 512;
  const MapPair small = make_scene(cropped);
  const MapPair large = make_scene(square);
  for (const auto& [grid, other] : {std::pair{&large.target, &small.target}, std::pair{&large.source, &small.source}}) {
    EXPECT_EQ(grid->geometry.width, 512);
    EXPECT_EQ(grid->geometry.height, 512);
    EXPECT_EQ(grid->at({256, 256}), kFree);
    EXPECT_EQ(known_cells(*grid), known_cells(*other));
    const Point2 corner = grid->geometry.map_from_grid * Point2{25.6, 25.6};
    EXPECT_LT(norm(corner), 1e-9);
  }
  EXPECT_EQ(large.overlap, small.overlap);
}

TEST(SizeCells, LosesWhatLiesOutside) {
  const MapPair pair = make_scene({.kind = "flat", .resolution_m = 0.1, .size_cells = 64});
  EXPECT_EQ(pair.target.geometry.cell_count(), 64U * 64U);
  EXPECT_NO_THROW(check_grid(pair.target));
}

TEST(RobotsSeen, LeaveTracesAndNoOtherTruth) {
  const SceneOptions alone = {.kind = "hall", .start = "near", .resolution_m = 0.1};
  SceneOptions met = alone;
  met.robots_seen = 2;
  const MapPair first = make_scene(alone);
  const MapPair second = make_scene(met);
  EXPECT_EQ(first.target_from_source, second.target_from_source);
  EXPECT_NE(first.target.cells, second.target.cells);
}

TEST(Roll, SeesTheGround) {
  const SceneOptions level = {.kind = "hall", .resolution_m = 0.1};
  SceneOptions rolling = level;
  rolling.roll_deg = 10;
  rolling.height_m = 0.6;
  const auto walls = [](const OccupancyGrid& grid) {
    return std::count(grid.cells.begin(), grid.cells.end(), kOccupied);
  };
  EXPECT_NE(walls(make_scene(level).target), walls(make_scene(rolling).target));
}

TEST(LengthM, MakesTheWorldLonger) {
  for (const char* kind : {"office", "maze", "warehouse", "forest", "bush_forest", "cave", "corridor", "floors"}) {
    EXPECT_NEAR(make_world(kind, 3, {.length_m = 80}).length_m, 80, 8) << kind;
    EXPECT_GT(make_world(kind, 3, {.length_m = 80}).places.size(), make_world(kind, 3).places.size()) << kind;
  }
}

TEST(SceneProblems, NameEveryContradiction) {
  const SceneOptions options = {.kind = "flat",
                                .relation = "two_floors",
                                .wanted_overlap = 0.3,
                                .length_m = 50,
                                .lidar = "rplidar_a3",
                                .range_m = 3,
                                .mapping = "slam",
                                .odometry = false,
                                .drift_m = 0.1};
  EXPECT_THAT(
      scene_problems(options),
      testing::ElementsAre("length_m must be 0: flat comes in one length only",
                           "relation = two_floors needs kind = floors", "wanted_overlap needs relation = overlap",
                           "range_m, beam_step_deg, range_noise_m and dropout are those of lidar = custom: "
                           "leave them out with rplidar_a3",
                           "odometry = false needs scan_step_m of 0.1 or less",
                           "drift_m and drift_deg are those of odometry: leave them out, or odometry = false"));
  EXPECT_THROW(static_cast<void>(make_scene(options)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(tracks_of(options)), std::invalid_argument);
  EXPECT_TRUE(scene_problems({}).empty());
}

TEST(Tracks, AreTheWaysOfTheScene) {
  const SceneOptions options = {.kind = "office", .seed = 6, .resolution_m = 0.2};
  const Tracks tracks = tracks_of(options);
  const MapPair pair = make_scene(options);
  EXPECT_EQ(inverse(tracks.target.world_from_map) * tracks.source.world_from_map, pair.target_from_source);
  EXPECT_GT(tracks.target.world_from_robot.size(), 50U);
  EXPECT_EQ(tracks.target.world_from_robot.front(), tracks.target.world_from_map);
}

class EveryWorld : public testing::TestWithParam<std::string> {};

TEST_P(EveryWorld, CanBeVisitedAsAWhole) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = make_world(GetParam(), seed);
    const std::vector<Point2> route = plan_route(world, {0, world.length_m}, {-1e9, 1e9}, 0, 0.2);
    std::size_t reached = 0;
    for (const Point2& place : world.places) {
      reached += std::any_of(route.begin(), route.end(), [&](Point2 at) { return norm(at - place) < 1.6; }) ? 1 : 0;
    }
    EXPECT_GE(10 * reached, 9 * world.places.size()) << "seed " << seed;
    EXPECT_GE(world.places.size(), 5U);
  }
}

TEST_P(EveryWorld, LetsAMapperKeepItsWay) {
  const MapPair pair = make_scene({.kind = GetParam(), .seed = 4, .resolution_m = 0.1, .mapping = "slam"});
  const bool alike_all_along = GetParam() == "corridor" || GetParam() == "spiral";
  EXPECT_LT(pair.pose_error_m, alike_all_along ? 10 : 0.3);
}

INSTANTIATE_TEST_SUITE_P(, EveryWorld, testing::ValuesIn(world_kinds()), [](const auto& kind) { return kind.param; });

/// Whether overlaps of at least `least` join all maps of a swarm.
bool hangs_together(const Swarm& swarm, double least) {
  std::vector<std::size_t> reached = {0};
  std::vector<bool> visited(swarm.maps.size(), false);
  visited[0] = true;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::size_t from = reached[i];
    for (std::size_t to = 0; to < swarm.maps.size(); ++to) {
      const Pose2 from_to = inverse(swarm.world_from_map[from]) * swarm.world_from_map[to];
      if (!visited[to] && overlap_of(swarm.maps[from], swarm.maps[to], from_to) >= least) {
        visited[to] = true;
        reached.push_back(to);
      }
    }
  }
  return reached.size() == swarm.maps.size();
}

TEST(Swarm, HangsTogether) {
  for (const char* kind : {"office", "maze", "warehouse"}) {
    for (const int robots : {2, 7}) {
      const Swarm swarm = make_swarm({.kind = kind, .resolution_m = 0.2, .beam_step_deg = 1}, robots);
      ASSERT_EQ(swarm.maps.size(), static_cast<std::size_t>(robots));
      ASSERT_EQ(swarm.world_from_map.size(), static_cast<std::size_t>(robots));
      EXPECT_TRUE(hangs_together(swarm, 0.2)) << kind << " " << robots;
    }
  }
}

TEST(Swarm, IsTheSameOnAnyNumberOfThreads) {
  const SceneOptions options = {.kind = "maze", .resolution_m = 0.2, .beam_step_deg = 1, .robots_seen = 1};
  const Swarm one = make_swarm(options, 5, 1);
  const Swarm four = make_swarm(options, 5, 4);
  EXPECT_EQ(one.maps, four.maps);
  EXPECT_EQ(one.world_from_map, four.world_from_map);
  std::vector<const OccupancyGrid*> grids;
  for (const OccupancyGrid& map : one.maps) {
    grids.push_back(&map);
  }
  EXPECT_EQ(fingerprint(grids), 10019467378929658054U);
}

TEST(Swarm, GrowsWithItsRobots) {
  const SceneOptions options = {.kind = "maze", .resolution_m = 0.5, .beam_step_deg = 4, .scan_step_m = 2};
  const Swarm swarm = make_swarm(options, 32);
  EXPECT_EQ(swarm.maps.size(), 32U);
  EXPECT_GT(swarm.world.length_m, 80);
  for (const OccupancyGrid& map : swarm.maps) {
    EXPECT_GT(known_cells(map), 50U);
  }
}

TEST(Swarm, RefusesWhatOnlyPairsHave) {
  EXPECT_THROW(static_cast<void>(make_swarm({}, 1)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_swarm({}, 33)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_swarm({.relation = "mirrored"}, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_swarm({.start = "same"}, 3)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(make_swarm({.kind = "flat"}, 32)), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge::worlds
