#include "worlds/slam.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

// What a turn tells of a cell: probabilities of 0.9 and 0.4, as in hector_mapping; and where the log-odds saturate, at
// probabilities that hardly differ from 0 and 1.
constexpr int kCertain = 2000;
constexpr LogOddsSteps kSteps = {.hit = 220, .pass = -41, .least = -kCertain, .most = kCertain};

// A step of Gauss-Newton goes no farther: the hessian of a bare corridor is all but singular.
constexpr double kFarthest = 2;     // [cells]
constexpr double kWidest = 0.2;     // [rad]
constexpr double kSingular = 1e-9;  // of the product of the hessian's diagonal

/// The occupancy M of a level between its cells' centres.
class Occupancy {
 public:
  struct Sample {
    double value = 0;
    double by_x = 0;  // [1/cell]
    double by_y = 0;
  };

  Occupancy(const LogOddsMap& map, const std::vector<double>& probabilities)
      : log_odds_(map.log_odds().data()),
        probabilities_(probabilities.data() + kCertain),
        width_(map.geometry().width),
        height_(map.geometry().height) {}

  /// False near the border, where there is nothing to interpolate.
  [[nodiscard]] bool reaches(Point2 cells) const {
    return cells.x_m >= 0.5 && cells.y_m >= 0.5 && cells.x_m < width_ - 0.5 - 1e-6 && cells.y_m < height_ - 0.5 - 1e-6;
  }

  /// Eq. 4-6 [kohlbrecher2011]: bilinear interpolation, and its derivatives.
  [[nodiscard]] Sample at(Point2 cells) const {
    const double x = cells.x_m - 0.5;
    const double y = cells.y_m - 0.5;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const double right = x - column;
    const double up = y - row;
    const std::int16_t* lower = log_odds_ + static_cast<std::ptrdiff_t>(row) * width_ + column;
    const std::int16_t* upper = lower + width_;
    const double lower_by_x = probability(lower[1]) - probability(lower[0]);
    const double upper_by_x = probability(upper[1]) - probability(upper[0]);
    const double below = probability(lower[0]) + right * lower_by_x;
    const double above = probability(upper[0]) + right * upper_by_x;
    return {below + up * (above - below), lower_by_x + up * (upper_by_x - lower_by_x), above - below};
  }

 private:
  [[nodiscard]] double probability(int log_odds) const { return probabilities_[log_odds]; }

  const std::int16_t* log_odds_;
  const double* probabilities_;
  int width_;
  int height_;
};

/// The sums of Eq. 12 and 13: hessian * step = slope.
struct NormalEquations {
  double xx = 0, yy = 0, tt = 0, xy = 0, xt = 0, yt = 0;
  double x = 0, y = 0, t = 0;
};

/// @param pose  cells_from_lidar
NormalEquations normal_equations(const Occupancy& occupancy, const Pose2& pose, const std::vector<Point2>& hits,
                                 double cells_per_m) {
  const Point2 ahead = direction(pose.theta_rad);
  NormalEquations sums;
  for (const Point2& hit : hits) {
    const Point2 arm = cells_per_m * Point2{ahead.x_m * hit.x_m - ahead.y_m * hit.y_m,  // Eq. 8
                                            ahead.y_m * hit.x_m + ahead.x_m * hit.y_m};
    const Point2 end = pose.translation() + arm;
    if (!occupancy.reaches(end)) {
      continue;
    }
    const Occupancy::Sample m = occupancy.at(end);
    const double by_theta = m.by_y * arm.x_m - m.by_x * arm.y_m;  // Eq. 14
    const double missing = 1 - m.value;
    sums.x += m.by_x * missing;
    sums.y += m.by_y * missing;
    sums.t += by_theta * missing;
    sums.xx += m.by_x * m.by_x;
    sums.yy += m.by_y * m.by_y;
    sums.tt += by_theta * by_theta;
    sums.xy += m.by_x * m.by_y;
    sums.xt += m.by_x * by_theta;
    sums.yt += m.by_y * by_theta;
  }
  return sums;
}

/// The step of Eq. 12, kept within bounds; none where the hits say nothing of the pose.
Pose2 step_of(const NormalEquations& h) {
  const double xx = h.yy * h.tt - h.yt * h.yt;
  const double xy = h.xt * h.yt - h.xy * h.tt;
  const double xt = h.xy * h.yt - h.xt * h.yy;
  const double determinant = h.xx * xx + h.xy * xy + h.xt * xt;
  if (!(determinant > kSingular * h.xx * h.yy * h.tt)) {
    return {};
  }
  const double yy = h.xx * h.tt - h.xt * h.xt;
  const double yt = h.xy * h.xt - h.xx * h.yt;
  const double tt = h.xx * h.yy - h.xy * h.xy;
  const double x = (xx * h.x + xy * h.y + xt * h.t) / determinant;
  const double y = (xy * h.x + yy * h.y + yt * h.t) / determinant;
  const double theta_rad = (xt * h.x + yt * h.y + tt * h.t) / determinant;
  const double far = std::sqrt(x * x + y * y);
  const double shorter = far > kFarthest ? kFarthest / far : 1;
  return {shorter * x, shorter * y, std::clamp(theta_rad, -kWidest, kWidest)};
}

/// Eq. 7 by Gauss-Newton on one level.
/// @return grid_from_lidar [m]
Pose2 matched(const Occupancy& occupancy, double resolution_m, Pose2 grid_from_lidar, const std::vector<Point2>& hits,
              int iterations) {
  const double cells_per_m = 1 / resolution_m;
  Pose2 pose = {grid_from_lidar.x_m * cells_per_m, grid_from_lidar.y_m * cells_per_m, grid_from_lidar.theta_rad};
  for (int i = 0; i < iterations; ++i) {
    const Pose2 step = step_of(normal_equations(occupancy, pose, hits, cells_per_m));
    pose = {snapped(pose.x_m + step.x_m), snapped(pose.y_m + step.y_m),
            snapped(wrap_angle(pose.theta_rad + step.theta_rad))};
  }
  return {pose.x_m * resolution_m, pose.y_m * resolution_m, pose.theta_rad};
}

/// Of log-odds -kCertain..kCertain.
std::vector<double> probability_table() {
  std::vector<double> table;
  for (int log_odds = -kCertain; log_odds <= kCertain; ++log_odds) {
    table.push_back(snapped(1 / (1 + std::exp(-log_odds / 100.0))));
  }
  return table;
}

/// Compounding, and compounding with the inverse, that give the same bits everywhere.
Pose2 product(const Pose2& a_from_b, const Pose2& b_from_c) {
  const Point2 ahead = direction(a_from_b.theta_rad);
  return {snapped(ahead.x_m * b_from_c.x_m - ahead.y_m * b_from_c.y_m + a_from_b.x_m),
          snapped(ahead.y_m * b_from_c.x_m + ahead.x_m * b_from_c.y_m + a_from_b.y_m),
          snapped(wrap_angle(a_from_b.theta_rad + b_from_c.theta_rad))};
}

Pose2 quotient(const Pose2& a_from_b, const Pose2& a_from_c) {
  const Point2 ahead = direction(a_from_b.theta_rad);
  const Point2 way = a_from_c.translation() - a_from_b.translation();
  return {snapped(ahead.x_m * way.x_m + ahead.y_m * way.y_m), snapped(ahead.x_m * way.y_m - ahead.y_m * way.x_m),
          snapped(wrap_angle(a_from_c.theta_rad - a_from_b.theta_rad))};
}

/// Level number `level`: cells 2^level as wide.
GridGeometry coarser(GridGeometry geometry, int level) {
  const int scale = 1 << level;
  geometry.width = (geometry.width + scale - 1) / scale;
  geometry.height = (geometry.height + scale - 1) / scale;
  geometry.resolution_m *= scale;
  return geometry;
}

}  // namespace

void SlamOptions::describe(OptionList& list) {
  list.add("levels", levels, 1, 6,
           {"", "Maps in the pyramid, each with cells twice as wide as the one before.",
            "more mend a guess that is farther off; each costs less than half of the one before"})
      .add("coarse_iterations", coarse_iterations, 1, 100, {"", "Steps of Gauss-Newton on each coarse level.", ""})
      .add("fine_iterations", fine_iterations, 1, 100, {"", "Steps of Gauss-Newton on the finest level.", ""})
      .add("update_distance_m", update_distance_m, 0, 10,
           {"m", "Way after which a scan is drawn into the map.", "less draws more, and drifts more with every scan"})
      .add("update_angle_deg", update_angle_deg, 0, 180, {"deg", "Turn after which a scan is drawn into the map.", ""});
}

HectorMapper::HectorMapper(const GridGeometry& geometry, const SlamOptions& options)
    : options_(options), probabilities_(probability_table()) {
  require_valid(options, "slam");
  for (int level = 0; level < options.levels; ++level) {
    levels_.emplace_back(coarser(geometry, level), kSteps);
  }
}

Pose2 HectorMapper::add(const Pose2& map_from_lidar_guess, const std::vector<Point2>& hits) {
  const Pose2 guess = {snapped(map_from_lidar_guess.x_m), snapped(map_from_lidar_guess.y_m),
                       snapped(map_from_lidar_guess.theta_rad)};
  if (hits.empty()) {
    return guess;
  }
  const Pose2 map_from_lidar = drawn_ ? match(guess, hits) : guess;
  if (!drawn_ || has_moved_on(map_from_lidar)) {
    for (LogOddsMap& level : levels_) {
      level.add(map_from_lidar, hits);
    }
    drawn_ = true;
    drawn_from_ = map_from_lidar;
  }
  return map_from_lidar;
}

Pose2 HectorMapper::match(const Pose2& map_from_lidar, const std::vector<Point2>& hits) const {
  const Pose2& map_from_grid = levels_.front().geometry().map_from_grid;
  Pose2 grid_from_lidar = quotient(map_from_grid, map_from_lidar);
  for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
    const bool finest = &*level == &levels_.front();
    grid_from_lidar = matched(Occupancy(*level, probabilities_), level->geometry().resolution_m, grid_from_lidar, hits,
                              finest ? options_.fine_iterations : options_.coarse_iterations);
  }
  return product(map_from_grid, grid_from_lidar);
}

bool HectorMapper::has_moved_on(const Pose2& map_from_lidar) const {
  const Pose2 moved = quotient(drawn_from_, map_from_lidar);
  return moved.x_m * moved.x_m + moved.y_m * moved.y_m > options_.update_distance_m * options_.update_distance_m ||
         std::abs(moved.theta_rad) > radians(options_.update_angle_deg);
}

}  // namespace gridmerge::worlds
