#include "worlds/flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "gridmerge/base/random.hpp"
#include "worlds/route.hpp"

namespace gridmerge::worlds {
namespace {

constexpr Share kEverywhere = {-1e9, 1e9};

std::uint64_t seed_of(const SceneOptions& options) { return static_cast<std::uint64_t>(options.seed); }

World variant(const SceneOptions& options, const std::string& kind, std::uint64_t seed, int storey = 0) {
  return make_world(kind, seed, {.length_m = world_grows(kind) ? options.length_m : 0, .storey = storey});
}

/// The world as the source's robot finds it.
World changed(const SceneOptions& options, std::uint64_t seed) {
  return make_world(options.kind, seed,
                    {.length_m = world_grows(options.kind) ? options.length_m : 0,
                     .rearranged_share = options.rearranged_share,
                     .cleared = options.cleared});
}

std::string another_building(const SceneOptions& options) {
  constexpr std::array<const char*, 5> kBuildings = {"office", "flat", "warehouse", "floors", "maze"};
  std::vector<std::string> others(kBuildings.begin(), kBuildings.end());
  others.erase(std::remove(others.begin(), others.end(), options.kind), others.end());
  RandomStream random(seed_of(options), "scene/other building");
  return others[random.below(static_cast<std::uint32_t>(others.size()))];
}

World world_of(const SceneOptions& options, Role role) {
  const std::uint64_t seed = seed_of(options);
  const std::uint64_t other_seed = seed + (std::uint64_t{1} << 32);
  if (role == Role::kSource && options.relation == "two_worlds") {
    return variant(options, options.kind, other_seed);
  }
  if (role == Role::kSource && options.relation == "two_buildings") {
    return variant(options, another_building(options), other_seed);
  }
  if (role == Role::kSource && options.relation == "two_floors") {
    return variant(options, options.kind, seed, 1);
  }
  const bool of_source = role == Role::kSource;
  const World world = of_source ? changed(options, seed) : variant(options, options.kind, seed);
  return of_source && options.relation == "mirrored" ? mirrored(world) : world;
}

Robot robot_of(const SceneOptions& options, Role role, double length_m) {
  const bool apart = options.relation == "two_ends";
  const double most = apart ? 0.45 : 1;
  const double middle_m = length_m / 2;
  if (role == Role::kTarget) {
    return {.name = "target",
            .share = {0, std::min(options.target_share, most) * length_m},
            .sight = apart ? Share{-1e9, 0.98 * middle_m} : kEverywhere,
            .heading_rad = radians(options.target_heading_deg)};
  }
  return {.name = "source",
          .share = {(1 - std::min(options.source_share, most)) * length_m, length_m},
          .sight = apart ? Share{1.02 * middle_m, 1e9} : kEverywhere,
          .heading_rad = radians(options.target_heading_deg + options.rotation_deg),
          .origin_yaw_rad = radians(options.origin_yaw_deg)};
}

double far2(Point2 a, Point2 b) {
  const Point2 way = a - b;
  return way.x_m * way.x_m + way.y_m * way.y_m;
}

Point2 middle_place(const World& world) {
  const Point2 middle = {world.length_m / 2, world.depth_m / 2};
  return *std::min_element(world.places.begin(), world.places.end(),
                           [&](Point2 a, Point2 b) { return far2(a, middle) < far2(b, middle); });
}

/// For the target a place of the world, for the source a spot at the wanted distance from it: as near to it as may be.
Point2 start_near(const World& world, const Ground& ground, const SceneOptions& options, Role role) {
  constexpr double kSlack = 0.15;  // [m] less than a cell of the ground
  RandomStream random(seed_of(options), "scene/near");
  const Point2 place = world.places[random.below(static_cast<std::uint32_t>(world.places.size()))];
  const int first = ground.near(place, 1e4);
  if (role == Role::kTarget || first == Ground::kNone) {
    return place;
  }
  const Point2 from = ground.centre(first);
  for (double slack_m = kSlack; slack_m < world.length_m; slack_m *= 2) {
    const double wanted_m = options.start_distance_m;
    const std::vector<int> spots = ground.ring(from, std::max(0.0, wanted_m - slack_m), wanted_m + slack_m);
    if (!spots.empty()) {
      return ground.centre(spots[random.below(static_cast<std::uint32_t>(spots.size()))]);
    }
  }
  return place;
}

/// As far to its own side of the world as the robot's share goes.
Point2 outmost_place(const World& world, const Share& share, Role role) {
  std::vector<Point2> places = places_in(world, share);
  places = places.empty() ? world.places : places;
  const auto by_x = [](Point2 a, Point2 b) { return a.x_m < b.x_m; };
  return role == Role::kTarget ? *std::min_element(places.begin(), places.end(), by_x)
                               : *std::max_element(places.begin(), places.end(), by_x);
}

std::vector<Point2> way_of(const World& world, const Robot& robot, const SceneOptions& options, Role role) {
  const double step_m = options.scan_step_m;
  if (options.start == "random") {
    RandomStream start(seed_of(options), robot.name + "/start");
    return plan_route(world, robot.share, robot.sight, start.below(1U << 16), step_m);
  }
  const Ground ground(world, robot.sight);
  const Point2 from = options.start == "same"   ? middle_place(world)
                      : options.start == "near" ? start_near(world, ground, options, role)
                                                : outmost_place(world, robot.share, role);
  return plan_tour(ground, from, places_in(world, robot.share), step_m);
}

}  // namespace

std::vector<Pose2> poses_along(const std::vector<Point2>& way, double heading_rad, const SceneOptions& options) {
  const bool blind = options.mapping == "slam" && !options.odometry;  // nothing tells of a turn but the scans
  const double widest_rad = blind ? radians(2) : 2 * kPi;             // between two scans
  std::vector<Pose2> poses = {{way.front().x_m, way.front().y_m, heading_rad}};
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point2 step = way[i] - way[i - 1];
    const double ahead_rad = std::atan2(step.y_m, step.x_m);
    const double turn_rad = wrap_angle(ahead_rad - poses.back().theta_rad);
    const double slow_rad = wrap_angle(poses.back().theta_rad + std::clamp(turn_rad, -widest_rad, widest_rad));
    poses.push_back({way[i].x_m, way[i].y_m, std::abs(turn_rad) <= widest_rad ? ahead_rad : slow_rad});
  }
  return poses;
}

Flight flight_of(const SceneOptions& options, Role role, double flown) {
  World world = world_of(options, role);
  world.winding = world.winding && options.relation != "two_ends";
  Robot robot = robot_of(options, role, world.length_m);
  std::vector<Pose2> poses = poses_along(way_of(world, robot, options, role), robot.heading_rad, options);
  poses.resize(std::max<std::size_t>(1, static_cast<std::size_t>(flown * static_cast<double>(poses.size()))));
  const Pose2 first = poses.front();
  return {std::move(robot), {std::move(world), first, std::move(poses)}};
}

}  // namespace gridmerge::worlds
