#include "methods/random_walk/map_distance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "methods/random_walk/manhattan.hpp"

namespace gridmerge {
namespace {

/// A cell, perhaps outside the map.
struct Cell {
  int column;
  int row;
};

/// From points of one map to cells of the other.
class CellOf {
 public:
  CellOf(const MapLevel& level, const Pose2& level_from_points)
      : scale_(1 / level.resolution_m),
        c_(std::cos(level_from_points.theta_rad) * scale_),
        s_(std::sin(level_from_points.theta_rad) * scale_),
        x_((level_from_points.x_m - level.lower_left.x_m) * scale_),
        y_((level_from_points.y_m - level.lower_left.y_m) * scale_) {}

  [[nodiscard]] Cell operator()(Point2f point) const {
    const auto x = static_cast<double>(point.x_m);
    const auto y = static_cast<double>(point.y_m);
    return {cell(c_ * x - s_ * y + x_), cell(s_ * x + c_ * y + y_)};
  }

 private:
  static int cell(double coordinate) { return static_cast<int>(std::floor(std::clamp(coordinate, -1e8, 1e8))); }

  double scale_;
  double c_;
  double s_;
  double x_;
  double y_;
};

}  // namespace

MapDistance::Side::Side(const MapLevel& of_level)
    : level(&of_level),
      to_wall_cells(manhattan_distances(of_level, CellState::kWall)),
      to_open_cells(manhattan_distances(of_level, CellState::kOpen)) {
  for (int row = 0; row < of_level.height; ++row) {
    for (int column = 0; column < of_level.width; ++column) {
      const CellState state = of_level.state[of_level.offset(column, row)];
      if (state != CellState::kUnseen) {
        (state == CellState::kWall ? walls : open)
            .push_back({static_cast<float>(of_level.lower_left.x_m + (column + 0.5) * of_level.resolution_m),
                        static_cast<float>(of_level.lower_left.y_m + (row + 0.5) * of_level.resolution_m)});
      }
    }
  }
}

MapDistance::MapDistance(const PreparedMap& target, const PreparedMap& source, int level)
    : target_(target.level(level)), source_(source.level(level)) {}

double MapDistance::mean_distance(const std::vector<Point2f>& points, const MapLevel& other,
                                  const std::vector<int>& to_cells, const Pose2& other_from_points) {
  if (points.empty()) {
    return 0;
  }
  const CellOf cell_of(other, other_from_points);
  double sum = 0;
  for (const Point2f point : points) {
    // Outside the map, the Manhattan distance is that to the nearest cell of the rim, and on from there.
    const Cell cell = cell_of(point);
    const int column = std::clamp(cell.column, 0, other.width - 1);
    const int row = std::clamp(cell.row, 0, other.height - 1);
    sum += to_cells[other.offset(column, row)] + std::abs(cell.column - column) + std::abs(cell.row - row);
  }
  return sum / static_cast<double>(points.size());
}

Dissimilarity MapDistance::operator()(const Pose2& local_target_from_source) const {
  const Pose2 back = inverse(local_target_from_source);
  Dissimilarity found;
  found.psi_cells = mean_distance(source_.walls, *target_.level, target_.to_wall_cells, local_target_from_source) +
                    mean_distance(target_.walls, *source_.level, source_.to_wall_cells, back) +
                    mean_distance(source_.open, *target_.level, target_.to_open_cells, local_target_from_source) +
                    mean_distance(target_.open, *source_.level, source_.to_open_cells, back);
  const CellOf cell_of(*target_.level, local_target_from_source);
  const auto count = [&](const std::vector<Point2f>& points, CellState value) {
    for (const Point2f point : points) {
      const Cell cell = cell_of(point);
      if (target_.level->contains(cell.column, cell.row)) {
        const CellState there = target_.level->state[target_.level->offset(cell.column, cell.row)];
        found.agree += there == value ? 1 : 0;
        found.disagree += there != value && there != CellState::kUnseen ? 1 : 0;
      }
    }
  };
  count(source_.walls, CellState::kWall);
  count(source_.open, CellState::kOpen);
  return found;
}

}  // namespace gridmerge
