#include "worlds/swarm.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"
#include "worlds/route.hpp"
#include "worlds/survey.hpp"

namespace gridmerge::worlds {
namespace {

constexpr Share kEverywhere = {-1e9, 1e9};

std::vector<std::string> swarm_problems(const SceneOptions& options, int robots) {
  std::vector<std::string> problems = scene_problems(options);
  const SceneOptions usual;
  const auto rule = [&](bool broken, std::string problem) {
    if (broken) {
      problems.push_back(std::move(problem));
    }
  };
  rule(robots < 2 || robots > 32, "robots = " + std::to_string(robots) + " is out of range: 2 .. 32");
  rule(options.relation != usual.relation, "many robots need relation = overlap");
  rule(options.start != usual.start, "many robots need start = random");
  rule(options.wanted_overlap != 0, "wanted_overlap is for two robots");
  rule(options.target_share != usual.target_share || options.source_share != usual.source_share,
       "target_share and source_share are for two robots: many share the world out among them");
  return problems;
}

/// Four robots find the kind's own length large enough; the area grows with their number.
double length_for(const SceneOptions& options, int robots) {
  if (options.length_m > 0 || robots <= 4 || !world_grows(options.kind)) {
    return options.length_m;
  }
  return std::round(usual_length_m(options.kind) * std::sqrt(robots / 4.0));
}

using Places = std::vector<Point2>;

/// Cuts the places in two across the longer side of where they lie, in proportion to the robots on either side, until
/// each robot has its own.
void share_out(Places places, int robots, std::vector<Places>& parts) {
  if (robots == 1) {
    parts.push_back(std::move(places));
    return;
  }
  const auto [left, right] =
      std::minmax_element(places.begin(), places.end(), [](Point2 a, Point2 b) { return a.x_m < b.x_m; });
  const auto [low, high] =
      std::minmax_element(places.begin(), places.end(), [](Point2 a, Point2 b) { return a.y_m < b.y_m; });
  const bool by_x = right->x_m - left->x_m >= high->y_m - low->y_m;
  std::stable_sort(places.begin(), places.end(),
                   [&](Point2 a, Point2 b) { return by_x ? a.x_m < b.x_m : a.y_m < b.y_m; });
  const int first = robots / 2;
  const auto cut =
      static_cast<std::ptrdiff_t>(places.size() * static_cast<std::size_t>(first) / static_cast<std::size_t>(robots));
  share_out({places.begin(), places.begin() + cut}, first, parts);
  share_out({places.begin() + cut, places.end()}, robots - first, parts);
}

double far2(Point2 a, Point2 b) {
  const Point2 way = a - b;
  return way.x_m * way.x_m + way.y_m * way.y_m;
}

/// The part and, of all other places, two thirds as many again (at least two): those nearest to one of its own.
Places with_surroundings(const Places& part, const Places& all) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double least2 = far2(part.front(), all[i]);
    for (const Point2& own : part) {
      least2 = std::min(least2, far2(own, all[i]));
    }
    if (least2 > 0) {
      near.emplace_back(least2, i);
    }
  }
  std::sort(near.begin(), near.end());
  Places grown = part;
  for (std::size_t i = 0; i < std::min(near.size(), std::max<std::size_t>(2, part.size() * 2 / 3)); ++i) {
    grown.push_back(all[near[i].second]);
  }
  return grown;
}

std::vector<Flight> flights_of(const World& world, const SceneOptions& options, int robots) {
  const Ground ground(world, kEverywhere);
  std::vector<Places> parts;
  share_out(world.places, robots, parts);
  std::vector<Flight> flights;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto index = static_cast<double>(i);
    Robot robot = {.name = "robot " + std::to_string(i + 1),
                   .share = kEverywhere,
                   .sight = kEverywhere,
                   .heading_rad = wrap_angle(radians(options.target_heading_deg + index * options.rotation_deg)),
                   .origin_yaw_rad = radians(i == 0 ? 0 : options.origin_yaw_deg)};
    RandomStream random(static_cast<std::uint64_t>(options.seed), robot.name + "/start");
    const Point2 from = parts[i][random.below(static_cast<std::uint32_t>(parts[i].size()))];
    const std::vector<Point2> way =
        plan_tour(ground, from, with_surroundings(parts[i], world.places), options.scan_step_m);
    std::vector<Pose2> poses = poses_along(way, robot.heading_rad, options);
    const Pose2 first = poses.front();
    flights.push_back({std::move(robot), {world, first, std::move(poses)}});
  }
  return flights;
}

}  // namespace

Swarm make_swarm(const SceneOptions& options, int robots, int num_threads) {
  std::vector<std::string> problems = swarm_problems(options, robots);
  if (!problems.empty()) {
    throw_invalid_options("swarm", problems);
  }
  World world =
      make_world(options.kind, static_cast<std::uint64_t>(options.seed), {.length_m = length_for(options, robots)});
  if (world.places.size() < static_cast<std::size_t>(robots)) {
    throw_invalid_options(
        "swarm", {"a world of kind " + options.kind + " is too small for " + std::to_string(robots) + " robots"});
  }
  const std::vector<Flight> flights = flights_of(world, options, robots);
  Swarm swarm = {.world = std::move(world), .maps = std::vector<OccupancyGrid>(flights.size()), .world_from_map = {}};
  for (const Flight& flight : flights) {
    swarm.world_from_map.push_back(flight.track.world_from_map);
  }
  parallel_for(flights.size(), num_threads, [&](std::size_t i, std::size_t /*worker*/) {
    std::vector<const Track*> seen;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(options.robots_seen) && k < flights.size(); ++k) {
      seen.push_back(&flights[(i + k) % flights.size()].track);
    }
    swarm.maps[i] = survey(flights[i], seen, options).map;
  });
  return swarm;
}

}  // namespace gridmerge::worlds
