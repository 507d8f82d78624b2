#pragma once
/// The fitness of Li & Nashashibi 2013: how many occupied cells of one map fall on occupied cells of the other.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// F(M1, p + M2) of Eq. 3.5 and 3.6, at the maps' finest level. What is occupied is what PreparedMap says.
///
/// Holds copies of what it needs, so the maps may go. Const, so shared by any number of threads. A call takes time in
/// proportion to cell_count(), whatever the pose (benchmarks/micro).
class HitFitness {
 public:
  HitFitness(const PreparedMap& target, const PreparedMap& source);

  /// Sum over the source's occupied cells of the target's occupancy [%] where that cell is occupied too, else 0.
  /// On maps that know only 0 and 100 it is 100 for each cell hit.
  /// @param target_from_source  between the map frames; a cell moved by it counts where its centre falls
  [[nodiscard]] std::int64_t operator()(const Pose2& target_from_source) const;

  /// Occupied cells of the source.
  [[nodiscard]] std::size_t cell_count() const { return cell_count_; }

 private:
  Pose2 target_local_from_map_;
  Pose2 source_map_from_local_;
  double cells_per_m_;
  Point2 lower_left_;  ///< of the table, in the target's local frame
  std::uint32_t width_;
  std::uint32_t height_;
  std::vector<std::uint8_t> table_;  ///< the target's occupancy [%] where it is occupied, else 0
  std::vector<float> x_cells_;       ///< the source's occupied cells, local frame, filled up to whole blocks
  std::vector<float> y_cells_;
  std::size_t cell_count_;
};

}  // namespace gridmerge
