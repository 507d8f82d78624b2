#include "worlds/scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "gridmerge/base/random.hpp"
#include "worlds/lidar.hpp"
#include "worlds/mapper.hpp"
#include "worlds/portable.hpp"
#include "worlds/route.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {
namespace {

struct Robot {
  std::string name;  // of its random streams
  Share share;
  Share sight;  // where it may go, and what it can see, at all
  double heading_rad = 0;
  double origin_yaw_rad = 0;
};

struct Survey {
  OccupancyGrid map;
  Pose2 world_from_map;
};

/// A grid that holds the whole world and some drift, in the frame of the robot's first pose.
GridGeometry canvas(const World& world, const Pose2& map_from_world, double origin_yaw_rad, double resolution_m) {
  constexpr double kSpare = 3;  // [m]
  const Pose2 turned_from_world = Pose2{0, 0, -origin_yaw_rad} * map_from_world;
  Point2 low = turned_from_world * Point2{};
  Point2 high = low;
  for (const Point2& corner :
       {Point2{world.length_m, 0}, Point2{world.length_m, world.depth_m}, Point2{0, world.depth_m}}) {
    const Point2 at = turned_from_world * corner;
    low = {std::min(low.x_m, at.x_m), std::min(low.y_m, at.y_m)};
    high = {std::max(high.x_m, at.x_m), std::max(high.y_m, at.y_m)};
  }
  const auto cells = [&](double length_m) { return static_cast<int>(std::ceil(length_m / resolution_m)); };
  const int left = cells(kSpare - low.x_m);
  const int below = cells(kSpare - low.y_m);
  return {.width = left + cells(high.x_m + kSpare),
          .height = below + cells(high.y_m + kSpare),
          .resolution_m = resolution_m,
          .map_from_grid = Pose2{0, 0, origin_yaw_rad} * Pose2{-left * resolution_m, -below * resolution_m, 0}};
}

Survey survey(const World& world, const Robot& robot, const SceneOptions& options) {
  const auto seed = static_cast<std::uint64_t>(options.seed);
  RandomStream start(seed, robot.name + "/start");
  RandomStream chance(seed, robot.name + "/lidar");
  RandomStream drift(seed, robot.name + "/drift");
  const std::vector<Point2> route =
      plan_route(world, robot.share, robot.sight, start.below(1U << 16), options.scan_step_m);
  const Pose2 world_from_map = {route.front().x_m, route.front().y_m, robot.heading_rad};
  const Lidar lidar({.range_m = options.range_m,
                     .step_rad = radians(options.beam_step_deg),
                     .noise_m = options.range_noise_m,
                     .dropout = options.dropout});
  Mapper mapper(canvas(world, inverse(world_from_map), robot.origin_yaw_rad, options.resolution_m));

  const double per_step = std::sqrt(options.scan_step_m);  // errors grow with the root of the way
  Pose2 world_from_lidar = world_from_map;
  Pose2 map_from_lidar;  // as the robot believes
  mapper.add(map_from_lidar, lidar.scan(world, robot.sight, world_from_lidar, chance));
  for (std::size_t i = 1; i < route.size(); ++i) {
    const Point2 way = route[i] - route[i - 1];
    const Pose2 world_from_next = {route[i].x_m, route[i].y_m, std::atan2(way.y_m, way.x_m)};
    const double slip_m = options.drift_m * per_step * drift.normal();
    const double twist_rad = radians(options.drift_deg) * per_step * drift.normal();
    map_from_lidar = map_from_lidar * (inverse(world_from_lidar) * world_from_next) * Pose2{slip_m, 0, twist_rad};
    world_from_lidar = world_from_next;
    mapper.add(map_from_lidar, lidar.scan(world, robot.sight, world_from_lidar, chance));
  }
  return {mapper.grid(options.probabilistic), world_from_map};
}

}  // namespace

void SceneOptions::describe(OptionList& list) {
  list.add("kind", kind, world_kinds(),
           {"", "What the world is like.", "corridor and hall cannot be told apart from themselves, moved or turned"})
      .add("seed", seed, 0, 1 << 30, {"", "From it comes all chance: the world, the routes, the noise.", ""})
      .add("relation", relation, {"overlap", "two_ends", "two_worlds", "mirrored"},
           {"",
            "How the maps relate: parts of one world; its two ends, which share nothing; two worlds of one kind; "
            "a world and its mirror image.",
            ""})
      .add("target_share", target_share, 0.05, 1,
           {"", "Share of the world that the target's robot visits, from the left.", "with source_share: the overlap"})
      .add("source_share", source_share, 0.05, 1,
           {"", "Share of the world that the source's robot visits, from the right.", ""})
      .add("target_heading_deg", target_heading_deg, -180, 180, {"deg", "Heading of the target's x axis.", ""})
      .add("rotation_deg", rotation_deg, -180, 180,
           {"deg", "How far the source's frame is turned in the target's.", ""})
      .add("origin_yaw_deg", origin_yaw_deg, -180, 180, {"deg", "Yaw of the origin of the source's grid.", ""})
      .add("resolution_m", resolution_m, 0.01, 1, {"m", "Side of a cell.", "half of it draws four times as many cells"})
      .add("probabilistic", probabilistic, {"", "Cells of 0..100 instead of 0 or 100.", ""})
      .add("range_m", range_m, 0.5, 100, {"m", "How far the lidar sees.", ""})
      .add("beam_step_deg", beam_step_deg, 0.05, 10, {"deg", "Angle between two beams.", ""})
      .add("range_noise_m", range_noise_m, 0, 1, {"m", "Standard deviation of a range.", ""})
      .add("dropout", dropout, 0, 1, {"", "Share of the beams that are lost.", ""})
      .add("scan_step_m", scan_step_m, 0.05, 10, {"m", "Way between two scans.", "time grows with its inverse"})
      .add("drift_m", drift_m, 0, 1, {"m", "Standard deviation of the position's slip after a metre.", ""})
      .add("drift_deg", drift_deg, 0, 10,
           {"deg", "Standard deviation of the heading's slip after a metre.",
            "the truth holds at the start poses: drift bends the maps away from it"});
}

MapPair make_scene(const SceneOptions& options) {
  require_valid(options, "scene");
  const auto seed = static_cast<std::uint64_t>(options.seed);
  const bool apart = options.relation == "two_ends";
  const World target_world = make_world(options.kind, seed);
  World source_world = target_world;
  if (options.relation == "two_worlds") {
    source_world = make_world(options.kind, seed + (std::uint64_t{1} << 32));
  } else if (options.relation == "mirrored") {
    source_world = mirrored(target_world);
  }
  constexpr Share kEverywhere = {-1e9, 1e9};
  const double middle_m = target_world.length_m / 2;
  const double target_share = apart ? std::min(options.target_share, 0.45) : options.target_share;
  const double source_share = apart ? std::min(options.source_share, 0.45) : options.source_share;
  const Robot target_robot = {.name = "target",
                              .share = {0, target_share * target_world.length_m},
                              .sight = apart ? Share{-1e9, 0.98 * middle_m} : kEverywhere,
                              .heading_rad = radians(options.target_heading_deg)};
  const Robot source_robot = {.name = "source",
                              .share = {(1 - source_share) * source_world.length_m, source_world.length_m},
                              .sight = apart ? Share{1.02 * middle_m, 1e9} : kEverywhere,
                              .heading_rad = radians(options.target_heading_deg + options.rotation_deg),
                              .origin_yaw_rad = radians(options.origin_yaw_deg)};
  Survey target = survey(target_world, target_robot, options);
  Survey source = survey(source_world, source_robot, options);

  constexpr double kFarAway = 1000;  // [m]
  const bool one_world = options.relation == "overlap" || apart;
  const Pose2 first_from_second = {one_world ? 0 : kFarAway, 0, 0};
  MapPair pair = {std::move(target.map), std::move(source.map),
                  inverse(target.world_from_map) * first_from_second * source.world_from_map};
  pair.overlap = overlap_of(pair.target, pair.source, pair.target_from_source);
  return pair;
}

double overlap_of(const OccupancyGrid& target, const OccupancyGrid& source, const Pose2& target_from_source) {
  std::size_t known = 0;
  std::size_t shared = 0;
  for (int row = 0; row < source.geometry.height; ++row) {
    for (int column = 0; column < source.geometry.width; ++column) {
      if (source.at({column, row}) == kUnknown) {
        continue;
      }
      ++known;
      const CellIndex cell = target.geometry.cell_at(target_from_source * source.geometry.cell_centre({column, row}));
      shared += target.geometry.contains(cell) && target.at(cell) != kUnknown ? 1 : 0;
    }
  }
  return known == 0 ? 0 : static_cast<double>(shared) / static_cast<double>(known);
}

}  // namespace gridmerge::worlds
