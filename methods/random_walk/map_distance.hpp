#pragma once
/// The dissimilarity Delta of two maps under a pose, as published (seed Eq. 2.5-2.7).
#include <cstddef>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// The two parts of Delta at one pose.
struct Dissimilarity {
  double psi_cells = 0;         ///< Eq. 2.6, never negative
  std::ptrdiff_t agree = 0;     ///< cells known and equal in both maps
  std::ptrdiff_t disagree = 0;  ///< cells known and unequal

  /// Eq. 2.5, lower is better.
  [[nodiscard]] double delta(double c_lock) const { return psi_cells + c_lock * static_cast<double>(disagree - agree); }
};

/// Delta at the maps' finest level, over every known cell. A call takes time in proportion to their number: the
/// distance maps are made once, each in its own map, and distances are measured along that map's axes. Borrows the
/// maps.
class MapDistance {
 public:
  MapDistance(const PreparedMap& target, const PreparedMap& source, int level = 0);

  [[nodiscard]] Dissimilarity operator()(const Pose2& local_target_from_source) const;

 private:
  /// One map: where its cells of each value are, and how far every place is from them.
  struct Side {
    const MapLevel* level = nullptr;
    std::vector<Point2f> walls;
    std::vector<Point2f> open;
    std::vector<int> to_wall_cells;
    std::vector<int> to_open_cells;

    explicit Side(const MapLevel& of_level);
  };

  /// d(M1, M2, c) of Eq. 2.7: the mean over points of one map of the distances in the other.
  [[nodiscard]] static double mean_distance(const std::vector<Point2f>& points, const MapLevel& other,
                                            const std::vector<int>& to_cells, const Pose2& other_from_points);

  Side target_;
  Side source_;
};

}  // namespace gridmerge
