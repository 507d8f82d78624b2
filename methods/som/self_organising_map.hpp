#pragma once
/// Kohonen's self-organising map of the plane, on-line, as the paper uses it: a chain of neurons learns points.
#include <span>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge::som {

struct KohonenOptions {
  int epochs = 10;          ///< in each, every point is presented once on average
  double first_rate = 0.5;  ///< share of the way to the point that the winner goes, at first
  double last_rate = 0.02;  ///< at last; in between it falls geometrically, as the radius does
  double first_radius = 2;  ///< of the neighbourhood, in neurons along the chain
  double last_radius = 0.3;
};

/// Trains a chain of `neurons` on points in random order: the winner (the nearest neuron) moves towards the point, its
/// neighbours along the chain by less. Begins with neurons on points drawn at random, ordered along the longer axis.
/// @param points  at least one
/// @param neurons  at least one
[[nodiscard]] std::vector<Point2f> trained_chain(std::span<const Point2f> points, std::size_t neurons,
                                                 const KohonenOptions& options, RandomStream& random);

/// The index of the nearest neuron.
[[nodiscard]] std::size_t best_matching_unit(std::span<const Point2f> neurons, Point2f point);

}  // namespace gridmerge::som
