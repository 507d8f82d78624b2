#pragma once
/// Sub-cell refinement of a pose on the distance fields of both maps, with its covariance.
#include <cstdint>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/covariance.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

struct RefineOptions {
  double reach_m = 0.4;
  double scale_m = 0.12;
  int max_iterations = 12;
  int max_points = 1500;
  double independent_m = 2;

  void describe(OptionList& list);
};

/// Refines poses of one pair of maps. Const and thread safe after construction; borrows the maps.
///
/// Minimises, over the pose, the sum over the wall points of both maps of a bounded (Geman-McClure) function of their
/// distance to the nearest wall of the other map, read bilinearly from its distance field (Ceres, Levenberg-Marquardt).
/// A point that has walls of the other map about it at the start, but none seen from its own side, is left out: it lies
/// on the other face of the wall, and would pull the two faces together.
///
/// The covariance is that of the walls which found a partner, counted as independent once every `independent_m`. Along
/// a direction that the walls do not fix (a bare corridor) it is large: 10 m and pi at the most.
class Refiner {
 public:
  /// @throws std::invalid_argument listing every option out of range
  Refiner(const PreparedMap& target, const PreparedMap& source, RefineOptions options);

  /// @param target_from_source  between the map frames; must be good to about reach_m
  /// @return the better pose; the given one without a covariance where fewer than three walls find a partner
  [[nodiscard]] PoseEstimate operator()(const Pose2& target_from_source) const;

 private:
  const PreparedMap& target_;
  const PreparedMap& source_;
  RefineOptions options_;
  std::vector<std::uint8_t> target_sides_;  ///< sides_within kSideReach
  std::vector<std::uint8_t> source_sides_;
};

/// A Refiner used once.
[[nodiscard]] PoseEstimate refine(const PreparedMap& target, const PreparedMap& source, const Pose2& target_from_source,
                                  const RefineOptions& options);

}  // namespace gridmerge
