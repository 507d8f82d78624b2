#include "gridmerge/align/refine.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gridmerge/grid/wall_sides.hpp"

namespace gridmerge {
namespace {

struct FieldSample {
  double distance_m;
  double slope_x;  ///< per metre, local frame of the field
  double slope_y;
};

/// The distance to the nearest wall, bilinear between cell centres; `reach_m` and flat outside.
FieldSample sample(const MapLevel& level, double x_m, double y_m, double reach_m) {
  const double u = (x_m - level.lower_left.x_m) / level.resolution_m - 0.5;
  const double v = (y_m - level.lower_left.y_m) / level.resolution_m - 0.5;
  const int column = static_cast<int>(std::floor(u));
  const int row = static_cast<int>(std::floor(v));
  if (column < 0 || row < 0 || column + 1 >= level.width || row + 1 >= level.height) {
    return {reach_m, 0, 0};
  }
  const double a = u - column;
  const double b = v - row;
  const float* low = &level.wall_distance_m[level.offset(column, row)];
  const float* high = low + level.width;
  const double d = (1 - b) * ((1 - a) * low[0] + a * low[1]) + b * ((1 - a) * high[0] + a * high[1]);
  if (d >= reach_m) {
    return {reach_m, 0, 0};
  }
  const double du = (1 - b) * (low[1] - low[0]) + b * (high[1] - high[0]);
  const double dv = (1 - a) * (high[0] - low[0]) + a * (high[1] - low[1]);
  return {d, du / level.resolution_m, dv / level.resolution_m};
}

struct SurfacePoint {
  double x_m;
  double y_m;
  Eigen::Vector2d normal;  ///< unit; zero where the surface has no clear side
};

/// Walls within this distance decide whether a point was seen from the same side [m].
constexpr double kSideReach = 0.25;

/// At most `max_points` of the moving map's walls, evenly taken, without those that lie on the other face of a wall.
std::vector<SurfacePoint> same_side_walls(const PreparedMap& moving, const PreparedMap& fixed,
                                          const std::vector<std::uint8_t>& fixed_sides, const Pose2& fixed_from_moving,
                                          int max_points) {
  const MapLevel& level = fixed.level(0);
  const auto limit = static_cast<std::size_t>(max_points);
  const std::size_t step = std::max<std::size_t>(1, (moving.walls().size() + limit - 1) / limit);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < moving.walls().size(); i += step) {
    const WallPoint& wall = moving.walls()[i];
    const Point2 at = fixed_from_moving * Point2{wall.at.x_m, wall.at.y_m};
    const double column = std::floor((at.x_m - level.lower_left.x_m) / level.resolution_m);
    const double row = std::floor((at.y_m - level.lower_left.y_m) / level.resolution_m);
    if (column >= 0 && row >= 0 && column < level.width && row < level.height) {
      const std::uint8_t sides = fixed_sides[level.offset(static_cast<int>(column), static_cast<int>(row))];
      const WallSide side(wall);
      if (side.known && sides != 0 && ((sides >> side.octant_after(fixed_from_moving.theta_rad)) & 1) == 0) {
        continue;
      }
    }
    points.push_back({wall.at.x_m, wall.at.y_m, {wall.surface_normal.x_m, wall.surface_normal.y_m}});
  }
  return points;
}

/// Residuals of all points of both maps as a function of the local pose (x, y, theta).
class WallDistances final : public ceres::CostFunction {
 public:
  WallDistances(const MapLevel& target, const MapLevel& source, std::vector<SurfacePoint> target_points,
                std::vector<SurfacePoint> source_points, const RefineOptions& options)
      : target_(target),
        source_(source),
        options_(options),
        target_points_(std::move(target_points)),
        source_points_(std::move(source_points)) {
    set_num_residuals(static_cast<int>(target_points_.size() + source_points_.size()));
    mutable_parameter_block_sizes()->push_back(3);
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const double* p = parameters[0];
    const double c = std::cos(p[2]);
    const double s = std::sin(p[2]);
    double* jacobian = jacobians != nullptr ? jacobians[0] : nullptr;
    for (const SurfacePoint& q : source_points_) {
      const double rx = c * q.x_m - s * q.y_m;
      const double ry = s * q.x_m + c * q.y_m;
      const FieldSample f = sample(target_, rx + p[0], ry + p[1], options_.reach_m);
      put(f, f.slope_x, f.slope_y, -f.slope_x * ry + f.slope_y * rx, residuals++, jacobian);
    }
    for (const SurfacePoint& q : target_points_) {
      const double dx = q.x_m - p[0];
      const double dy = q.y_m - p[1];
      const double bx = c * dx + s * dy;  // the point in the source's frame
      const double by = -s * dx + c * dy;
      const FieldSample f = sample(source_, bx, by, options_.reach_m);
      put(f, -c * f.slope_x + s * f.slope_y, -s * f.slope_x - c * f.slope_y, f.slope_x * by - f.slope_y * bx,
          residuals++, jacobian);
    }
    return true;
  }

  /// Calls `visit(arm, normal)` for each residual in order: from the pose's position to its point, and the surface's
  /// normal there, both in the target's local frame.
  template <typename Visit>
  void for_each_surface(const double* p, Visit&& visit) const {
    const Eigen::Rotation2D<double> turn(p[2]);
    for (const SurfacePoint& q : source_points_) {
      visit(turn * Eigen::Vector2d(q.x_m, q.y_m), turn * q.normal);
    }
    for (const SurfacePoint& q : target_points_) {
      visit(Eigen::Vector2d(q.x_m - p[0], q.y_m - p[1]), q.normal);
    }
  }

 private:
  /// The residual is the square root of the Geman-McClure function: scale * d / sqrt(scale^2 + d^2).
  void put(const FieldSample& f, double by_x, double by_y, double by_theta, double* residual, double*& jacobian) const {
    const double scale2 = options_.scale_m * options_.scale_m;
    const double root = std::sqrt(scale2 + f.distance_m * f.distance_m);
    *residual = options_.scale_m * f.distance_m / root;
    if (jacobian != nullptr) {
      const double slope = options_.scale_m * scale2 / (root * root * root);
      *jacobian++ = slope * by_x;
      *jacobian++ = slope * by_y;
      *jacobian++ = slope * by_theta;
    }
  }

  const MapLevel& target_;
  const MapLevel& source_;
  RefineOptions options_;
  std::vector<SurfacePoint> target_points_;
  std::vector<SurfacePoint> source_points_;
};

/// Share of a normal's square that is the cells' doing: a wall of jagged cells has normals that stray to both sides.
constexpr double kNormalNoise = 0.02;

/// Covariance of (x, y, theta) at the optimum: point-to-line information of the walls that found a partner (Censi 2007,
/// "On achievable accuracy for range-finder localization"), less what stray normals would claim to know.
std::optional<PoseCovariance> local_covariance(const WallDistances& cost, const double* pose, const RefineOptions& o,
                                               double resolution_m, double metres_a_point) {
  std::vector<double> residuals(static_cast<std::size_t>(cost.num_residuals()));
  const double* parameters[] = {pose};
  cost.Evaluate(parameters, residuals.data(), nullptr);
  const double unmatched = o.scale_m * o.reach_m / std::hypot(o.scale_m, o.reach_m) * (1 - 1e-9);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double sum = 0;
  double arms = 0;
  int matched = 0;
  std::size_t i = 0;
  cost.for_each_surface(pose, [&](const Eigen::Vector2d& arm, const Eigen::Vector2d& normal) {
    const double r = residuals[i++];
    if (r >= unmatched || normal.squaredNorm() == 0) {
      return;
    }
    Eigen::Matrix<double, 2, 3> moved;  // of the point, by the pose
    moved << 1, 0, -arm.y(), 0, 1, arm.x();
    const Eigen::Vector3d along_normal = moved.transpose() * normal;
    information += along_normal * along_normal.transpose() - kNormalNoise * moved.transpose() * moved;
    sum += r * r;
    arms += arm.squaredNorm();
    ++matched;
  });
  if (matched < 3) {
    return std::nullopt;
  }
  const double cell = resolution_m / std::sqrt(12);
  const double variance = sum / matched + cell * cell;
  information /= variance * std::max(1.0, o.independent_m / metres_a_point);
  // No direction is known worse than 10 m, no angle worse than pi. In units where a turn weighs like a step.
  const double arm = std::max(0.1, std::sqrt(arms / matched));
  const Eigen::Vector3d unit(1, 1, 1 / arm);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(unit.asDiagonal() * information * unit.asDiagonal());
  const Eigen::Vector3d known = solver.eigenvalues().cwiseMax(0);
  Eigen::Matrix3d floored = solver.eigenvectors() * known.asDiagonal() * solver.eigenvectors().transpose();
  floored = unit.cwiseInverse().asDiagonal() * floored * unit.cwiseInverse().asDiagonal();
  floored.diagonal() += Eigen::Vector3d(1e-2, 1e-2, 1 / (kPi * kPi));
  return floored.inverse();
}

}  // namespace

void RefineOptions::describe(OptionList& list) {
  list.add("reach_m", reach_m, 0.05, 10,
           {"m", "Walls farther than this from any wall of the other map do not pull.",
            "Raise it for poses that are farther off; other walls then pull as well."})
      .add("scale_m", scale_m, 0.01, 5, {"m", "Distance at which a wall's pull begins to fade.", ""})
      .add("max_iterations", max_iterations, 1, 1000, {"", "Iterations of the solver.", ""})
      .add("max_points", max_points, 50, 1000000,
           {"points", "Wall points of each map.", "Time grows with it; the covariance takes it into account."})
      .add("independent_m", independent_m, 0.01, 100,
           {"m", "Length of wall that counts as one independent measurement in the covariance.", ""});
}

Refiner::Refiner(const PreparedMap& target, const PreparedMap& source, RefineOptions options)
    : target_(target),
      source_(source),
      options_(options),
      target_sides_(sides_within(target, wall_sides(target), kSideReach)),
      source_sides_(sides_within(source, wall_sides(source), kSideReach)) {
  require_valid(options_, "refine");
}

PoseEstimate Refiner::operator()(const Pose2& target_from_source) const {
  const Pose2 start = to_local(target_from_source, target_, source_);
  double pose[3] = {start.x_m, start.y_m, start.theta_rad};
  WallDistances cost(target_.level(0), source_.level(0),
                     same_side_walls(target_, source_, source_sides_, inverse(start), options_.max_points),
                     same_side_walls(source_, target_, target_sides_, start, options_.max_points), options_);
  if (cost.num_residuals() < 3) {
    return {target_from_source, std::nullopt};
  }
  ceres::Problem::Options problem_options;
  problem_options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problem_options);
  problem.AddResidualBlock(&cost, nullptr, pose);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = options_.max_iterations;
  solver.function_tolerance = 1e-4;
  solver.parameter_tolerance = 1e-6;
  solver.logging_type = ceres::SILENT;
  solver.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);

  const auto step = [&](const PreparedMap& map) {
    const auto limit = static_cast<std::size_t>(options_.max_points);
    return static_cast<double>(std::max<std::size_t>(1, (map.walls().size() + limit - 1) / limit));
  };
  const double metres_a_point = 0.5 * (step(target_) + step(source_)) * target_.resolution_m();
  const std::optional<PoseCovariance> local =
      local_covariance(cost, pose, options_, target_.resolution_m(), metres_a_point);
  const Pose2 better{pose[0], pose[1], wrap_angle(pose[2])};
  if (!local || !summary.IsSolutionUsable()) {
    return {target_from_source, std::nullopt};
  }
  // Both map frames are taken as exact: only the pose between the local frames is uncertain.
  const PoseCovariance exact = PoseCovariance::Zero();
  return compose(compose({target_.map_from_local(), exact}, {better, local}),
                 {inverse(source_.map_from_local()), exact});
}

PoseEstimate refine(const PreparedMap& target, const PreparedMap& source, const Pose2& target_from_source,
                    const RefineOptions& options) {
  return Refiner(target, source, options)(target_from_source);
}

}  // namespace gridmerge
