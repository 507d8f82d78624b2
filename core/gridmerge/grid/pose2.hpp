#pragma once
/// SE(2): points, poses, the compounding operation and its inverse (seed Eq. 3.1-3.4).
///
/// A pose is named for what it does: `target_from_source` takes a point given in the source frame to the target frame,
/// so that products cancel: `a_from_c = a_from_b * b_from_c`. Lengths are metres, angles radians, counter-clockwise.
#include <cmath>
#include <numbers>

namespace gridmerge {

/// A point or a vector in some metric frame [m].
struct Point2 {
  double x_m = 0;
  double y_m = 0;

  friend constexpr bool operator==(const Point2&, const Point2&) = default;
  friend constexpr Point2 operator+(Point2 a, Point2 b) { return {a.x_m + b.x_m, a.y_m + b.y_m}; }
  friend constexpr Point2 operator-(Point2 a, Point2 b) { return {a.x_m - b.x_m, a.y_m - b.y_m}; }
  friend constexpr Point2 operator*(double s, Point2 a) { return {s * a.x_m, s * a.y_m}; }
};

[[nodiscard]] inline double norm(Point2 v) { return std::hypot(v.x_m, v.y_m); }

inline constexpr double kPi = std::numbers::pi;
[[nodiscard]] constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The same direction, in (-pi, pi].
[[nodiscard]] inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// A rigid transform in the plane, (x, y, theta).
struct Pose2 {
  double x_m = 0;
  double y_m = 0;
  double theta_rad = 0;

  friend constexpr bool operator==(const Pose2&, const Pose2&) = default;
  [[nodiscard]] constexpr Point2 translation() const { return {x_m, y_m}; }
};

/// Eq. 3.1: compounding of two poses; the angle of the result lies in (-pi, pi].
[[nodiscard]] inline Pose2 operator*(const Pose2& a_from_b, const Pose2& b_from_c) {
  const double c = std::cos(a_from_b.theta_rad);
  const double s = std::sin(a_from_b.theta_rad);
  return {c * b_from_c.x_m - s * b_from_c.y_m + a_from_b.x_m, s * b_from_c.x_m + c * b_from_c.y_m + a_from_b.y_m,
          wrap_angle(a_from_b.theta_rad + b_from_c.theta_rad)};
}

/// Eq. 3.2: compounding of a pose and a point.
[[nodiscard]] inline Point2 operator*(const Pose2& a_from_b, Point2 in_b) {
  const double c = std::cos(a_from_b.theta_rad);
  const double s = std::sin(a_from_b.theta_rad);
  return {c * in_b.x_m - s * in_b.y_m + a_from_b.x_m, s * in_b.x_m + c * in_b.y_m + a_from_b.y_m};
}

/// Eq. 3.3: `inverse(p) * p` is the identity.
[[nodiscard]] inline Pose2 inverse(const Pose2& a_from_b) {
  const double c = std::cos(a_from_b.theta_rad);
  const double s = std::sin(a_from_b.theta_rad);
  return {-c * a_from_b.x_m - s * a_from_b.y_m, s * a_from_b.x_m - c * a_from_b.y_m, wrap_angle(-a_from_b.theta_rad)};
}

/// How far two poses put one point apart, and how far they turn apart.
struct PoseDifference {
  double distance_m = 0;
  double angle_rad = 0;  ///< >= 0
};

/// Compares two poses where it matters: at `at`, a point of the source frame (usually the centre of its known cells).
[[nodiscard]] inline PoseDifference difference_at(Point2 at, const Pose2& first, const Pose2& second) {
  return {norm(first * at - second * at), std::abs(wrap_angle(first.theta_rad - second.theta_rad))};
}

}  // namespace gridmerge
