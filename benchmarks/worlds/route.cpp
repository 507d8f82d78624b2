#include "worlds/route.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::worlds {
namespace {

/// The way with its corners rounded, one point every step_m.
std::vector<Point2> walked(const std::vector<Point2>& way, double step_m) {
  std::vector<Point2> smooth = way;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    smooth[i] = 0.25 * way[i - 1] + 0.5 * way[i] + 0.25 * way[i + 1];
  }
  std::vector<Point2> points = {smooth.front()};
  double left_m = step_m;  // to the next point
  for (std::size_t i = 1; i < smooth.size(); ++i) {
    Point2 here = smooth[i - 1];
    Point2 span = smooth[i] - here;
    double length_m = std::sqrt(span.x_m * span.x_m + span.y_m * span.y_m);
    while (length_m >= left_m) {
      here = here + left_m / length_m * span;
      points.push_back(here);
      span = smooth[i] - here;
      length_m -= left_m;
      left_m = step_m;
    }
    left_m -= length_m;
  }
  return points;
}

/// Past all stops, always on to the nearest.
std::vector<Point2> tour(const Ground& ground, int from, const std::vector<int>& stops, double step_m) {
  std::vector<bool> wanted(static_cast<std::size_t>(ground.count()), false);
  for (const int stop : stops) {
    wanted[static_cast<std::size_t>(stop)] = stop != from;
  }
  int here = from;
  std::vector<Point2> way = {ground.centre(here)};
  for (std::vector<int> leg = ground.way_to_nearest(here, wanted); !leg.empty();
       leg = ground.way_to_nearest(here, wanted)) {
    for (const int cell : leg) {
      way.push_back(ground.centre(cell));
    }
    here = leg.back();
    wanted[static_cast<std::size_t>(here)] = false;
  }
  return walked(way, step_m);
}

std::vector<int> stops_at(const Ground& ground, const std::vector<Point2>& places) {
  std::vector<int> stops;
  for (const Point2& place : places) {
    const int cell = ground.near(place);
    if (cell != Ground::kNone) {
      stops.push_back(cell);
    }
  }
  return stops;
}

}  // namespace

std::vector<Point2> places_in(const World& world, const Share& share) {
  std::vector<Point2> places;
  const double spacing_m = world.length_m / static_cast<double>(std::max<std::size_t>(1, world.places.size() - 1));
  for (std::size_t i = 0; i < world.places.size(); ++i) {
    if (share.contains(world.winding ? static_cast<double>(i) * spacing_m : world.places[i].x_m)) {
      places.push_back(world.places[i]);
    }
  }
  return places;
}

std::vector<Point2> plan_route(const World& world, const Share& share, const Share& bounds, std::size_t start,
                               double step_m) {
  const Ground ground(world, bounds);
  const std::vector<int> stops = stops_at(ground, places_in(world, share));
  if (stops.empty()) {
    const auto off = [&](Point2 place) { return std::abs(place.x_m - (share.from_m + share.to_m) / 2); };
    return {*std::min_element(world.places.begin(), world.places.end(),
                              [&](Point2 a, Point2 b) { return off(a) < off(b); })};
  }
  return tour(ground, stops[start % stops.size()], stops, step_m);
}

std::vector<Point2> plan_tour(const Ground& ground, Point2 from, const std::vector<Point2>& places, double step_m) {
  constexpr double kAnywhere = 1e4;  // [m]
  const int start = ground.near(from, kAnywhere);
  return start == Ground::kNone ? std::vector<Point2>{from} : tour(ground, start, stops_at(ground, places), step_m);
}

}  // namespace gridmerge::worlds
