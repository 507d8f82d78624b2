#include "worlds/point_fit.hpp"

#include <cmath>

namespace gridmerge {
namespace {

PointMatch centres_of(const std::vector<PointMatch>& matches) {
  PointMatch sum;
  for (const PointMatch& match : matches) {
    sum.in_target = sum.in_target + match.in_target;
    sum.in_source = sum.in_source + match.in_source;
  }
  const double share = 1.0 / static_cast<double>(matches.size());
  return {.in_target = share * sum.in_target, .in_source = share * sum.in_source};
}

double dot(Point2 a, Point2 b) { return a.x_m * b.x_m + a.y_m * b.y_m; }
double cross(Point2 a, Point2 b) { return a.x_m * b.y_m - a.y_m * b.x_m; }

}  // namespace

PointFit fit_points(const std::vector<PointMatch>& matches) {
  const PointMatch centre = centres_of(matches);
  double along = 0;
  double across = 0;
  for (const PointMatch& match : matches) {
    const Point2 target = match.in_target - centre.in_target;
    const Point2 source = match.in_source - centre.in_source;
    along += dot(source, target);
    across += cross(source, target);
  }
  const Pose2 turn = {0, 0, std::atan2(across, along)};
  const Point2 shift = centre.in_target - turn * centre.in_source;
  PointFit fit = {.target_from_source = {shift.x_m, shift.y_m, turn.theta_rad}};
  double squares = 0;
  for (const PointMatch& match : matches) {
    const Point2 left = fit.target_from_source * match.in_source - match.in_target;
    squares += dot(left, left);
  }
  fit.residual_m = std::sqrt(squares / static_cast<double>(matches.size()));
  return fit;
}

double scale_between(const std::vector<PointMatch>& matches) {
  const PointMatch centre = centres_of(matches);
  double target_spread = 0;
  double source_spread = 0;
  for (const PointMatch& match : matches) {
    const Point2 target = match.in_target - centre.in_target;
    const Point2 source = match.in_source - centre.in_source;
    target_spread += dot(target, target);
    source_spread += dot(source, source);
  }
  return std::sqrt(target_spread / source_spread);
}

}  // namespace gridmerge
