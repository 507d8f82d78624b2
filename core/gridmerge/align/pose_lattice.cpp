#include "gridmerge/align/pose_lattice.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {
namespace {

int choose_level(const PreparedMap& fixed, const PreparedMap& moving, const LatticeOptions& options) {
  int level = options.finest_level;
  const auto side = [&](int k) {
    const MapLevel& f = fixed.level(k);
    return std::max(f.width, f.height) + 2 * moving.radius_m() / f.resolution_m;
  };
  while (level < options.coarsest_level && side(level) > options.max_cells) {
    ++level;
  }
  return level;
}

int whole_weight(float weight) {
  return std::max(1, static_cast<int>(std::lround(static_cast<double>(weight) * PoseLattice::kFullWeight)));
}

std::vector<CellWeight> on_cells(const std::vector<ThinnedWall>& walls, const MapLevel& level) {
  std::vector<CellWeight> cells;
  cells.reserve(walls.size());
  for (const auto& [at, weight] : walls) {
    const auto [column, row] = level.cell_at(at);
    cells.push_back({column, row, whole_weight(weight)});
  }
  return cells;
}

/// (column, row) turned by so many quarter turns, counter-clockwise.
std::pair<int, int> quarter_turned(int column, int row, int quarters) {
  switch (quarters) {
    case 1:
      return {-row, column};
    case 2:
      return {-column, -row};
    case 3:
      return {row, -column};
    default:
      return {column, row};
  }
}

}  // namespace

PoseLattice::PoseLattice(const PreparedMap& fixed, const PreparedMap& moving, const std::optional<PoseWindow>& window,
                         const LatticeOptions& options)
    : level_(choose_level(fixed, moving, options)),
      fixed_level_(&fixed.level(level_)),
      moving_level_(&moving.level(level_)),
      window_(window),
      fixed_table_(*fixed_level_, options.fit),
      moving_table_(*moving_level_, options.fit),
      moving_walls_(thinned_walls(moving, *moving_level_)),
      fixed_walls_(options.both_ways ? on_cells(thinned_walls(fixed, *fixed_level_), *fixed_level_)
                                     : std::vector<CellWeight>{}),
      reach_(static_cast<int>(std::ceil(moving.radius_m() / fixed_level_->resolution_m)) + 1) {
  const double step = options.angle_step_rad;
  if (!window || window->angle_rad >= kPi - step / 2) {
    turns_ = 4;
    const int groups = std::max(1, static_cast<int>(std::ceil(kPi / 2 / step - 1e-9)));
    angle_step_rad_ = kPi / 2 / groups;
    for (int i = 0; i < groups; ++i) {
      base_angles_rad_.push_back(i * angle_step_rad_);
    }
    return;
  }
  const int each_way = static_cast<int>(std::ceil(window->angle_rad / step));
  angle_step_rad_ = each_way == 0 ? step : window->angle_rad / each_way;
  for (int i = -each_way; i <= each_way; ++i) {
    base_angles_rad_.push_back(window->centre.theta_rad + i * angle_step_rad_);
  }
}

void PoseLattice::keep_groups(const std::function<bool(double base_angle_rad)>& passes) {
  std::erase_if(base_angles_rad_, [&](double angle) { return !passes(angle); });
}

double PoseLattice::angle_rad(int angle) const {
  return wrap_angle(base_angles_rad_[static_cast<std::size_t>(angle / turns_)] + (angle % turns_) * kPi / 2);
}

Pose2 PoseLattice::pose(const LatticePose& at) const {
  return {fixed_level_->lower_left.x_m + (at.column + 0.5) * fixed_level_->resolution_m,
          fixed_level_->lower_left.y_m + (at.row + 0.5) * fixed_level_->resolution_m, angle_rad(at.angle)};
}

TurnedMap PoseLattice::turned(int group) const {
  const double angle = base_angles_rad_[static_cast<std::size_t>(group)];
  const auto c = static_cast<float>(std::cos(angle));
  const auto s = static_cast<float>(std::sin(angle));
  const auto per_cell = static_cast<float>(1 / fixed_level_->resolution_m);
  TurnedMap map;
  map.reach = reach_;
  map.walls.reserve(moving_walls_.size());
  for (const auto& [at, weight] : moving_walls_) {
    map.walls.push_back({static_cast<int>(std::lround((c * at.x_m - s * at.y_m) * per_cell)),
                         static_cast<int>(std::lround((s * at.x_m + c * at.y_m) * per_cell)), whole_weight(weight)});
  }
  const int side = 2 * reach_ + 1;
  map.reward.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), 0);
  const float low_x = static_cast<float>(moving_level_->lower_left.x_m) * per_cell;
  const float low_y = static_cast<float>(moving_level_->lower_left.y_m) * per_cell;
  for (int row = -reach_; row <= reach_; ++row) {
    std::int8_t* line = &map.reward[static_cast<std::size_t>(row + reach_) * static_cast<std::size_t>(side)];
    for (int column = -reach_; column <= reach_; ++column) {
      const float x = c * static_cast<float>(column) + s * static_cast<float>(row) - low_x;
      const float y = c * static_cast<float>(row) - s * static_cast<float>(column) - low_y;
      const int from_column = static_cast<int>(x);
      const int from_row = static_cast<int>(y);
      if (x >= 0 && y >= 0 && from_column < moving_level_->width && from_row < moving_level_->height) {
        line[column + reach_] = moving_table_.value[moving_level_->offset(from_column, from_row)];
      }
    }
  }
  return map;
}

std::int64_t PoseLattice::score(const LatticePose& at, const TurnedMap& moving) const {
  const int quarters = at.angle % turns_;
  const int side = 2 * reach_ + 1;
  std::int64_t sum = 0;
  for (const CellWeight& wall : moving.walls) {
    const auto [column, row] = quarter_turned(wall.column, wall.row, quarters);
    if (fixed_level_->contains(at.column + column, at.row + row)) {
      sum += wall.weight * fixed_table_.value[fixed_level_->offset(at.column + column, at.row + row)];
    }
  }
  for (const CellWeight& wall : fixed_walls_) {
    const auto [column, row] = quarter_turned(wall.column - at.column, wall.row - at.row, (4 - quarters) % 4);
    if (std::abs(column) <= reach_ && std::abs(row) <= reach_) {
      sum += wall.weight * moving.reward[static_cast<std::size_t>(row + reach_) * static_cast<std::size_t>(side) +
                                         static_cast<std::size_t>(column + reach_)];
    }
  }
  return sum;
}

}  // namespace gridmerge
