#pragma once
/// Where a robot goes that wants to see its share of a world.
#include <vector>

#include "worlds/world.hpp"

namespace gridmerge::worlds {

/// A part of a world, across its whole depth: x in from_m..to_m.
struct Share {
  double from_m = 0;
  double to_m = 0;
  [[nodiscard]] bool contains(double x_m) const { return x_m >= from_m && x_m <= to_m; }
};

/// A walk through free space, one point every `step_m`, past all places of the share that can be reached without
/// leaving `bounds`; always on to the nearest. It starts at the place number `start`, counted round among those of the
/// share. A share without a place gives one point: the place nearest to its middle.
[[nodiscard]] std::vector<Point2> plan_route(const World& world, const Share& share, const Share& bounds,
                                             std::size_t start, double step_m);

}  // namespace gridmerge::worlds
