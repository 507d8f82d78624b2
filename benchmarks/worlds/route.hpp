#pragma once
/// Where a robot goes that wants to see its share of a world.
#include <vector>

#include "worlds/ground.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

/// A walk through free space, one point every `step_m`, past all places of the share that can be reached without
/// leaving `bounds`; always on to the nearest. It starts at the place number `start`, counted round among those of the
/// share. A share without a place gives one point: the place nearest to its middle.
[[nodiscard]] std::vector<Point2> plan_route(const World& world, const Share& share, const Share& bounds,
                                             std::size_t start, double step_m);

/// The same from the spot nearest to `from`, past the places given; only `from` where no spot is free.
[[nodiscard]] std::vector<Point2> plan_tour(const Ground& ground, Point2 from, const std::vector<Point2>& places,
                                            double step_m);

/// The places of a world that lie in a share of it.
[[nodiscard]] std::vector<Point2> places_in(const World& world, const Share& share);

}  // namespace gridmerge::worlds
