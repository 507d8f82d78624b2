#pragma once
/// A lidar that turns in a plane: level, or tilted with the robot that carries it.
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "worlds/route.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

struct LidarModel {
  double range_m = 12;                 ///< what lies farther away is not seen
  double step_rad = radians(0.5);      ///< between two beams
  double noise_m = 0.012;              ///< standard deviation of a range
  double dropout = 0.01;               ///< share of the beams that are lost
  double field_of_view_rad = 2 * kPi;  ///< half of it to either side of the x axis
  double noise_share = 0;              ///< standard deviation as a share of the range, where that is more
  double nearest_m = 0;                ///< what lies nearer is not seen
};

/// The lidars one can buy that `lidar_model` knows.
[[nodiscard]] std::vector<std::string> lidar_names();

/// As the makers' data sheets have them. A bound of the error is taken as two standard deviations. The share of lost
/// beams is in no sheet, and is ours; so is the error of the RPLIDAR A3, which is that of its family (A1, A2).
///
///   name           | range       | step         | sees    | error of a range        | maker and model
///   rplidar_a3     | 0.2..25 m   | 0.225 deg    | 360 deg | within 1 %              | Slamtec A3M1, 16 kHz, 10 Hz
///   hokuyo_utm30lx | 0.1..30 m   | 0.25 deg     | 270 deg | deviation 10 mm, 0.1 %  | Hokuyo UTM-30LX
///   hokuyo_urg04lx | 0.06..5.6 m | 360/1024 deg | 240 deg | within 10 mm, 1 %       | Hokuyo URG-04LX, rated to 4 m
///
/// @throws std::invalid_argument for an unknown name, with the known ones
[[nodiscard]] LidarModel lidar_model(std::string_view name);

/// How the lidar is held. Walls and discs stand 3 m high on flat ground; a beam that passes above them meets nothing.
struct Attitude {
  double roll_rad = 0;   ///< > 0: its left side is up; within a quarter turn
  double pitch_rad = 0;  ///< > 0: its nose is down; within a quarter turn
  double height_m = 1;   ///< above the ground, > 0
  bool levelled = true;  ///< hits are projected onto the plane by the true attitude; otherwise taken as if level
};

/// One turn of the lidar, from one spot. Const: a scan draws its chance from the stream it is given.
class Lidar {
 public:
  explicit Lidar(const LidarModel& model);

  /// The points hit, in the lidar's frame, in order of their beams. A beam that hits nothing within range leaves none.
  /// Only what lies in `sight` is seen. The ground that a tilted lidar meets looks like a wall.
  /// @param others  in the world frame, beside what stands in the world for good: other robots
  [[nodiscard]] std::vector<Point2> scan(const World& world, const Share& sight, const Pose2& world_from_lidar,
                                         RandomStream& random, const Attitude& attitude = {},
                                         const std::vector<Disc>& others = {}) const;

 private:
  [[nodiscard]] bool has(std::size_t beam) const;

  LidarModel model_;
  std::vector<Point2> beams_;  // unit vectors all round, counter-clockwise from the x axis
  int widest_ = 0;             // the beam farthest to either side, counted from the x axis
};

}  // namespace gridmerge::worlds
