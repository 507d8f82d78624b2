#include "gridmerge/align/wall_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gridmerge/grid/wall_cells.hpp"

namespace gridmerge {
namespace {

/// Sum of the table's values at the points, moved by the pose, in units of 1/FitTable::kFull.
double table_sum(const FitTable& table, const std::vector<ThinnedWall>& points, const Pose2& table_from_points) {
  const MapLevel& level = *table.level;
  const float scale = static_cast<float>(1 / level.resolution_m);
  const float c = static_cast<float>(std::cos(table_from_points.theta_rad)) * scale;
  const float s = static_cast<float>(std::sin(table_from_points.theta_rad)) * scale;
  // One more than the column and the row: truncation then takes nothing from outside of the level into it.
  const float x0 = static_cast<float>(table_from_points.x_m - level.lower_left.x_m) * scale + 1;
  const float y0 = static_cast<float>(table_from_points.y_m - level.lower_left.y_m) * scale + 1;
  const auto width = static_cast<std::uint32_t>(level.width);
  const auto height = static_cast<std::uint32_t>(level.height);
  const std::int8_t* values = table.value.data();
  float sum = 0;
  for (const auto& [p, weight] : points) {
    const float x = std::clamp(c * p.x_m - s * p.y_m + x0, -1e6F, 1e6F);  // what a cast to int can take
    const float y = std::clamp(s * p.x_m + c * p.y_m + y0, -1e6F, 1e6F);
    const auto column = static_cast<std::uint32_t>(static_cast<std::int32_t>(x) - 1);
    const auto row = static_cast<std::uint32_t>(static_cast<std::int32_t>(y) - 1);
    const bool within = column < width && row < height;
    sum += within ? weight * static_cast<float>(values[row * width + column]) : 0.0F;
  }
  return static_cast<double>(sum);
}

/// At most `max_points` of the points, evenly taken.
std::vector<ThinnedWall> every_nth(std::vector<ThinnedWall> points, std::size_t max_points) {
  const std::size_t n = (points.size() + max_points - 1) / std::max<std::size_t>(1, max_points);
  if (n <= 1) {
    return points;
  }
  std::vector<ThinnedWall> some;
  for (std::size_t i = 0; i < points.size(); i += n) {
    some.push_back(points[i]);
  }
  return some;
}

}  // namespace

void WallFitOptions::describe(OptionList& list) {
  list.add("tolerance_m", tolerance_m, 0.01, 5,
           {"m", "Standard deviation of the reward for a wall that lies beside a wall.",
            "Raise it for maps bent by drift; look-alike places then become harder to tell apart."})
      .add("free_space_penalty", free_space_penalty, 0, 4,
           {"", "What a wall in the other map's free space costs, where a wall on a wall earns 1.",
            "Lower it where things moved between the two visits."});
}

FitTable::FitTable(const MapLevel& of_level, const WallFitOptions& options) : level(&of_level) {
  const double sigma = std::max(options.tolerance_m, 0.7 * of_level.resolution_m);
  const double clear_from = 2 * sigma;
  value.resize(of_level.state.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double d = of_level.wall_distance_m[i];
    const double reward = d < 4 * sigma ? std::exp(-0.5 * d * d / (sigma * sigma)) : 0;
    const bool clear = of_level.state[i] == CellState::kOpen && d > clear_from;
    value[i] = static_cast<std::int8_t>(std::lround(kFull * (clear ? -options.free_space_penalty : reward)));
  }
}

std::vector<ThinnedWall> thinned_walls(const PreparedMap& map, const MapLevel& level) {
  struct Sum {
    float x = 0;
    float y = 0;
    float n = 0;
    void add(const WallPoint& wall) {
      x += wall.at.x_m;
      y += wall.at.y_m;
      n += 1;
    }
  };
  const float across = static_cast<float>(level.resolution_m / map.resolution_m());
  std::vector<ThinnedWall> points;
  const std::vector<Sum> sums = summed_by_cell<Sum>(map, level);
  points.reserve(sums.size());
  for (const Sum& sum : sums) {
    points.push_back({{sum.x / sum.n, sum.y / sum.n}, std::min(1.0F, sum.n / across)});
  }
  return points;
}

std::vector<ThinnedWall> as_walls(const ClusterPoints& clusters) {
  std::vector<ThinnedWall> walls;
  walls.reserve(clusters.points.size());
  for (const ClusterPoint& one : clusters.points) {
    walls.push_back({one.at, one.weight});
  }
  return walls;
}

WallFit::WallFit(const PreparedMap& target, const PreparedMap& source, int level, const WallFitOptions& options,
                 std::size_t max_points)
    : target_table_(target.level(level), options),
      source_table_(source.level(level), options),
      target_points_(every_nth(thinned_walls(target, target.level(level)), max_points)),
      source_points_(every_nth(thinned_walls(source, source.level(level)), max_points)) {}

WallFit::WallFit(const PreparedMap& target, const PreparedMap& source, int level, const WallFitOptions& options,
                 std::vector<ThinnedWall> target_points, std::vector<ThinnedWall> source_points)
    : target_table_(target.level(level), options),
      source_table_(source.level(level), options),
      target_points_(std::move(target_points)),
      source_points_(std::move(source_points)) {}

double WallFit::operator()(const Pose2& local_target_from_source) const {
  const double forth = table_sum(target_table_, source_points_, local_target_from_source);
  const double back = table_sum(source_table_, target_points_, inverse(local_target_from_source));
  return (forth + back) / FitTable::kFull;
}

}  // namespace gridmerge
