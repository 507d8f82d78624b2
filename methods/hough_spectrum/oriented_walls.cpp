#include "methods/hough_spectrum/oriented_walls.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "gridmerge/grid/wall_cells.hpp"

namespace gridmerge::hough {
namespace {

/// Sums over the wall points of one cell.
struct CellSum {
  float x = 0;
  float y = 0;
  float count = 0;
  float free_x = 0;
  float free_y = 0;
  float axis_cos = 0;  ///< of the doubled angle: a surface normal has no sign
  float axis_sin = 0;

  void add(const WallPoint& wall) {
    x += wall.at.x_m;
    y += wall.at.y_m;
    count += 1;
    free_x += wall.free_normal.x_m;
    free_y += wall.free_normal.y_m;
    const Point2f& n = wall.surface_normal;
    axis_cos += n.x_m * n.x_m - n.y_m * n.y_m;
    axis_sin += 2 * n.x_m * n.y_m;
  }

  [[nodiscard]] OrientedWall wall(float cells_across) const {
    constexpr float kClear = 0.5F;  // of the longest that each sum could be
    OrientedWall wall{.at = {x / count, y / count}, .weight = std::min(1.0F, count / cells_across)};
    if (std::hypot(axis_cos, axis_sin) < kClear * count) {
      return wall;
    }
    wall.normal_rad = 0.5F * std::atan2(axis_sin, axis_cos);
    const float towards = free_x * std::cos(wall.normal_rad) + free_y * std::sin(wall.normal_rad);
    wall.facing = std::abs(towards) < kClear * count ? Facing::kEither : Facing::kKnown;
    if (towards < 0) {
      wall.normal_rad += static_cast<float>(kPi);
    }
    return wall;
  }
};

}  // namespace

std::vector<OrientedWall> oriented_walls(const PreparedMap& map, const MapLevel& level) {
  const std::vector<CellSum> sums = summed_by_cell<CellSum>(map, level);
  const float cells_across = static_cast<float>(level.resolution_m / map.resolution_m());
  std::vector<OrientedWall> walls(sums.size());
  std::transform(sums.begin(), sums.end(), walls.begin(), [&](const CellSum& sum) { return sum.wall(cells_across); });
  return walls;
}

}  // namespace gridmerge::hough
