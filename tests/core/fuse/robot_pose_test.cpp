#include "gridmerge/fuse/robot_pose.hpp"

#include <gtest/gtest.h>

namespace gridmerge {
namespace {

void expect_same(const Pose3& actual, const Pose3& expected) {
  EXPECT_NEAR(actual.x_m, expected.x_m, 1e-9);
  EXPECT_NEAR(actual.y_m, expected.y_m, 1e-9);
  EXPECT_NEAR(actual.z_m, expected.z_m, 1e-9);
  EXPECT_NEAR(actual.roll_rad, expected.roll_rad, 1e-9);
  EXPECT_NEAR(actual.pitch_rad, expected.pitch_rad, 1e-9);
  EXPECT_NEAR(wrap_angle(actual.yaw_rad - expected.yaw_rad), 0, 1e-9);
}

TEST(RobotPose, InThePlaneIsTheProductOfPoses) {
  // The map is turned by a quarter: one metre ahead in it is one metre to the left.
  const Pose2 pose = merged_from_robot(Pose2{3, 4, radians(90)}, Pose2{1, 0, radians(10)});
  EXPECT_NEAR(pose.x_m, 3, 1e-12);
  EXPECT_NEAR(pose.y_m, 5, 1e-12);
  EXPECT_NEAR(pose.theta_rad, radians(100), 1e-12);
}

TEST(RobotPose, CarriesHeightRollAndPitchThrough) {
  expect_same(merged_from_robot(Pose2{3, 4, radians(90)}, Pose3{1, 0, 2.5, 0.1, -0.2, radians(10)}),
              {3, 5, 2.5, 0.1, -0.2, radians(100)});
}

TEST(RobotPose, InSpaceIsTheCompoundingWithALevelPose) {
  const Pose2 merged_from_map{-2, 7, 2.5};
  const Pose3 robot{1.5, -0.5, 3, 0.3, 0.4, -1.2};
  expect_same(merged_from_robot(merged_from_map, robot), Pose3{-2, 7, 0, 0, 0, 2.5} * robot);
}

TEST(RobotPose, OfTheSecondRobotIsSeenFromTheFirst) {
  // The first hovers level at 2 m and looks along +y; the second is 3 m ahead of it, 1 m to its right, 0.5 m higher.
  const Pose3 relative = first_from_second({5, 5, 2, 0, 0, radians(90)}, {6, 8, 2.5, 0, 0, radians(60)});
  expect_same(relative, {3, -1, 0.5, 0, 0, radians(-30)});
}

TEST(RobotPose, OfTheSecondRobotComesBackThroughTheFirst) {
  // Eq. 3.16: L1 * (inv(L1) * p * L2) = p * L2, whatever the attitudes.
  const Pose3 first{1, 2, 3, 0.2, -0.3, 2.9};
  const Pose3 second = merged_from_robot(Pose2{-4, 0.5, -1.1}, Pose3{0.7, 0.1, 2.2, -0.25, 0.15, 3.0});
  expect_same(first * first_from_second(first, second), second);
}

TEST(RobotPose, TimesItsInverseIsTheIdentity) {
  const Pose3 pose{1, -2, 3, 0.4, 1.2, -2.8};
  expect_same(pose * inverse(pose), {});
  expect_same(inverse(pose) * pose, {});
}

TEST(RobotPose, PointingStraightUpPutsAllOfTheTurnIntoYaw) {
  expect_same(Pose3{0, 0, 0, 0, 0, 0.4} * Pose3{0, 0, 1, 0, radians(90), 0}, {0, 0, 1, 0, radians(90), 0.4});
}

}  // namespace
}  // namespace gridmerge
