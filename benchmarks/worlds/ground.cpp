#include "worlds/ground.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

namespace gridmerge::worlds {
namespace {

constexpr double kCell = 0.2;     // [m] side of a planning cell
constexpr double kBody = 0.25;    // [m] nothing may come nearer to the robot's centre
constexpr double kComfort = 0.8;  // [m] nearer than this costs extra

double distance(const Segment& wall, Point2 point) {
  const Point2 span = wall.to - wall.from;
  const Point2 way = point - wall.from;
  const double length2 = span.x_m * span.x_m + span.y_m * span.y_m;
  const double along = length2 > 0 ? (way.x_m * span.x_m + way.y_m * span.y_m) / length2 : 0;
  const Point2 off = way - std::clamp(along, 0.0, 1.0) * span;
  return std::sqrt(off.x_m * off.x_m + off.y_m * off.y_m);
}

double distance(const Disc& disc, Point2 point) {
  const Point2 off = point - disc.centre;
  return std::sqrt(off.x_m * off.x_m + off.y_m * off.y_m) - disc.radius_m;
}

}  // namespace

template <typename Visit>
void Ground::for_neighbours(int cell, Visit&& visit) const {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int column = cell % columns_ + dx;
      const int row = cell / columns_ + dy;
      const bool inside = column >= 0 && row >= 0 && column < columns_ && row < rows_;
      if (inside && (dx != 0 || dy != 0) && passable(row * columns_ + column)) {
        visit(row * columns_ + column, dx != 0 && dy != 0 ? 1.4142135 : 1.0);
      }
    }
  }
}

/// visit(cell) for the cells of the box low..high and `reach_m` round about, row by row.
template <typename Visit>
void Ground::for_cells_about(Point2 low, Point2 high, double reach_m, Visit&& visit) const {
  const auto index = [](double at_m, int limit) {
    return std::clamp(static_cast<int>(std::floor(at_m / kCell)), 0, limit - 1);
  };
  const int last_row = index(high.y_m + reach_m, rows_);
  const int first_column = index(low.x_m - reach_m, columns_);
  const int last_column = index(high.x_m + reach_m, columns_);
  for (int row = index(low.y_m - reach_m, rows_); row <= last_row; ++row) {
    for (int column = first_column; column <= last_column; ++column) {
      visit(row * columns_ + column);
    }
  }
}

/// Lowers the clearance round an obstacle that lies within the box low..high.
template <typename Obstacle>
void Ground::narrow(Point2 low, Point2 high, const Obstacle& obstacle) {
  for_cells_about(low, high, kComfort, [&](int cell) {
    double& there = clearance_[static_cast<std::size_t>(cell)];
    there = std::min(there, distance(obstacle, centre(cell)));
  });
}

/// Writes the number of a part on all cells connected with one of its cells.
void Ground::mark_connected(int seed, int part, std::vector<int>& part_of) const {
  std::vector<int> open = {seed};
  part_of[static_cast<std::size_t>(seed)] = part;
  while (!open.empty()) {
    const int here = open.back();
    open.pop_back();
    for_neighbours(here, [&](int to, double /*length*/) {
      if (part_of[static_cast<std::size_t>(to)] == kNone) {
        part_of[static_cast<std::size_t>(to)] = part;
        open.push_back(to);
      }
    });
  }
}

/// Closes what no place is connected with.
void Ground::fill_rock(const std::vector<Point2>& places) {
  std::vector<int> part_of(clearance_.size(), kNone);
  for (const Point2& place : places) {
    const int cell = near(place, 0.5);
    if (cell != kNone && part_of[static_cast<std::size_t>(cell)] == kNone) {
      mark_connected(cell, 0, part_of);
    }
  }
  for (std::size_t cell = 0; cell < clearance_.size(); ++cell) {
    clearance_[cell] = part_of[cell] == kNone ? 0 : clearance_[cell];
  }
}

void Ground::keep_largest_part() {
  std::vector<int> part_of(clearance_.size(), kNone);
  int parts = 0;
  for (int seed = 0; seed < count(); ++seed) {
    if (passable(seed) && part_of[static_cast<std::size_t>(seed)] == kNone) {
      mark_connected(seed, parts++, part_of);
    }
  }
  std::vector<int> sizes(static_cast<std::size_t>(parts), 0);
  for (const int part : part_of) {
    if (part != kNone) {
      ++sizes[static_cast<std::size_t>(part)];
    }
  }
  const auto largest = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  for (std::size_t cell = 0; cell < clearance_.size(); ++cell) {
    if (part_of[cell] != largest) {
      clearance_[cell] = 0;
    }
  }
}

Ground::Ground(const World& world, const Share& bounds) {
  columns_ = static_cast<int>(std::ceil(world.length_m / kCell));
  rows_ = static_cast<int>(std::ceil(world.depth_m / kCell));
  clearance_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kComfort);
  for (const Segment& wall : world.walls) {
    narrow({std::min(wall.from.x_m, wall.to.x_m), std::min(wall.from.y_m, wall.to.y_m)},
           {std::max(wall.from.x_m, wall.to.x_m), std::max(wall.from.y_m, wall.to.y_m)}, wall);
  }
  for (const Disc& disc : world.discs) {
    const Point2 radius = {disc.radius_m, disc.radius_m};
    narrow(disc.centre - radius, disc.centre + radius, disc);
  }
  if (world.rock) {
    fill_rock(world.places);
  }
  keep_largest_part();
  for (int cell = 0; cell < count(); ++cell) {
    const Point2 at = centre(cell);
    if (!bounds.contains(at.x_m) || at.x_m > world.length_m || at.y_m > world.depth_m) {
      clearance_[static_cast<std::size_t>(cell)] = 0;
    }
  }
  keep_largest_part();
}

Point2 Ground::centre(int cell) const { return {(cell % columns_ + 0.5) * kCell, (cell / columns_ + 0.5) * kCell}; }

bool Ground::passable(int cell) const { return clearance(cell) >= kBody; }

int Ground::near(Point2 point, double within_m) const {
  int best = kNone;
  double best2 = within_m * within_m;
  for_cells_about(point, point, within_m, [&](int cell) {
    const Point2 off = centre(cell) - point;
    const double off2 = off.x_m * off.x_m + off.y_m * off.y_m;
    if (passable(cell) && off2 < best2) {
      best = cell;
      best2 = off2;
    }
  });
  return best;
}

std::vector<int> Ground::ring(Point2 point, double from_m, double to_m) const {
  std::vector<int> cells;
  for_cells_about(point, point, to_m, [&](int cell) {
    const Point2 off = centre(cell) - point;
    const double off2 = off.x_m * off.x_m + off.y_m * off.y_m;
    if (passable(cell) && off2 >= from_m * from_m && off2 <= to_m * to_m) {
      cells.push_back(cell);
    }
  });
  return cells;
}

std::vector<int> Ground::way_to_nearest(int from, const std::vector<bool>& wanted) const {
  std::vector<double> cost(clearance_.size(), std::numeric_limits<double>::infinity());
  std::vector<int> previous(clearance_.size(), kNone);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[static_cast<std::size_t>(from)] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [cost_here, here] = open.top();
    open.pop();
    if (cost_here > cost[static_cast<std::size_t>(here)]) {
      continue;
    }
    if (wanted[static_cast<std::size_t>(here)]) {
      std::vector<int> way;
      for (int cell = here; cell != from; cell = previous[static_cast<std::size_t>(cell)]) {
        way.push_back(cell);
      }
      std::reverse(way.begin(), way.end());
      return way;
    }
    for_neighbours(here, [&, from_cost = cost_here, from_cell = here](int to, double length) {
      const double cost_to = from_cost + length * (1 + 4 * (kComfort - clearance(to)));
      if (cost_to < cost[static_cast<std::size_t>(to)]) {
        cost[static_cast<std::size_t>(to)] = cost_to;
        previous[static_cast<std::size_t>(to)] = from_cell;
        open.emplace(cost_to, to);
      }
    });
  }
  return {};
}

}  // namespace gridmerge::worlds
