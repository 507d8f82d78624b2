#pragma once
/// The dissimilarity Delta of two maps under a pose (seed Eq. 2.5-2.7), made robust for maps that overlap in part.
#include <cstdint>
#include <vector>

#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

struct LockOptions {
  double reach_m = 0.3;
  double c_lock = 1.75;
  double free_weight = 1;

  void describe(OptionList& list);
};

/// What a cell of one map costs a point of the other that falls on it, in units of 1/kFull, for points of value
/// occupied and of value free. Unknown cells cost nothing: only the overlap counts.
struct LockTable {
  static constexpr int kFull = 30;
  const MapLevel* level = nullptr;
  std::vector<std::int8_t> of_wall;  ///< psi of the value occupied, truncated, and c_lock in free space
  std::vector<std::int8_t> of_free;  ///< psi of the value free, truncated

  LockTable(const MapLevel& of_level, const LockOptions& options);
};

/// Delta of poses at one level, lower is better, 0 without overlap: truncated distances to the nearest cell of the same
/// value, summed over the points of both values, both ways. Linear in the number of points. Borrows the maps.
class LockedDistance {
 public:
  /// @param max_points  of each map's walls, and of its free cells, every n-th is used where there are more than this
  LockedDistance(const PreparedMap& target, const PreparedMap& source, int level, const LockOptions& options,
                 std::size_t max_points);

  [[nodiscard]] double operator()(const Pose2& local_target_from_source) const;

 private:
  LockTable target_table_;
  LockTable source_table_;
  std::vector<ThinnedWall> target_walls_;
  std::vector<ThinnedWall> source_walls_;
  std::vector<ThinnedWall> target_free_;
  std::vector<ThinnedWall> source_free_;
};

}  // namespace gridmerge
