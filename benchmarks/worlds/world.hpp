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
  bool rock = false;           ///< free space where no place is lies within rock: nobody gets there
  bool winding = false;        ///< the places are in order along the one way there is: shares count along it, not x
};

/// "office", "maze", ...: what make_world knows.
[[nodiscard]] std::vector<std::string> world_kinds();

/// Whether worlds of a kind can be had in another length, and how long they are as they come.
/// @throws std::invalid_argument for an unknown kind
[[nodiscard]] bool world_grows(std::string_view kind);
/// Whether its worlds have furniture, that may be rearranged.
[[nodiscard]] bool world_is_furnished(std::string_view kind);
[[nodiscard]] double usual_length_m(std::string_view kind);

struct WorldVariant {
  double length_m = 0;  ///< 0: the kind's own; others only where the kind grows. The depth goes with it.
  int storey = 0;       ///< of `floors`: the same walls, other furniture
  /// Of kinds with furniture: this share of it is moved within its room, or taken away.
  double rearranged_share = 0;
  bool cleared = false;  ///< of all furniture
};

/// The same world for the same kind, seed and variant, on every machine.
/// @throws std::invalid_argument for an unknown kind
[[nodiscard]] World make_world(std::string_view kind, std::uint64_t seed, const WorldVariant& variant = {});

/// The world seen in a mirror that stands along its x axis: like the world, and not the world.
[[nodiscard]] World mirrored(World world);

}  // namespace gridmerge::worlds
