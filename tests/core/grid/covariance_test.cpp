#include "gridmerge/grid/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "gridmerge/base/random.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

const PoseEstimate kFirst = {{4, -2, 0.7},
                             PoseCovariance{{4e-4, 1e-4, 5e-5}, {1e-4, 9e-4, -3e-5}, {5e-5, -3e-5, 1e-4}}};
const PoseEstimate kSecond = {{-3, 5, -2.1},
                              PoseCovariance{{1e-3, -2e-4, 1e-5}, {-2e-4, 5e-4, 4e-5}, {1e-5, 4e-5, 2e-4}}};

/// The covariance of what `function` makes of poses drawn round the mean, around what it makes of the mean.
template <typename Function>
PoseCovariance sampled_covariance(const Pose2& expected, Function&& function) {
  constexpr int kSamples = 200000;
  PoseCovariance sum = PoseCovariance::Zero();
  for (int i = 0; i < kSamples; ++i) {
    RandomStream random(7, "sample", static_cast<std::uint64_t>(i));
    const Pose2 pose = function(random);
    const Eigen::Vector3d off(pose.x_m - expected.x_m, pose.y_m - expected.y_m,
                              wrap_angle(pose.theta_rad - expected.theta_rad));
    sum += off * off.transpose();
  }
  return sum / kSamples;
}

Pose2 drawn(const PoseEstimate& estimate, RandomStream& random) {
  const Eigen::Matrix3d root = estimate.covariance->llt().matrixL();
  Eigen::Vector3d white;
  for (int i = 0; i < 3; ++i) {
    white[i] = random.normal();
  }
  const Eigen::Vector3d off = root * white;
  return {estimate.pose.x_m + off[0], estimate.pose.y_m + off[1], estimate.pose.theta_rad + off[2]};
}

/// Within 2 % of the largest entry of each block: sampling and the second order together.
void expect_close(const PoseCovariance& actual, const PoseCovariance& expected) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double scale = std::sqrt(expected(row, row) * expected(column, column));
      EXPECT_NEAR(actual(row, column), expected(row, column), 0.02 * scale) << "entry " << row << ", " << column;
    }
  }
}

TEST(PoseCovarianceOf, ComposeAgreesWithMonteCarlo) {
  const PoseEstimate result = compose(kFirst, kSecond);
  ASSERT_TRUE(result.covariance);
  EXPECT_EQ(result.pose, kFirst.pose * kSecond.pose);
  expect_close(*result.covariance, sampled_covariance(result.pose, [](RandomStream& random) {
    const Pose2 first = drawn(kFirst, random);
    return first * drawn(kSecond, random);
  }));
}

TEST(PoseCovarianceOf, InverseAgreesWithMonteCarlo) {
  const PoseEstimate result = inverse(kFirst);
  ASSERT_TRUE(result.covariance);
  EXPECT_EQ(result.pose, inverse(kFirst.pose));
  expect_close(*result.covariance,
               sampled_covariance(result.pose, [](RandomStream& random) { return inverse(drawn(kFirst, random)); }));
}

TEST(PoseCovarianceOf, InverseTwiceIsTheSame) {
  const PoseEstimate twice = inverse(inverse(kFirst));
  EXPECT_LT((*twice.covariance - *kFirst.covariance).norm(), 1e-15);
}

TEST(PoseCovarianceOf, StaysSymmetricAndPositive) {
  const PoseCovariance result = *compose(kFirst, inverse(kSecond)).covariance;
  EXPECT_LT((result - result.transpose()).norm(), 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<PoseCovariance>(result).eigenvalues().minCoeff(), 0);
}

TEST(PoseCovarianceOf, HeadingErrorPushesAFarPointSideways) {
  PoseEstimate heading_only = {{0, 0, 0}, PoseCovariance::Zero()};
  (*heading_only.covariance)(2, 2) = 1e-4;
  const PoseEstimate certain = {{10, 0, 0}, PoseCovariance::Zero()};
  const PoseCovariance result = *compose(heading_only, certain).covariance;
  EXPECT_NEAR(result(0, 0), 0, 1e-18);
  EXPECT_NEAR(result(1, 1), 100 * 1e-4, 1e-15);
  EXPECT_NEAR(result(1, 2), 10 * 1e-4, 1e-15);
}

TEST(PoseCovarianceOf, UnknownStaysUnknown) {
  const PoseEstimate unknown = {{1, 2, 3}, std::nullopt};
  EXPECT_FALSE(compose(kFirst, unknown).covariance);
  EXPECT_FALSE(compose(unknown, kFirst).covariance);
  EXPECT_FALSE(inverse(unknown).covariance);
}

}  // namespace
}  // namespace gridmerge
