#pragma once
/// Where the robots are in the merged map (seed Eq. 3.15-3.17).
#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// A rigid transform in space: first roll about x, then pitch about y, then yaw about z, then the shift.
struct Pose3 {
  double x_m = 0;
  double y_m = 0;
  double z_m = 0;
  double roll_rad = 0;
  double pitch_rad = 0;  ///< [-pi/2, pi/2]
  double yaw_rad = 0;
};

/// Eq. 3.1 in space. Roll and yaw of the result lie in (-pi, pi]; at a pitch of +-pi/2, where only their sum is
/// determined, all of it is yaw.
[[nodiscard]] Pose3 operator*(const Pose3& a_from_b, const Pose3& b_from_c);
[[nodiscard]] Pose3 inverse(const Pose3& a_from_b);

/// Eq. 3.17 for a robot in the plane.
[[nodiscard]] inline Pose2 merged_from_robot(const Pose2& merged_from_map, const Pose2& map_from_robot) {
  return merged_from_map * map_from_robot;
}

/// Eq. 3.17: the robot's x, y and yaw are taken to the merged map; z, roll and pitch stay as they are. So z must be a
/// height above a ground that the robots share, not above each robot's own start.
[[nodiscard]] Pose3 merged_from_robot(const Pose2& merged_from_map, const Pose3& map_from_robot);

/// Eq. 3.15: the second robot's pose in the first one's body frame, from both poses in one map.
[[nodiscard]] Pose3 first_from_second(const Pose3& merged_from_first, const Pose3& merged_from_second);

}  // namespace gridmerge
