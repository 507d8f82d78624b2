#pragma once
/// One robot's part in a scene: its world, its share of it, its way.
#include <string>

#include "worlds/ground.hpp"
#include "worlds/scene.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::worlds {

struct Robot {
  std::string name;  // of its random streams
  Share share;       // of the world: what it visits
  Share sight;       // where it may go, and what it can see, at all
  double heading_rad = 0;
  double origin_yaw_rad = 0;
};

struct Flight {
  Robot robot;
  Track track;
};

enum class Role { kTarget, kSource };

/// By the shares of the options, whatever wanted_overlap says. One robot's flight does not depend on the other's share.
/// @param flown  how much of its way the robot goes before it stops, 0..1
[[nodiscard]] Flight flight_of(const SceneOptions& options, Role role, double flown = 1);

/// Where a robot scans along its way, turned to where it goes; to begin with, as it is told.
[[nodiscard]] std::vector<Pose2> poses_along(const std::vector<Point2>& way, double heading_rad,
                                             const SceneOptions& options);

}  // namespace gridmerge::worlds
