#pragma once
/// Places drawn without noise, as a perfect robot would map them: what is wrong with an answer is then the answer's own
/// fault.
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

enum class Place {
  kFlat,      ///< three rooms with a cupboard, a table and a column: 12 m x 8 m
  kCorridor,  ///< two bare walls along x, 2 m apart, without an end
};

/// What a robot has mapped, and in which frame.
struct PlacedView {
  Pose2 place_from_map;
  double resolution_m = 0.05;
  double origin_yaw_rad = 0;
  double from_x_m = 0;  ///< of the place, only this stretch has been seen
  double to_x_m = 12;
};

[[nodiscard]] OccupancyGrid drawn(Place place, const PlacedView& view);

/// The truth about two views of one place.
[[nodiscard]] inline Pose2 target_from_source(const PlacedView& target, const PlacedView& source) {
  return inverse(target.place_from_map) * source.place_from_map;
}

}  // namespace gridmerge
