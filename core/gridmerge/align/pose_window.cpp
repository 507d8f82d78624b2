#include "gridmerge/align/pose_window.hpp"

#include <cmath>

namespace gridmerge {

std::optional<PoseWindow> window_of(const AlignRequest& request) {
  if (!request.prior || (!request.prior->radius_m && !request.prior->angle_rad)) {
    return std::nullopt;
  }
  const double anywhere = request.target.radius_m() + request.source.radius_m();
  return PoseWindow{.centre = to_local(request.prior->target_from_source, request.target, request.source),
                    .radius_m = request.prior->radius_m.value_or(anywhere),
                    .angle_rad = request.prior->angle_rad.value_or(kPi)};
}

bool inside(const Pose2& local_target_from_source, const std::optional<PoseWindow>& window) {
  return !window ||
         (norm(local_target_from_source.translation() - window->centre.translation()) <= window->radius_m &&
          std::abs(wrap_angle(local_target_from_source.theta_rad - window->centre.theta_rad)) <= window->angle_rad);
}

Pose2 uniform_pose(const AlignRequest& request, const std::optional<PoseWindow>& window, RandomStream& random) {
  const PoseWindow all{
      .centre = {}, .radius_m = request.target.radius_m() + request.source.radius_m(), .angle_rad = kPi};
  const PoseWindow& w = window ? *window : all;
  const double way = random.uniform(-kPi, kPi);
  const double far = w.radius_m * std::sqrt(random.uniform());
  return {w.centre.x_m + far * std::cos(way), w.centre.y_m + far * std::sin(way),
          wrap_angle(w.centre.theta_rad + random.uniform(-w.angle_rad, w.angle_rad))};
}

}  // namespace gridmerge
