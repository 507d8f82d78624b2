#include "worlds/route.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace gridmerge::worlds {
namespace {

constexpr double kCell = 0.2;     // [m] side of a planning cell
constexpr double kBody = 0.25;    // [m] nothing may come nearer to the robot's centre
constexpr double kComfort = 0.8;  // [m] nearer than this costs extra
constexpr int kNone = -1;

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

/// The world within its bounds as a grid of cells with their distance to the nearest obstacle, up to kComfort.
class Ground {
 public:
  Ground(const World& world, const Share& bounds) {
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
    keep_largest_part();
    for (int cell = 0; cell < count(); ++cell) {
      const Point2 at = centre(cell);
      if (!bounds.contains(at.x_m) || at.x_m > world.length_m || at.y_m > world.depth_m) {
        clearance_[static_cast<std::size_t>(cell)] = 0;
      }
    }
    keep_largest_part();
  }

  [[nodiscard]] int count() const { return columns_ * rows_; }
  [[nodiscard]] Point2 centre(int cell) const {
    return {(cell % columns_ + 0.5) * kCell, (cell / columns_ + 0.5) * kCell};
  }
  [[nodiscard]] double clearance(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }
  [[nodiscard]] bool passable(int cell) const { return clearance(cell) >= kBody; }

  /// The passable cell nearest to a point, within 1.5 m; kNone where there is none.
  [[nodiscard]] int near(Point2 point) const {
    int best = kNone;
    double best2 = 1.5 * 1.5;
    for (int cell = 0; cell < count(); ++cell) {
      const Point2 off = centre(cell) - point;
      const double off2 = off.x_m * off.x_m + off.y_m * off.y_m;
      if (passable(cell) && off2 < best2) {
        best = cell;
        best2 = off2;
      }
    }
    return best;
  }

  /// The cheapest way from a cell to whichever of the marked cells is nearest: without the first, with the last cell;
  /// empty where none can be reached.
  [[nodiscard]] std::vector<int> way_to_nearest(int from, const std::vector<bool>& wanted) const {
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

 private:
  /// visit(cell, length) for the passable ones of the eight cells round about.
  template <typename Visit>
  void for_neighbours(int cell, Visit&& visit) const {
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

  /// The inside of a cupboard, too, is free space, but no robot gets there.
  void keep_largest_part() {
    std::vector<int> part_of(clearance_.size(), kNone);
    std::vector<int> sizes;
    for (int seed = 0; seed < count(); ++seed) {
      if (!passable(seed) || part_of[static_cast<std::size_t>(seed)] != kNone) {
        continue;
      }
      const auto part = static_cast<int>(sizes.size());
      sizes.push_back(0);
      std::vector<int> open = {seed};
      part_of[static_cast<std::size_t>(seed)] = part;
      while (!open.empty()) {
        const int here = open.back();
        open.pop_back();
        ++sizes.back();
        for_neighbours(here, [&](int to, double /*length*/) {
          if (part_of[static_cast<std::size_t>(to)] == kNone) {
            part_of[static_cast<std::size_t>(to)] = part;
            open.push_back(to);
          }
        });
      }
    }
    const auto largest = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    for (std::size_t cell = 0; cell < clearance_.size(); ++cell) {
      if (part_of[cell] != largest) {
        clearance_[cell] = 0;
      }
    }
  }

  /// Lowers the clearance round an obstacle that lies within the box low..high.
  template <typename Obstacle>
  void narrow(Point2 low, Point2 high, const Obstacle& obstacle) {
    const auto index = [](double at_m, int limit) {
      return std::clamp(static_cast<int>(std::floor(at_m / kCell)), 0, limit - 1);
    };
    for (int row = index(low.y_m - kComfort, rows_); row <= index(high.y_m + kComfort, rows_); ++row) {
      for (int column = index(low.x_m - kComfort, columns_); column <= index(high.x_m + kComfort, columns_); ++column) {
        double& clearance = clearance_[static_cast<std::size_t>(row * columns_ + column)];
        clearance = std::min(clearance, distance(obstacle, centre(row * columns_ + column)));
      }
    }
  }

  int columns_ = 0;
  int rows_ = 0;
  std::vector<double> clearance_;
};

/// The way with its corners rounded, one point every step_m.
std::vector<Point2> walked(const std::vector<Point2>& way, double step_m) {
  std::vector<Point2> smooth = way;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    smooth[i] = 0.25 * way[i - 1] + 0.5 * way[i] + 0.25 * way[i + 1];
  }
  std::vector<Point2> points = {smooth.front()};
  double left_m = step_m;  // to the next point
  for (std::size_t i = 1; i < smooth.size(); ++i) {
    Point2 here = smooth[i - 1];
    Point2 span = smooth[i] - here;
    double length_m = std::sqrt(span.x_m * span.x_m + span.y_m * span.y_m);
    while (length_m >= left_m) {
      here = here + left_m / length_m * span;
      points.push_back(here);
      span = smooth[i] - here;
      length_m -= left_m;
      left_m = step_m;
    }
    left_m -= length_m;
  }
  return points;
}

}  // namespace

std::vector<Point2> plan_route(const World& world, const Share& share, const Share& bounds, std::size_t start,
                               double step_m) {
  const Ground ground(world, bounds);
  std::vector<int> stops;
  for (const Point2& place : world.places) {
    const int cell = share.contains(place.x_m) ? ground.near(place) : kNone;
    if (cell != kNone) {
      stops.push_back(cell);
    }
  }
  if (stops.empty()) {
    const auto off = [&](Point2 place) { return std::abs(place.x_m - (share.from_m + share.to_m) / 2); };
    return {*std::min_element(world.places.begin(), world.places.end(),
                              [&](Point2 a, Point2 b) { return off(a) < off(b); })};
  }
  int here = stops[start % stops.size()];
  std::vector<bool> wanted(static_cast<std::size_t>(ground.count()), false);
  for (const int stop : stops) {
    wanted[static_cast<std::size_t>(stop)] = stop != here;
  }
  std::vector<Point2> way = {ground.centre(here)};
  for (std::vector<int> leg = ground.way_to_nearest(here, wanted); !leg.empty();
       leg = ground.way_to_nearest(here, wanted)) {
    for (const int cell : leg) {
      way.push_back(ground.centre(cell));
    }
    here = leg.back();
    wanted[static_cast<std::size_t>(here)] = false;
  }
  return walked(way, step_m);
}

}  // namespace gridmerge::worlds
