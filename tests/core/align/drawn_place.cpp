#include "core/align/drawn_place.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {
namespace {

struct Box {
  double low_x, low_y, high_x, high_y;
  [[nodiscard]] bool contains(Point2 p) const {
    return p.x_m >= low_x && p.x_m <= high_x && p.y_m >= low_y && p.y_m <= high_y;
  }
};

constexpr double kFlatDepth = 8;
constexpr double kCorridorDepth = 2.2;

std::int8_t flat_at(Point2 p) {
  if (!Box{0, 0, 12, kFlatDepth}.contains(p)) {
    return kUnknown;
  }
  const bool outer_wall = !Box{0.1, 0.1, 11.9, 7.9}.contains(p);
  const bool inner_wall =
      Box{4.5, 0, 4.6, 5.1}.contains(p) || Box{4.5, 6.2, 4.6, 8}.contains(p) || Box{5.8, 3.2, 12, 3.3}.contains(p);
  const bool cupboard = Box{1.2, 0, 3.1, 0.6}.contains(p);
  const bool table = Box{8, 4.6, 8.9, 6}.contains(p);
  const bool column = std::hypot(p.x_m - 9.8, p.y_m - 1.4) < 0.3;
  return outer_wall || inner_wall || cupboard || table || column ? kOccupied : kFree;
}

std::int8_t corridor_at(Point2 p) {
  if (p.y_m < 0 || p.y_m > kCorridorDepth) {
    return kUnknown;
  }
  return p.y_m < 0.1 || p.y_m > kCorridorDepth - 0.1 ? kOccupied : kFree;
}

}  // namespace

OccupancyGrid drawn(Place place, const PlacedView& view) {
  const double depth_m = place == Place::kFlat ? kFlatDepth : kCorridorDepth;
  const Pose2 grid_from_place = Pose2{0, 0, -view.origin_yaw_rad} * inverse(view.place_from_map);
  Point2 low = grid_from_place * Point2{view.from_x_m, 0};
  Point2 high = low;
  for (const Point2& corner : {Point2{view.to_x_m, 0}, Point2{view.from_x_m, depth_m}, Point2{view.to_x_m, depth_m}}) {
    const Point2 at = grid_from_place * corner;
    low = {std::min(low.x_m, at.x_m), std::min(low.y_m, at.y_m)};
    high = {std::max(high.x_m, at.x_m), std::max(high.y_m, at.y_m)};
  }
  const auto cells = [&](double length_m) { return static_cast<int>(std::ceil(length_m / view.resolution_m)) + 2; };
  OccupancyGrid grid =
      unknown_grid({.width = cells(high.x_m - low.x_m),
                    .height = cells(high.y_m - low.y_m),
                    .resolution_m = view.resolution_m,
                    .map_from_grid = Pose2{0, 0, view.origin_yaw_rad} *
                                     Pose2{low.x_m - view.resolution_m, low.y_m - view.resolution_m, 0}});
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      const Point2 at = view.place_from_map * grid.geometry.cell_centre({column, row});
      if (at.x_m >= view.from_x_m && at.x_m <= view.to_x_m) {
        grid.at({column, row}) = place == Place::kFlat ? flat_at(at) : corridor_at(at);
      }
    }
  }
  return grid;
}

}  // namespace gridmerge
