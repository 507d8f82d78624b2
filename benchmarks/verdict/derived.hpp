#pragma once
/// Pairs of maps made from pairs with known truth: harder ones, and such that cannot overlap.
#include <cstddef>
#include <optional>
#include <utility>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::verdict_study {

/// The known cells of a map.
struct KnownCells {
  std::size_t count = 0;
  double area_m2 = 0;
  double walls_m = 0;           ///< occupied cells times the resolution
  Point2 centre;                ///< mean of their centres, map frame
  double principal_rad = 0;     ///< heading of the longer axis of their covariance, map frame
  std::size_t fingerprint = 0;  ///< equal for equal cells, wherever their frame lies
};
[[nodiscard]] KnownCells known_cells(const OccupancyGrid& grid);

/// The source without anything within `reach_m` of what the target knows.
[[nodiscard]] OccupancyGrid erase_overlap(const OccupancyGrid& target, OccupancyGrid source,
                                          const Pose2& target_from_source, double reach_m);

/// The parts of a map on both sides of a line across `heading_rad` (map frame), `gap_m` apart. `share` of the known
/// cells lie before the line.
[[nodiscard]] std::pair<OccupancyGrid, OccupancyGrid> split_in_two(const OccupancyGrid& grid, double heading_rad,
                                                                   double share, double gap_m);

/// The map as a mirror along its grid's x axis shows it: like the place, and not the place.
[[nodiscard]] OccupancyGrid mirrored(OccupancyGrid grid);

/// The part of the source beyond a line across `heading_rad` (source's frame), which is laid so that the target knows
/// the share `overlap` of that part. None where no such line leaves 50 m2, 8 m2 of them common, and takes a tenth away.
[[nodiscard]] std::optional<OccupancyGrid> cut_to_overlap(const OccupancyGrid& target, const OccupancyGrid& source,
                                                          const Pose2& target_from_source, double heading_rad,
                                                          double overlap);

}  // namespace gridmerge::verdict_study
