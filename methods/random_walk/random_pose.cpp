#include "methods/random_walk/random_pose.hpp"

#include <cmath>

namespace gridmerge {
namespace {

const WallPoint& any_of(const std::vector<WallPoint>& walls, RandomStream& random) {
  return walls[random.below(static_cast<std::uint32_t>(walls.size()))];
}

/// A wall point whose side is known; none where a few draws find none.
const WallPoint* sided_wall(const std::vector<WallPoint>& walls, RandomStream& random) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    const WallPoint& wall = any_of(walls, random);
    if (wall.free_normal.x_m != 0 || wall.free_normal.y_m != 0) {
      return &wall;
    }
  }
  return nullptr;
}

double direction_of(Point2f v) { return std::atan2(static_cast<double>(v.y_m), static_cast<double>(v.x_m)); }

/// The source turned, and moved so that its point comes to lie on the target's.
Pose2 laid_on(Point2f target, Point2f source, double turn) {
  const Point2 turned = Pose2{0, 0, turn} * Point2{static_cast<double>(source.x_m), static_cast<double>(source.y_m)};
  return {static_cast<double>(target.x_m) - turned.x_m, static_cast<double>(target.y_m) - turned.y_m, turn};
}

}  // namespace

std::optional<Pose2> wall_on_wall_pose(const AlignRequest& request, RandomStream& random) {
  constexpr double kTurnSigma = radians(4);
  const WallPoint* on = sided_wall(request.target.walls(), random);
  const WallPoint* wall = sided_wall(request.source.walls(), random);
  if (on == nullptr || wall == nullptr) {
    return std::nullopt;
  }
  const double turn = direction_of(on->free_normal) - direction_of(wall->free_normal) + kTurnSigma * random.normal();
  return laid_on(on->at, wall->at, wrap_angle(turn));
}

Pose2 point_on_point_pose(const AlignRequest& request, RandomStream& random) {
  const Point2f on = any_of(request.target.walls(), random).at;
  const Point2f point = any_of(request.source.walls(), random).at;
  return laid_on(on, point, wrap_angle(random.uniform(-kPi, kPi)));
}

std::vector<Pose2> start_poses(const AlignRequest& request, const std::optional<PoseWindow>& window, std::size_t count,
                               RandomStream& random) {
  const std::size_t unguided = window ? count / 2 : count / 4;
  std::vector<Pose2> poses;
  for (std::size_t attempt = 0; attempt < 8 * count && poses.size() < count - unguided; ++attempt) {
    if (const std::optional<Pose2> pose = wall_on_wall_pose(request, random); pose && inside(*pose, window)) {
      poses.push_back(*pose);
    }
  }
  for (std::size_t i = 0; i < unguided; ++i) {
    const Pose2 pose = window ? uniform_pose(request, window, random) : point_on_point_pose(request, random);
    if (inside(pose, window)) {  // but for rounding at its rim
      poses.push_back(pose);
    }
  }
  return poses;
}

}  // namespace gridmerge
