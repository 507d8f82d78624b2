#include "methods/features/rigid_ransac.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gridmerge {
namespace {

/// Sine and cosine are taken once for a pose, not once for a match.
class Agreement {
 public:
  Agreement(const Pose2& pose, const RansacRules& rules)
      : pose_(pose), c_(std::cos(pose.theta_rad)), s_(std::sin(pose.theta_rad)), rules_(rules) {}

  [[nodiscard]] bool operator()(const KeypointMatch& match) const {
    const double x = c_ * match.source.x_m - s_ * match.source.y_m + pose_.x_m - match.target.x_m;
    const double y = s_ * match.source.x_m + c_ * match.source.y_m + pose_.y_m - match.target.y_m;
    return x * x + y * y <= rules_.inlier_m * rules_.inlier_m &&
           (rules_.turn_rad >= kPi || std::abs(wrap_angle(match.turn_rad - pose_.theta_rad)) <= rules_.turn_rad);
  }

 private:
  Pose2 pose_;
  double c_;
  double s_;
  const RansacRules& rules_;
};

/// The pose through two matches; none where they are too near, or no rigid pose takes the one pair to the other.
std::optional<Pose2> pose_through(const KeypointMatch& a, const KeypointMatch& b, const RansacRules& rules) {
  const double in_target = norm(b.target - a.target);
  const double in_source = norm(b.source - a.source);
  if (std::min(in_target, in_source) < rules.apart_m || std::abs(in_target - in_source) > 2 * rules.inlier_m) {
    return std::nullopt;
  }
  return rigid_fit({a, b});
}

}  // namespace

std::optional<Pose2> rigid_fit(const std::vector<KeypointMatch>& matches) {
  const auto count = static_cast<double>(matches.size());
  Point2 target;
  Point2 source;
  for (const KeypointMatch& match : matches) {
    target = target + (1 / count) * match.target;
    source = source + (1 / count) * match.source;
  }
  double dot = 0;
  double cross = 0;
  for (const KeypointMatch& match : matches) {
    const Point2 t = match.target - target;
    const Point2 s = match.source - source;
    dot += s.x_m * t.x_m + s.y_m * t.y_m;
    cross += s.x_m * t.y_m - s.y_m * t.x_m;
  }
  if (std::hypot(dot, cross) < 1e-9) {
    return std::nullopt;
  }
  const double theta = std::atan2(cross, dot);
  const Point2 turned = Pose2{0, 0, theta} * source;
  return Pose2{target.x_m - turned.x_m, target.y_m - turned.y_m, wrap_angle(theta)};
}

std::vector<KeypointMatch> inliers_of(const std::vector<KeypointMatch>& matches, const Pose2& pose,
                                      const RansacRules& rules) {
  const Agreement agrees(pose, rules);
  std::vector<KeypointMatch> inliers;
  std::copy_if(matches.begin(), matches.end(), std::back_inserter(inliers), agrees);
  return inliers;
}

std::optional<RansacPose> rigid_ransac(const std::vector<KeypointMatch>& matches, const RansacRules& rules,
                                       const std::optional<PoseWindow>& window, RandomStream& random) {
  if (matches.size() < 2) {
    return std::nullopt;
  }
  const auto count = static_cast<std::uint32_t>(matches.size());
  std::optional<Pose2> best;
  std::ptrdiff_t most = 1;
  for (int sample = 0; sample < rules.samples; ++sample) {
    const KeypointMatch& a = matches[random.below(count)];
    const KeypointMatch& b = matches[random.below(count)];
    const std::optional<Pose2> pose = pose_through(a, b, rules);
    if (!pose || !inside(*pose, window)) {
      continue;
    }
    const Agreement agrees(*pose, rules);
    if (!agrees(a) || !agrees(b)) {
      continue;
    }
    const std::ptrdiff_t inliers = std::count_if(matches.begin(), matches.end(), agrees);
    if (inliers > most) {
      most = inliers;
      best = pose;
    }
  }
  if (!best) {
    return std::nullopt;
  }
  RansacPose result{*best, inliers_of(matches, *best, rules)};
  const std::optional<Pose2> fitted = rigid_fit(result.inliers);
  if (fitted && inside(*fitted, window)) {
    const std::vector<KeypointMatch> again = inliers_of(matches, *fitted, rules);
    if (again.size() >= result.inliers.size()) {
      result = {*fitted, again};
    }
  }
  return result;
}

SequentialPoses sequential_ransac(std::vector<KeypointMatch> matches, const RansacRules& rules, int rounds,
                                  const AlignRequest& request, const RunContext& context) {
  const std::optional<PoseWindow> window = window_of(request);
  SequentialPoses result;
  double best_score = 0;
  const int planned = std::min(rounds, context.stop.iteration_budget());
  while (result.rounds < planned && !context.stop.stop_requested()) {
    RandomStream random(context.seed, "features/ransac", static_cast<std::uint64_t>(result.rounds));
    const std::optional<RansacPose> found = rigid_ransac(matches, rules, window, random);
    if (!found) {
      break;
    }
    std::erase_if(matches, Agreement(found->pose, rules));
    result.poses.push_back(*found);
    best_score = std::max(best_score, static_cast<double>(found->inliers.size()));
    if (context.trace != nullptr) {
      context.trace->on_iteration(
          {.stage = "propose/ransac",
           .iteration = result.rounds,
           .iterations = planned,
           .best_score = best_score,
           .mean_score = static_cast<double>(found->inliers.size()),
           .best_target_from_source = from_local(result.poses.front().pose, request.target, request.source),
           .population = {from_local(found->pose, request.target, request.source)}});
    }
    ++result.rounds;
  }
  return result;
}

}  // namespace gridmerge
