#include "gridmerge/grid/covariance.hpp"

namespace gridmerge {

PoseEstimate compose(const PoseEstimate& a_from_b, const PoseEstimate& b_from_c) {
  PoseEstimate a_from_c{a_from_b.pose * b_from_c.pose, std::nullopt};
  if (!a_from_b.covariance || !b_from_c.covariance) {
    return a_from_c;
  }
  const double c = std::cos(a_from_b.pose.theta_rad);
  const double s = std::sin(a_from_b.pose.theta_rad);
  const Point2 in_b = b_from_c.pose.translation();
  Eigen::Matrix3d by_first = Eigen::Matrix3d::Identity();
  by_first(0, 2) = -s * in_b.x_m - c * in_b.y_m;
  by_first(1, 2) = c * in_b.x_m - s * in_b.y_m;
  Eigen::Matrix3d by_second = Eigen::Matrix3d::Identity();
  by_second.topLeftCorner<2, 2>() << c, -s, s, c;
  a_from_c.covariance =
      by_first * *a_from_b.covariance * by_first.transpose() + by_second * *b_from_c.covariance * by_second.transpose();
  return a_from_c;
}

PoseEstimate inverse(const PoseEstimate& a_from_b) {
  PoseEstimate b_from_a{inverse(a_from_b.pose), std::nullopt};
  if (!a_from_b.covariance) {
    return b_from_a;
  }
  const double c = std::cos(a_from_b.pose.theta_rad);
  const double s = std::sin(a_from_b.pose.theta_rad);
  Eigen::Matrix3d jacobian;
  jacobian << -c, -s, b_from_a.pose.y_m,  //
      s, -c, -b_from_a.pose.x_m,          //
      0, 0, -1;
  b_from_a.covariance = jacobian * *a_from_b.covariance * jacobian.transpose();
  return b_from_a;
}

}  // namespace gridmerge
