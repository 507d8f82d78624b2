/// Draws two maps of one flat, writes and reads one of them, and lets gridmerge find where the second lies in the
/// first.
#include <cmath>
#include <cstdio>

#include "gridmerge/align/pipeline.hpp"
#include "map_server/map_files.hpp"
#include "methods/register_all.hpp"

namespace {

using gridmerge::GridGeometry;
using gridmerge::OccupancyGrid;
using gridmerge::Point2;
using gridmerge::Pose2;

/// A flat of three rooms, 12 m x 8 m, with a cupboard and a column.
std::int8_t flat_at(Point2 p) {
  const auto box = [&](double x0, double y0, double x1, double y1) {
    return p.x_m >= x0 && p.x_m <= x1 && p.y_m >= y0 && p.y_m <= y1;
  };
  if (!box(0, 0, 12, 8)) {
    return gridmerge::kUnknown;
  }
  const bool outer_wall = !box(0.1, 0.1, 11.9, 7.9);
  const bool inner_wall = box(4.5, 0, 4.7, 5.1) || box(4.5, 6.2, 4.7, 8) || box(5.8, 3.2, 12, 3.4);
  const bool thing = box(1.2, 0, 3.1, 0.6) || box(8, 4.6, 8.9, 6) || std::hypot(p.x_m - 9.8, p.y_m - 1.4) < 0.3;
  return outer_wall || inner_wall || thing ? gridmerge::kOccupied : gridmerge::kFree;
}

/// What a robot has seen that knows the flat from x = from_m to to_m only, in its own frame.
OccupancyGrid map_of(const Pose2& flat_from_map, double from_m, double to_m) {
  const GridGeometry geometry = {.width = 340, .height = 340, .resolution_m = 0.05, .map_from_grid = {-8.5, -8.5, 0}};
  OccupancyGrid map = gridmerge::unknown_grid(geometry);
  for (int row = 0; row < geometry.height; ++row) {
    for (int column = 0; column < geometry.width; ++column) {
      const Point2 in_flat = flat_from_map * geometry.cell_centre({column, row});
      if (in_flat.x_m >= from_m && in_flat.x_m <= to_m) {
        map.at({column, row}) = flat_at(in_flat);
      }
    }
  }
  return map;
}

}  // namespace

int main() {
  const Pose2 flat_from_first = {5, 4, 0.2};
  const Pose2 flat_from_second = {7, 3.5, 1.4};
  const OccupancyGrid drawn = map_of(flat_from_first, 0, 10);
  write_map(drawn, "flat.yaml");
  const OccupancyGrid first = gridmerge::read_map("flat.yaml");
  const OccupancyGrid second = map_of(flat_from_second, 2, 12);

  const gridmerge::MethodRegistry methods = gridmerge::all_methods();
  const auto method = methods.entries().front().profiles.front().config()->make();
  const gridmerge::Alignment result = align({first, second, {}}, *method, {}, {});
  std::printf("%s, confidence %.2f: %s\n", to_string(result.outcome).c_str(), result.confidence,
              result.reasons.front().c_str());
  if (first.cells != drawn.cells || result.hypotheses.empty()) {
    return 1;
  }
  const Pose2 truth = inverse(flat_from_first) * flat_from_second;
  const Pose2 found = result.hypotheses.front().target_from_source.pose;
  std::printf("found %.3f %.3f %.3f, truth %.3f %.3f %.3f\n", found.x_m, found.y_m, found.theta_rad, truth.x_m,
              truth.y_m, truth.theta_rad);
  const auto error = gridmerge::difference_at({}, found, truth);
  return error.distance_m < 0.1 && error.angle_rad < gridmerge::radians(1) ? 0 : 1;
}
