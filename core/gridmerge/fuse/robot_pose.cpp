#include "gridmerge/fuse/robot_pose.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace gridmerge {
namespace {

Eigen::Isometry3d to_transform(const Pose3& pose) {
  return Eigen::Translation3d(pose.x_m, pose.y_m, pose.z_m) *
         Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pose.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitX());
}

Pose3 to_pose(const Eigen::Isometry3d& transform) {
  constexpr double kUpright = 1e-9;  // cosine of a pitch at which roll and yaw turn about one axis
  const Eigen::Matrix3d turn = transform.linear();
  const Eigen::Vector3d shift = transform.translation();
  const double cos_pitch = std::hypot(turn(0, 0), turn(1, 0));
  const double pitch = std::atan2(-turn(2, 0), cos_pitch);
  if (cos_pitch < kUpright) {
    return {shift.x(), shift.y(), shift.z(), 0, pitch, std::atan2(-turn(0, 1), turn(1, 1))};
  }
  return {
      shift.x(), shift.y(), shift.z(), std::atan2(turn(2, 1), turn(2, 2)), pitch, std::atan2(turn(1, 0), turn(0, 0))};
}

}  // namespace

Pose3 operator*(const Pose3& a_from_b, const Pose3& b_from_c) {
  return to_pose(to_transform(a_from_b) * to_transform(b_from_c));
}

Pose3 inverse(const Pose3& a_from_b) { return to_pose(to_transform(a_from_b).inverse()); }

Pose3 merged_from_robot(const Pose2& merged_from_map, const Pose3& map_from_robot) {
  const Pose2 planar = merged_from_map * Pose2{map_from_robot.x_m, map_from_robot.y_m, map_from_robot.yaw_rad};
  return {planar.x_m,      planar.y_m, map_from_robot.z_m, map_from_robot.roll_rad, map_from_robot.pitch_rad,
          planar.theta_rad};
}

Pose3 first_from_second(const Pose3& merged_from_first, const Pose3& merged_from_second) {
  return inverse(merged_from_first) * merged_from_second;
}

}  // namespace gridmerge
