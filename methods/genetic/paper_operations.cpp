#include "methods/genetic/paper_operations.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gridmerge::paper {

Pose2 initial_pose(const Pose2& target_local, const Pose2& target_global, const Pose2& source_local,
                   const Pose2& source_global) {
  return target_local * inverse(target_global) * source_global * inverse(source_local);
}

Pose2 random_pose(const Window& window, RandomStream& stream) {
  const double radius_m = window.radius_m * std::sqrt(stream.uniform());  // uniform over the disc's area
  const double direction_rad = stream.uniform(-kPi, kPi);
  const Point2 error{radius_m * std::cos(direction_rad), radius_m * std::sin(direction_rad)};
  const double theta_rad = window.start.theta_rad + stream.uniform(-window.angle_rad, window.angle_rad);
  const Point2 turned_pivot = Pose2{0, 0, theta_rad} * window.pivot;
  const Point2 position = window.start * window.pivot + error - turned_pivot;
  return {position.x_m, position.y_m, wrap_angle(theta_rad)};
}

Pose2 mutation(const Pose2& pose, const MutationSpread& spread, RandomStream& stream) {
  const double dx_m = spread.position_m * stream.normal();
  const double dy_m = spread.position_m * stream.normal();
  const double turn_rad = spread.angle_rad * stream.normal();
  return {pose.x_m + dx_m, pose.y_m + dy_m, wrap_angle(pose.theta_rad + turn_rad)};
}

Pose2 crossover_1(const Pose2& first, const Pose2& second) { return {first.x_m, first.y_m, second.theta_rad}; }

Pose2 crossover_2(const Pose2& first, const Pose2& second, double lambda) {
  const double arc_rad = wrap_angle(first.theta_rad - second.theta_rad);
  return {lambda * first.x_m + (1 - lambda) * second.x_m, lambda * first.y_m + (1 - lambda) * second.y_m,
          wrap_angle(second.theta_rad + lambda * arc_rad)};
}

std::size_t superior_count(std::span<const Individual> best_first) {
  // F >= sum / n, multiplied by n: in integers, so that equal individuals are all superior.
  const auto n = static_cast<std::int64_t>(best_first.size());
  const auto sum = std::accumulate(best_first.begin(), best_first.end(), std::int64_t{0},
                                   [](std::int64_t total, const Individual& k) { return total + k.fitness; });
  const auto inferior = std::partition_point(best_first.begin(), best_first.end(),
                                             [&](const Individual& k) { return k.fitness * n >= sum; });
  return static_cast<std::size_t>(inferior - best_first.begin());
}

int mutation_attempts(std::int64_t fitness, std::int64_t worst, std::int64_t best, int most) {
  if (best == worst) {
    return most;
  }
  const double rank = static_cast<double>(fitness - worst) / static_cast<double>(best - worst);
  return std::max(static_cast<int>(std::floor(most * std::pow(rank, 10))), 1);
}

}  // namespace gridmerge::paper
