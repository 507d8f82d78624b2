#include "support/flat_pair.hpp"

namespace gridmerge {
namespace {

constexpr double kResolutionM = 0.08;

worlds::MapPair coarse_flat(int seed) {
  worlds::SceneOptions options = known_pair("flat", seed);
  options.resolution_m = kResolutionM;
  return worlds::make_scene(options);
}

}  // namespace

FlatPair::FlatPair(int seed)
    : pair(coarse_flat(seed)), target(pair.target, kResolutionM), source(pair.source, kResolutionM) {}

Pose2 FlatPair::truth_off_by(double x_m, double y_m, double turn_deg) const {
  const Point2 at = pair.target_from_source * source.centre_in_map();
  return Pose2{at.x_m + x_m, at.y_m + y_m, 0} * Pose2{0, 0, radians(turn_deg)} * Pose2{-at.x_m, -at.y_m, 0} *
         pair.target_from_source;
}

bool FlatPair::right(const Pose2& target_from_source, double distance_m, double angle_deg) const {
  const PoseDifference error = pose_error(pair, target_from_source);
  return error.distance_m < distance_m && degrees(error.angle_rad) < angle_deg;
}

bool FlatPair::found_by(const Proposal& proposal, double distance_m, double angle_deg) const {
  return !proposal.candidates.empty() && right(proposal.candidates.front().target_from_source, distance_m, angle_deg);
}

const FlatPair& flat() {
  static const FlatPair flat;
  return flat;
}

}  // namespace gridmerge
