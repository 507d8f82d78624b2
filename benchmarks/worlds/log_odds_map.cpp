#include "worlds/log_odds_map.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

constexpr int kMargin = 4;  // [cells]

/// The cells between two points of the grid, given in cells, without the last one (Amanatides, Woo 1987).
template <typename Visit>
void walk_cells(Point2 from, Point2 to, Visit&& visit) {
  int column = static_cast<int>(std::floor(from.x_m));
  int row = static_cast<int>(std::floor(from.y_m));
  const int last_column = static_cast<int>(std::floor(to.x_m));
  const int last_row = static_cast<int>(std::floor(to.y_m));
  const Point2 span = to - from;
  const int step_x = span.x_m < 0 ? -1 : 1;
  const int step_y = span.y_m < 0 ? -1 : 1;
  // How far along (0..1) the next border lies, and how far one border is from the next.
  const double per_x = span.x_m != 0 ? std::abs(1 / span.x_m) : std::numeric_limits<double>::infinity();
  const double per_y = span.y_m != 0 ? std::abs(1 / span.y_m) : std::numeric_limits<double>::infinity();
  const double in_x = step_x > 0 ? column + 1 - from.x_m : from.x_m - column;
  const double in_y = step_y > 0 ? row + 1 - from.y_m : from.y_m - row;
  double next_x = in_x > 0 ? in_x * per_x : 0;
  double next_y = in_y > 0 ? in_y * per_y : 0;
  for (int left = std::abs(last_column - column) + std::abs(last_row - row); left > 0; --left) {
    visit(column, row);
    if (next_x < next_y) {
      column += step_x;
      next_x += per_x;
    } else {
      row += step_y;
      next_y += per_y;
    }
  }
}

}  // namespace

LogOddsMap::LogOddsMap(const GridGeometry& geometry, const LogOddsSteps& steps)
    : geometry_(geometry), steps_(steps), log_odds_(geometry.cell_count(), 0), turn_(geometry.cell_count(), 0) {}

void LogOddsMap::add(const Pose2& map_from_lidar, const std::vector<Point2>& hits) {
  assert(now_ < std::numeric_limits<std::uint16_t>::max());
  ++now_;
  const Pose2 grid_from_lidar = inverse(geometry_.map_from_grid) * map_from_lidar;
  const Point2 ahead = direction(grid_from_lidar.theta_rad);
  const double cells_per_m = 1 / geometry_.resolution_m;
  const auto in_cells = [&](Point2 p) -> Point2 {
    return {snapped((ahead.x_m * p.x_m - ahead.y_m * p.y_m + grid_from_lidar.x_m) * cells_per_m),
            snapped((ahead.y_m * p.x_m + ahead.x_m * p.y_m + grid_from_lidar.y_m) * cells_per_m)};
  };
  const auto tell = [&](int column, int row, int by) {
    if (!geometry_.contains({column, row})) {
      return;
    }
    const std::size_t cell = geometry_.offset({column, row});
    if (turn_[cell] != now_) {
      turn_[cell] = now_;
      log_odds_[cell] = static_cast<std::int16_t>(std::clamp(log_odds_[cell] + by, steps_.least, steps_.most));
    }
  };
  const Point2 here = in_cells({0, 0});
  for (const Point2& hit : hits) {
    const Point2 end = in_cells(hit);
    tell(static_cast<int>(std::floor(end.x_m)), static_cast<int>(std::floor(end.y_m)), steps_.hit);
  }
  for (const Point2& hit : hits) {
    walk_cells(here, in_cells(hit), [&](int column, int row) { tell(column, row, steps_.pass); });
  }
}

OccupancyGrid LogOddsMap::grid(bool probabilistic) const {
  CellIndex low = {geometry_.width, geometry_.height};
  CellIndex high = {-1, -1};
  for (int row = 0; row < geometry_.height; ++row) {
    for (int column = 0; column < geometry_.width; ++column) {
      if (turn_[geometry_.offset({column, row})] != 0) {
        low = {std::min(low.column, column), std::min(low.row, row)};
        high = {std::max(high.column, column), std::max(high.row, row)};
      }
    }
  }
  if (high.column < 0) {
    low = high = {0, 0};  // nothing was seen: one unknown cell, and the margin
  }
  low = {low.column - kMargin, low.row - kMargin};
  high = {high.column + kMargin, high.row + kMargin};
  GridGeometry cropped = geometry_;
  cropped.width = high.column - low.column + 1;
  cropped.height = high.row - low.row + 1;
  cropped.map_from_grid =
      geometry_.map_from_grid * Pose2{low.column * geometry_.resolution_m, low.row * geometry_.resolution_m, 0};
  OccupancyGrid map = unknown_grid(cropped);
  for (int row = 0; row < cropped.height; ++row) {
    for (int column = 0; column < cropped.width; ++column) {
      const CellIndex from = {low.column + column, low.row + row};
      if (!geometry_.contains(from) || turn_[geometry_.offset(from)] == 0) {
        continue;
      }
      const int log_odds = log_odds_[geometry_.offset(from)];
      if (probabilistic) {
        map.at({column, row}) = static_cast<std::int8_t>(std::lround(snapped(100 / (1 + std::exp(-log_odds / 100.0)))));
      } else if (log_odds != 0) {
        map.at({column, row}) = log_odds > 0 ? kOccupied : kFree;
      }
    }
  }
  return map;
}

}  // namespace gridmerge::worlds
