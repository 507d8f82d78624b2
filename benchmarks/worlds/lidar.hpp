#pragma once
/// A lidar that turns in a plane and sees all round.
#include <vector>

#include "gridmerge/base/random.hpp"
#include "worlds/route.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

struct LidarModel {
  double range_m = 12;             ///< what lies farther away is not seen
  double step_rad = radians(0.5);  ///< between two beams
  double noise_m = 0.012;          ///< standard deviation of a range
  double dropout = 0.01;           ///< share of the beams that are lost
};

/// One turn of the lidar, from one spot. Const: a scan draws its chance from the stream it is given.
class Lidar {
 public:
  explicit Lidar(const LidarModel& model);

  /// The points hit, in the lidar's frame, in order of their beams. A beam that hits nothing within range leaves none.
  /// Only what lies in `sight` is seen.
  [[nodiscard]] std::vector<Point2> scan(const World& world, const Share& sight, const Pose2& world_from_lidar,
                                         RandomStream& random) const;

 private:
  LidarModel model_;
  std::vector<Point2> beams_;  // unit vectors, counter-clockwise from the x axis
};

}  // namespace gridmerge::worlds
