#include "worlds/survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gridmerge/base/random.hpp"
#include "worlds/lidar.hpp"
#include "worlds/mapper.hpp"
#include "worlds/slam.hpp"

namespace gridmerge::worlds {
namespace {

/// A grid that holds the whole world and some drift, in the frame of the robot's first pose.
GridGeometry canvas(const World& world, const Pose2& map_from_world, double origin_yaw_rad,
                    const SceneOptions& options) {
  const double spare_m = options.mapping == "slam" ? 8 : 3;
  const Pose2 turned_from_world = Pose2{0, 0, -origin_yaw_rad} * map_from_world;
  Point2 low = turned_from_world * Point2{};
  Point2 high = low;
  for (const Point2& corner :
       {Point2{world.length_m, 0}, Point2{world.length_m, world.depth_m}, Point2{0, world.depth_m}}) {
    const Point2 at = turned_from_world * corner;
    low = {std::min(low.x_m, at.x_m), std::min(low.y_m, at.y_m)};
    high = {std::max(high.x_m, at.x_m), std::max(high.y_m, at.y_m)};
  }
  const double resolution_m = options.resolution_m;
  const auto cells = [&](double length_m) { return static_cast<int>(std::ceil(length_m / resolution_m)); };
  const int left = cells(spare_m - low.x_m);
  const int below = cells(spare_m - low.y_m);
  return {.width = left + cells(high.x_m + spare_m),
          .height = below + cells(high.y_m + spare_m),
          .resolution_m = resolution_m,
          .map_from_grid = Pose2{0, 0, origin_yaw_rad} * Pose2{-left * resolution_m, -below * resolution_m, 0}};
}

LidarModel model_of(const SceneOptions& options) {
  if (options.lidar != "custom") {
    return lidar_model(options.lidar);
  }
  return {.range_m = options.range_m,
          .step_rad = radians(options.beam_step_deg),
          .noise_m = options.range_noise_m,
          .dropout = options.dropout};
}

/// Roll and pitch in flight: each is like the one before, and is forgotten after a few scans.
class Sway {
 public:
  Sway(const SceneOptions& options, const std::string& name)
      : random_(static_cast<std::uint64_t>(options.seed), name + "/sway"),
        deviation_rad_(radians(options.roll_deg)),
        attitude_({.height_m = options.height_m}) {}

  [[nodiscard]] Attitude next() {
    if (deviation_rad_ > 0) {
      attitude_.roll_rad = swayed(attitude_.roll_rad);
      attitude_.pitch_rad = swayed(attitude_.pitch_rad);
    }
    return attitude_;
  }

 private:
  double swayed(double angle_rad) {
    const double most_rad = radians(60);
    return std::clamp(0.8 * angle_rad + 0.6 * deviation_rad_ * random_.normal(), -most_rad, most_rad);
  }

  RandomStream random_;
  double deviation_rad_;
  Attitude attitude_;
};

/// What the robot sees on its way, scan by scan.
class Eyes {
 public:
  Eyes(const Flight& flight, const std::vector<const Track*>& seen, const SceneOptions& options)
      : flight_(flight),
        seen_(seen),
        lidar_(model_of(options)),
        chance_(static_cast<std::uint64_t>(options.seed), flight.robot.name + "/lidar"),
        sway_(options, flight.robot.name) {}

  [[nodiscard]] std::vector<Point2> scan(std::size_t stop) {
    const Pose2& world_from_lidar = flight_.track.world_from_robot[stop];
    return lidar_.scan(flight_.track.world, flight_.robot.sight, world_from_lidar, chance_, sway_.next(), others(stop));
  }

 private:
  [[nodiscard]] std::vector<Disc> others(std::size_t stop) const {
    constexpr double kRadius = 0.25;  // [m]
    constexpr double kTooNear = 0.6;  // [m] then one flies above the other
    std::vector<Disc> discs;
    for (const Track* track : seen_) {
      const Point2 at = track->world_from_robot[std::min(stop, track->world_from_robot.size() - 1)].translation();
      const Point2 way = at - flight_.track.world_from_robot[stop].translation();
      if (way.x_m * way.x_m + way.y_m * way.y_m > kTooNear * kTooNear) {
        discs.push_back({at, kRadius});
      }
    }
    return discs;
  }

  const Flight& flight_;
  const std::vector<const Track*>& seen_;
  Lidar lidar_;
  RandomStream chance_;
  Sway sway_;
};

/// map_from_lidar as given, off by the noise of a single pose.
class Jitter {
 public:
  Jitter(const SceneOptions& options, const std::string& name)
      : random_(static_cast<std::uint64_t>(options.seed), name + "/pose"),
        noisy_(options.mapping == "noisy"),
        noise_m_(options.pose_noise_m),
        noise_rad_(radians(options.pose_noise_deg)) {}

  [[nodiscard]] Pose2 off(const Pose2& map_from_lidar) {
    if (!noisy_) {
      return map_from_lidar;
    }
    const Pose2 error = {noise_m_ * random_.normal(), noise_m_ * random_.normal(), noise_rad_ * random_.normal()};
    return map_from_lidar * error;
  }

 private:
  RandomStream random_;
  bool noisy_;
  double noise_m_;
  double noise_rad_;
};

/// The poses that were believed, and how far off the truth they are.
class Believed {
 public:
  Believed() : map_from_robot_({Pose2{}}) {}

  void add(const Pose2& believed, const Pose2& truth) {
    map_from_robot_.push_back(believed);
    const Point2 off = believed.translation() - truth.translation();
    const double turn_rad = wrap_angle(believed.theta_rad - truth.theta_rad);
    off2_m2_ += off.x_m * off.x_m + off.y_m * off.y_m;
    turn2_rad2_ += turn_rad * turn_rad;
    ++count_;
  }
  [[nodiscard]] double distance_m() const { return std::sqrt(off2_m2_ / std::max(1, count_)); }
  [[nodiscard]] double angle_rad() const { return std::sqrt(turn2_rad2_ / std::max(1, count_)); }
  [[nodiscard]] const std::vector<Pose2>& map_from_robot() const { return map_from_robot_; }

 private:
  std::vector<Pose2> map_from_robot_;
  double off2_m2_ = 0;
  double turn2_rad2_ = 0;
  int count_ = 0;
};

/// What odometry tells of each step: it slips with the root of the way.
class Odometry {
 public:
  Odometry(const Flight& flight, const SceneOptions& options)
      : stops_(flight.track.world_from_robot),
        random_(static_cast<std::uint64_t>(options.seed), flight.robot.name + "/drift"),
        slip_m_(options.drift_m * std::sqrt(options.scan_step_m)),
        twist_rad_(radians(options.drift_deg) * std::sqrt(options.scan_step_m)) {}

  /// map_from_lidar at a stop, from that at the stop before it.
  [[nodiscard]] Pose2 told(std::size_t stop, const Pose2& map_from_before) {
    const double slip_m = slip_m_ * random_.normal();
    const double twist_rad = twist_rad_ * random_.normal();
    return map_from_before * (inverse(stops_[stop - 1]) * stops_[stop]) * Pose2{slip_m, 0, twist_rad};
  }

 private:
  const std::vector<Pose2>& stops_;
  RandomStream random_;
  double slip_m_;
  double twist_rad_;
};

/// Dead reckoning: drawn from where odometry says the robot is.
Believed map_on_given_poses(const Flight& flight, Eyes& eyes, Mapper& mapper, const SceneOptions& options) {
  Odometry odometry(flight, options);
  Jitter jitter(options, flight.robot.name);
  Believed believed;
  const std::vector<Pose2>& stops = flight.track.world_from_robot;
  Pose2 map_from_lidar;
  mapper.add(map_from_lidar, eyes.scan(0));
  for (std::size_t i = 1; i < stops.size(); ++i) {
    map_from_lidar = odometry.told(i, map_from_lidar);
    const Pose2 drawn_from = jitter.off(map_from_lidar);
    believed.add(drawn_from, inverse(flight.track.world_from_map) * stops[i]);
    mapper.add(drawn_from, eyes.scan(i));
  }
  return believed;
}

/// Each scan is matched to the map: from where odometry says that it was taken, or from where the last one was.
Believed map_by_matching(const Flight& flight, Eyes& eyes, HectorMapper& mapper, const SceneOptions& options) {
  Odometry odometry(flight, options);
  Believed believed;
  const std::vector<Pose2>& stops = flight.track.world_from_robot;
  Pose2 map_from_lidar = mapper.add({}, eyes.scan(0));
  for (std::size_t i = 1; i < stops.size(); ++i) {
    const Pose2 guess = options.odometry ? odometry.told(i, map_from_lidar) : map_from_lidar;
    map_from_lidar = mapper.add(guess, eyes.scan(i));
    believed.add(map_from_lidar, inverse(flight.track.world_from_map) * stops[i]);
  }
  return believed;
}

/// On a square canvas with the start in its middle.
OccupancyGrid published(const OccupancyGrid& map, int size_cells, double origin_yaw_rad) {
  if (size_cells == 0) {
    return map;
  }
  const double half_m = size_cells / 2 * map.geometry.resolution_m;
  OccupancyGrid square = unknown_grid({.width = size_cells,
                                       .height = size_cells,
                                       .resolution_m = map.geometry.resolution_m,
                                       .map_from_grid = Pose2{0, 0, origin_yaw_rad} * Pose2{-half_m, -half_m, 0}});
  const Pose2 square_from_map = inverse(square.geometry.map_from_grid) * map.geometry.map_from_grid;
  const auto left = static_cast<int>(std::lround(square_from_map.x_m / map.geometry.resolution_m));
  const auto below = static_cast<int>(std::lround(square_from_map.y_m / map.geometry.resolution_m));
  for (int row = 0; row < map.geometry.height; ++row) {
    for (int column = 0; column < map.geometry.width; ++column) {
      const CellIndex to = {left + column, below + row};
      if (square.geometry.contains(to)) {
        square.at(to) = map.at({column, row});
      }
    }
  }
  return square;
}

}  // namespace

Survey survey(const Flight& flight, const std::vector<const Track*>& seen, const SceneOptions& options) {
  const Pose2& world_from_map = flight.track.world_from_map;
  const double yaw_rad = flight.robot.origin_yaw_rad;
  const GridGeometry geometry = canvas(flight.track.world, inverse(world_from_map), yaw_rad, options);
  Eyes eyes(flight, seen, options);
  const auto result = [&](const auto& mapper, const Believed& believed) {
    return Survey{published(mapper.grid(options.probabilistic), options.size_cells, yaw_rad), world_from_map,
                  believed.distance_m(), believed.angle_rad(), believed.map_from_robot()};
  };
  if (options.mapping == "slam") {
    HectorMapper mapper(geometry);
    const Believed believed = map_by_matching(flight, eyes, mapper, options);
    return result(mapper, believed);
  }
  Mapper mapper(geometry);
  const Believed believed = map_on_given_poses(flight, eyes, mapper, options);
  return result(mapper, believed);
}

}  // namespace gridmerge::worlds
