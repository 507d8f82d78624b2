#pragma once
/// Walls as a Hough transform wants them: one point a stretch of wall, with the direction it faces.
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge::hough {

/// What is known of the way a stretch of wall faces.
enum class Facing {
  kKnown,   ///< it was seen from the side that the normal points to
  kEither,  ///< it lies across the normal, seen from either side or from both
  kUnclear  ///< a corner, a post, a speck: no normal at all
};

struct OrientedWall {
  Point2f at;            ///< local frame of the map
  float normal_rad = 0;  ///< of the direction across the wall
  float weight = 0;      ///< 1 where a wall crosses the whole cell; less for a speck
  Facing facing = Facing::kUnclear;
};

/// One for every cell of the level that holds walls: a thick wall then counts no more than a thin one.
[[nodiscard]] std::vector<OrientedWall> oriented_walls(const PreparedMap& map, const MapLevel& level);

}  // namespace gridmerge::hough
