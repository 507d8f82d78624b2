#include "methods/som/self_organising_map.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::som {
namespace {

std::vector<Point2f> first_neurons(std::span<const Point2f> points, std::size_t neurons, RandomStream& random) {
  std::vector<Point2f> chain;
  for (std::size_t i = 0; i < neurons; ++i) {
    chain.push_back(points[random.below(static_cast<std::uint32_t>(points.size()))]);
  }
  const auto [left, right] =
      std::minmax_element(points.begin(), points.end(), [](Point2f a, Point2f b) { return a.x_m < b.x_m; });
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [](Point2f a, Point2f b) { return a.y_m < b.y_m; });
  const bool upright = high->y_m - low->y_m > right->x_m - left->x_m;
  std::stable_sort(chain.begin(), chain.end(),
                   [&](Point2f a, Point2f b) { return upright ? a.y_m < b.y_m : a.x_m < b.x_m; });
  return chain;
}

double geometric(double first, double last, double share) { return first * std::pow(last / first, share); }

}  // namespace

std::size_t best_matching_unit(std::span<const Point2f> neurons, Point2f point) {
  const auto distance2 = [&](Point2f neuron) {
    const float dx = neuron.x_m - point.x_m;
    const float dy = neuron.y_m - point.y_m;
    return dx * dx + dy * dy;
  };
  const auto nearest = std::min_element(neurons.begin(), neurons.end(),
                                        [&](Point2f a, Point2f b) { return distance2(a) < distance2(b); });
  return static_cast<std::size_t>(nearest - neurons.begin());
}

std::vector<Point2f> trained_chain(std::span<const Point2f> points, std::size_t neurons, const KohonenOptions& options,
                                   RandomStream& random) {
  std::vector<Point2f> chain = first_neurons(points, neurons, random);
  const std::size_t presentations = points.size() * static_cast<std::size_t>(options.epochs);
  for (std::size_t t = 0; t < presentations; ++t) {
    const double share = static_cast<double>(t) / static_cast<double>(presentations);
    const double rate = geometric(options.first_rate, options.last_rate, share);
    const double radius = geometric(options.first_radius, options.last_radius, share);
    const Point2f point = points[random.below(static_cast<std::uint32_t>(points.size()))];
    const auto winner = static_cast<int>(best_matching_unit(chain, point));
    const int reach = static_cast<int>(3 * radius);
    for (int k = std::max(0, winner - reach); k <= std::min(static_cast<int>(neurons) - 1, winner + reach); ++k) {
      const double off = (k - winner) / radius;
      const auto pull = static_cast<float>(rate * std::exp(-0.5 * off * off));
      Point2f& neuron = chain[static_cast<std::size_t>(k)];
      neuron = {neuron.x_m + pull * (point.x_m - neuron.x_m), neuron.y_m + pull * (point.y_m - neuron.y_m)};
    }
  }
  return chain;
}

}  // namespace gridmerge::som
