#include "gridmerge/grid/pose2.hpp"

#include <gtest/gtest.h>

#include "gridmerge/base/random.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

Pose2 random_pose(RandomStream& random) {
  Pose2 pose;
  pose.x_m = random.uniform(-50, 50);
  pose.y_m = random.uniform(-50, 50);
  pose.theta_rad = random.uniform(-kPi, kPi);
  return pose;
}

void expect_near(const Pose2& actual, const Pose2& expected) {
  EXPECT_NEAR(actual.x_m, expected.x_m, 1e-9);
  EXPECT_NEAR(actual.y_m, expected.y_m, 1e-9);
  EXPECT_NEAR(wrap_angle(actual.theta_rad - expected.theta_rad), 0, 1e-12);
}

void expect_near(Point2 actual, Point2 expected) {
  EXPECT_NEAR(actual.x_m, expected.x_m, 1e-9);
  EXPECT_NEAR(actual.y_m, expected.y_m, 1e-9);
}

TEST(WrapAngle, LiesInTheHalfOpenTurn) {
  EXPECT_EQ(wrap_angle(0), 0);
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3 * kPi / 2), -kPi / 2, 1e-15);
  EXPECT_NEAR(wrap_angle(-7 * kPi / 2), kPi / 2, 1e-14);
  RandomStream random(1, "wrap");
  for (int i = 0; i < 1000; ++i) {
    const double angle_rad = random.uniform(-100, 100);
    const double wrapped_rad = wrap_angle(angle_rad);
    ASSERT_GT(wrapped_rad, -kPi);
    ASSERT_LE(wrapped_rad, kPi);
    ASSERT_NEAR(std::cos(wrapped_rad), std::cos(angle_rad), 1e-12);
    ASSERT_NEAR(std::sin(wrapped_rad), std::sin(angle_rad), 1e-12);
  }
}

TEST(Angles, ConvertBetweenDegreesAndRadians) {
  EXPECT_DOUBLE_EQ(radians(180), kPi);
  EXPECT_DOUBLE_EQ(degrees(kPi / 2), 90);
}

TEST(Pose2, ComposesAsInEquation31) {
  // A quarter turn at (1, 2), then 3 ahead and 4 to the left.
  expect_near(Pose2{1, 2, kPi / 2} * Pose2{3, 4, kPi / 4}, {1 - 4, 2 + 3, 3 * kPi / 4});
}

TEST(Pose2, MovesAPointAsInEquation32) { expect_near(Pose2{1, 2, kPi / 2} * Point2{3, 4}, {-3, 5}); }

TEST(Pose2, InverseUndoesAPoseFromBothSides) {
  RandomStream random(1, "inverse");
  for (int i = 0; i < 100; ++i) {
    const Pose2 pose = random_pose(random);
    expect_near(inverse(pose) * pose, {});
    expect_near(pose * inverse(pose), {});
    expect_near(inverse(inverse(pose)), pose);
  }
}

TEST(Pose2, InverseOfAProductIsTheProductOfInversesTurnedRound) {
  RandomStream random(2, "inverse");
  for (int i = 0; i < 100; ++i) {
    const Pose2 a_from_b = random_pose(random);
    const Pose2 b_from_c = random_pose(random);
    expect_near(inverse(a_from_b * b_from_c), inverse(b_from_c) * inverse(a_from_b));
  }
}

TEST(Pose2, CompositionIsAssociative) {
  RandomStream random(3, "associative");
  for (int i = 0; i < 100; ++i) {
    const Pose2 a = random_pose(random);
    const Pose2 b = random_pose(random);
    const Pose2 c = random_pose(random);
    expect_near((a * b) * c, a * (b * c));
  }
}

TEST(Pose2, CompositionAgreesWithMovingPoints) {
  RandomStream random(4, "points");
  for (int i = 0; i < 100; ++i) {
    const Pose2 a_from_b = random_pose(random);
    const Pose2 b_from_c = random_pose(random);
    const Point2 in_c = random_pose(random).translation();
    expect_near((a_from_b * b_from_c) * in_c, a_from_b * (b_from_c * in_c));
  }
}

TEST(Pose2, AngleOfAProductIsWrapped) {
  const Pose2 turned = Pose2{0, 0, 3} * Pose2{0, 0, 3};
  EXPECT_NEAR(turned.theta_rad, 6 - 2 * kPi, 1e-15);
  EXPECT_EQ(inverse(Pose2{0, 0, kPi}).theta_rad, kPi);
}

TEST(Pose2, KeepsDistances) {
  const Pose2 pose = {3, -4, 1.2};
  EXPECT_NEAR(norm(pose * Point2{1, 2} - pose * Point2{4, 6}), 5, 1e-12);
}

TEST(DifferenceAt, IsMeasuredAtThePointGiven) {
  const Pose2 first = {};
  const Pose2 second = {0, 0, kPi / 2};
  EXPECT_NEAR(difference_at({0, 0}, first, second).distance_m, 0, 1e-15);
  EXPECT_NEAR(difference_at({10, 0}, first, second).distance_m, 10 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(difference_at({10, 0}, first, second).angle_rad, kPi / 2, 1e-15);
}

TEST(DifferenceAt, TakesTheShortWayRound) {
  EXPECT_NEAR(difference_at({}, {0, 0, radians(179)}, {0, 0, radians(-179)}).angle_rad, radians(2), 1e-12);
}

}  // namespace
}  // namespace gridmerge
