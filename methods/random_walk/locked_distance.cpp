#include "methods/random_walk/locked_distance.hpp"

#include <algorithm>
#include <cmath>

#include "methods/random_walk/manhattan.hpp"

namespace gridmerge {
namespace {

std::int8_t in_units(double cost) { return static_cast<std::int8_t>(std::lround(LockTable::kFull * cost)); }

/// Sum of the weighted costs of the points, moved by the pose, in units of 1/LockTable::kFull.
double cost_of(const std::vector<std::int8_t>& costs, const MapLevel& level, const std::vector<ThinnedWall>& points,
               const Pose2& table_from_points) {
  const auto scale = static_cast<float>(1 / level.resolution_m);
  const float c = static_cast<float>(std::cos(table_from_points.theta_rad)) * scale;
  const float s = static_cast<float>(std::sin(table_from_points.theta_rad)) * scale;
  const float x0 = static_cast<float>(table_from_points.x_m - level.lower_left.x_m) * scale;
  const float y0 = static_cast<float>(table_from_points.y_m - level.lower_left.y_m) * scale;
  const auto width = static_cast<std::uint32_t>(level.width);
  const auto height = static_cast<std::uint32_t>(level.height);
  float sum = 0;
  for (const auto& [p, weight] : points) {
    // Truncation takes (-1, 0) to 0 as well: that is the outermost cell of the margin, which is unknown.
    const float x = std::clamp(c * p.x_m - s * p.y_m + x0, -1e6F, 1e6F);
    const float y = std::clamp(s * p.x_m + c * p.y_m + y0, -1e6F, 1e6F);
    const auto column = static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
    const auto row = static_cast<std::uint32_t>(static_cast<std::int32_t>(y));
    const bool within = column < width && row < height;
    sum += within ? weight * static_cast<float>(costs[row * width + column]) : 0.0F;
  }
  return static_cast<double>(sum);
}

/// At most `max_points` of the points, evenly taken, their weight times what one stands for.
std::vector<ThinnedWall> every_nth(const std::vector<ThinnedWall>& points, std::size_t max_points, float weight) {
  const std::size_t n = std::max<std::size_t>(1, (points.size() + max_points - 1) / max_points);
  std::vector<ThinnedWall> some;
  some.reserve(points.size() / n + 1);
  for (std::size_t i = 0; i < points.size(); i += n) {
    some.push_back({points[i].at, weight * static_cast<float>(n) * points[i].weight});
  }
  return some;
}

std::vector<ThinnedWall> free_cells(const MapLevel& level) {
  std::vector<ThinnedWall> cells;
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      if (level.state[level.offset(column, row)] == CellState::kOpen) {
        cells.push_back({{static_cast<float>(level.lower_left.x_m + (column + 0.5) * level.resolution_m),
                          static_cast<float>(level.lower_left.y_m + (row + 0.5) * level.resolution_m)},
                         1});
      }
    }
  }
  return cells;
}

}  // namespace

void LockOptions::describe(OptionList& list) {
  list.add("reach_m", reach_m, 0.05, 5,
           {"m", "Distance at which psi is truncated: walls farther apart do not pull.",
            "Raise it for maps bent by drift; look-alike places then become harder to tell apart."})
      .add("c_lock", c_lock, 0, 4,
           {"", "What a wall in the other map's free space costs, where a wall on a wall earns 1.",
            "Lower it where things moved between the two visits."})
      .add("free_weight", free_weight, 0, 4,
           {"", "What a free cell on the other map's walls costs, by its distance to free space.",
            "0 leaves psi's second value out, and saves half the time."});
}

LockTable::LockTable(const MapLevel& of_level, const LockOptions& options) : level(&of_level) {
  const double reach = std::max(options.reach_m, 1.5 * of_level.resolution_m);
  const std::vector<int> to_free = manhattan_distances(of_level, CellState::kOpen);
  of_wall.resize(of_level.state.size());
  of_free.resize(of_level.state.size());
  for (std::size_t i = 0; i < of_wall.size(); ++i) {
    const double d = of_level.wall_distance_m[i];
    const double psi = std::min(d / reach, 1.0) - 1;
    const bool open = of_level.state[i] == CellState::kOpen;
    const double conflict = open ? options.c_lock * std::clamp(d / reach - 1, 0.0, 1.0) : 0;
    of_wall[i] = in_units(psi + conflict);
    const bool wall = of_level.state[i] == CellState::kWall;
    of_free[i] = in_units(wall ? std::min(to_free[i] * of_level.resolution_m / reach, 1.0) : 0);
  }
}

LockedDistance::LockedDistance(const PreparedMap& target, const PreparedMap& source, int level,
                               const LockOptions& options, std::size_t max_points)
    : target_table_(target.level(level), options), source_table_(source.level(level), options) {
  const auto walls = [&](const PreparedMap& map) {
    return every_nth(thinned_walls(map, map.level(level)), max_points, 1);
  };
  target_walls_ = walls(target);
  source_walls_ = walls(source);
  if (options.free_weight > 0) {
    const auto weight = static_cast<float>(options.free_weight);
    target_free_ = every_nth(free_cells(target.level(level)), max_points, weight);
    source_free_ = every_nth(free_cells(source.level(level)), max_points, weight);
  }
}

double LockedDistance::operator()(const Pose2& local_target_from_source) const {
  const Pose2 back = inverse(local_target_from_source);
  const MapLevel& target = *target_table_.level;
  const MapLevel& source = *source_table_.level;
  const double sum = cost_of(target_table_.of_wall, target, source_walls_, local_target_from_source) +
                     cost_of(source_table_.of_wall, source, target_walls_, back) +
                     cost_of(target_table_.of_free, target, source_free_, local_target_from_source) +
                     cost_of(source_table_.of_free, source, target_free_, back);
  return sum / LockTable::kFull;
}

}  // namespace gridmerge
