#include "study/window.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/base/random.hpp"

namespace gridmerge::study {
namespace {

/// The pose of that heading that lays the source's centre on that point.
Pose2 pose_at(Point2 at, double heading_rad, Point2 source_centre) {
  const Pose2 turned{0, 0, wrap_angle(heading_rad)};
  const Point2 shift = at - turned * source_centre;
  return {shift.x_m, shift.y_m, turned.theta_rad};
}

Pose2 near_truth(const DrawnPair& pair, double radius_m, double angle_rad, RandomStream random) {
  const Point2 centre = pair.centre_in_map[1];
  if (pair.truth != "same") {
    return pose_at(pair.centre_in_map[0], random.uniform(-kPi, kPi), centre);
  }
  const Pose2& truth = pair.first_from_map[1];
  const double turn_rad = random.uniform(-angle_rad, angle_rad);
  const double way_rad = random.uniform(-kPi, kPi);
  const double far_m = radius_m * std::sqrt(random.uniform());  // any place in the circle is as likely
  const Point2 off = {far_m * std::cos(way_rad), far_m * std::sin(way_rad)};
  return pose_at(truth * centre + off, truth.theta_rad + turn_rad, centre);
}

/// Where HectorSLAM has the robot start: the centre of the middle cell, looking along the grid's x axis.
Pose2 map_from_middle(const GridGeometry& geometry) {
  return geometry.map_from_grid * Pose2{(geometry.width / 2 + 0.5) * geometry.resolution_m,
                                        (geometry.height / 2 + 0.5) * geometry.resolution_m, 0};
}

}  // namespace

std::optional<PosePrior> prior_of(const WindowChoice& window, const PairChoice& choice, const DrawnPair& pair,
                                  std::uint64_t seed) {
  if (window.around == WindowChoice::Around::kAnywhere) {
    return std::nullopt;
  }
  const GridGeometry& target = pair.maps[0].geometry;
  const double half_side_m = 0.5 * std::max(target.width, target.height) * target.resolution_m;
  PosePrior prior;
  prior.radius_m = window.share > 0 ? window.share * half_side_m : window.radius_m;
  prior.angle_rad =
      radians(window.share > 0 ? std::min(180.0, std::max(180 * window.share, window.least_deg)) : window.angle_deg);
  if (window.around == WindowChoice::Around::kMiddle) {
    prior.target_from_source = map_from_middle(target) * inverse(map_from_middle(pair.maps[1].geometry));
  } else if (window.around == WindowChoice::Around::kTruth) {
    const RandomStream random(seed, "study/start/" + choice.set + "/" + choice.name + "/" + window.name);
    prior.target_from_source = near_truth(pair, *prior.radius_m, *prior.angle_rad, random);
  }
  return prior;
}

}  // namespace gridmerge::study
