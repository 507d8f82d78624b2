#pragma once
/// Where in a world a robot can be: the plane in cells, with what stands in the way.
#include <optional>
#include <utility>
#include <vector>

#include "worlds/world.hpp"

namespace gridmerge::worlds {

/// A part of a world, across its whole depth: x in from_m..to_m.
struct Share {
  double from_m = 0;
  double to_m = 0;
  [[nodiscard]] bool contains(double x_m) const { return x_m >= from_m && x_m <= to_m; }
};

/// The world within its bounds as a grid of cells with their distance to the nearest obstacle. Of the free space only
/// the largest connected part counts: the inside of a cupboard is free, too, but no robot gets there.
class Ground {
 public:
  static constexpr int kNone = -1;

  Ground(const World& world, const Share& bounds);

  [[nodiscard]] int count() const { return columns_ * rows_; }
  [[nodiscard]] Point2 centre(int cell) const;
  [[nodiscard]] bool passable(int cell) const;

  /// The passable cell nearest to a point, within that distance; kNone where there is none.
  [[nodiscard]] int near(Point2 point, double within_m = 1.5) const;

  /// The passable cells between two distances from a point, row by row.
  [[nodiscard]] std::vector<int> ring(Point2 point, double from_m, double to_m) const;

  /// The cheapest way from a cell to whichever of the marked cells is nearest: without the first, with the last cell;
  /// empty where none can be reached. Ways along obstacles cost more.
  [[nodiscard]] std::vector<int> way_to_nearest(int from, const std::vector<bool>& wanted) const;

 private:
  [[nodiscard]] double clearance(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }
  template <typename Visit>
  void for_neighbours(int cell, Visit&& visit) const;
  template <typename Visit>
  void for_cells_about(Point2 low, Point2 high, double reach_m, Visit&& visit) const;
  template <typename Obstacle>
  void narrow(Point2 low, Point2 high, const Obstacle& obstacle);
  void mark_connected(int seed, int part, std::vector<int>& part_of) const;
  void fill_rock(const std::vector<Point2>& places);
  void keep_largest_part();

  int columns_ = 0;
  int rows_ = 0;
  std::vector<double> clearance_;  // [m] up to where it no longer matters
};

}  // namespace gridmerge::worlds
