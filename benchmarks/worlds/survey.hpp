#pragma once
/// From a robot's flight to the map it brings home.
#include <vector>

#include "worlds/flight.hpp"

namespace gridmerge::worlds {

struct Survey {
  OccupancyGrid map;
  Pose2 world_from_map;
  double pose_error_m = 0;    ///< root mean square along the way: where the robot took itself to be, off the truth
  double pose_error_rad = 0;  ///< the same for the heading
  std::vector<Pose2> map_from_robot;  ///< where it took itself to be, for each pose of the flight
};

/// Scans from every pose of the flight and maps as the options say.
/// @param seen  flights of other robots, which set out together with this one and stay where they arrive
[[nodiscard]] Survey survey(const Flight& flight, const std::vector<const Track*>& seen, const SceneOptions& options);

}  // namespace gridmerge::worlds
