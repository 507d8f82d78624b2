#include "gridmerge/judge/sided_map.hpp"

#include <algorithm>

#include "gridmerge/grid/pieces.hpp"
#include "gridmerge/judge/meeting_cells.hpp"

namespace gridmerge {

namespace {

Piece piece_of(float width_m) {
  constexpr float kLegs = 0.4F;
  constexpr float kFurniture = 2;
  constexpr float kFittings = 4;
  return width_m < kLegs        ? Piece::kLegs
         : width_m < kFurniture ? Piece::kFurniture
         : width_m < kFittings  ? Piece::kFittings
                                : Piece::kWall;
}

}  // namespace

SidedMap sided_map(const PreparedMap& map, double tolerance_m, int max_points) {
  SidedMap sided;
  sided.map = &map;
  const std::vector<WallSide> sides = wall_sides(map);
  const MapLevel& level = map.level(0);
  sided.cells.resize(level.state.size());
  const double clear_m = tolerance_m + level.resolution_m;
  const double far_m = std::max(clear_m, 3 * tolerance_m);
  for (int row = 0; row < level.height; ++row) {
    mark_free(level, row, static_cast<float>(clear_m), static_cast<float>(far_m), &sided.cells[level.offset(0, row)]);
  }
  add_sides_within(map, sides, tolerance_m, sided.cells);
  sided.ground = PatchGround(map, sides, 0.5 * tolerance_m);
  const auto limit = static_cast<std::size_t>(max_points);
  const std::size_t step = std::max<std::size_t>(1, (map.walls().size() + limit - 1) / limit);
  sided.metres_a_wall = static_cast<double>(step) * map.level(0).resolution_m;
  const std::vector<float> widths_m = piece_widths_m(map);
  for (std::size_t i = 0; i < map.walls().size(); i += step) {
    sided.walls.push_back({map.walls()[i].at, sides[i], piece_of(widths_m[i])});
  }
  sided.patches = cut_in_patches(sided.walls, sided.metres_a_wall);
  return sided;
}

}  // namespace gridmerge
