#pragma once
/// Places that do not exist: walls and trunks in the plane, drawn from a seed.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge::worlds {

/// A face that stops a ray, from either side.
struct Segment {
  Point2 from;
  Point2 to;
};

struct Disc {
  Point2 centre;
  double radius_m = 0;
};

/// In the world frame: x in 0..length_m, y in 0..depth_m.
struct World {
  double length_m = 0;
  double depth_m = 0;
  std::vector<Segment> walls;
  std::vector<Disc> discs;
  std::vector<Point2> places;  ///< worth a visit: a robot that has been to all of them has seen the world
};

/// "office", "maze", ...: what make_world knows.
[[nodiscard]] std::vector<std::string> world_kinds();

/// The same world for the same kind and seed, on every machine.
/// @throws std::invalid_argument for an unknown kind
[[nodiscard]] World make_world(std::string_view kind, std::uint64_t seed);

/// The world seen in a mirror that stands along its x axis: like the world, and not the world.
[[nodiscard]] World mirrored(World world);

}  // namespace gridmerge::worlds
