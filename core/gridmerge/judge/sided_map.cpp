#include "gridmerge/judge/sided_map.hpp"

#include "gridmerge/grid/pieces.hpp"

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

std::vector<std::uint8_t> clear_of_walls(const MapLevel& level, double distance_m) {
  const auto clear_m = static_cast<float>(distance_m + level.resolution_m);
  std::vector<std::uint8_t> clear(level.state.size());
  for (std::size_t i = 0; i < clear.size(); ++i) {
    clear[i] = level.state[i] == CellState::kOpen && level.wall_distance_m[i] > clear_m ? 1 : 0;
  }
  return clear;
}

}  // namespace

SidedMap sided_map(const PreparedMap& map, double tolerance_m, int max_points) {
  SidedMap sided;
  sided.map = &map;
  const std::vector<WallSide> sides = wall_sides(map);
  sided.seen_from = sides_within(map, sides, tolerance_m);
  sided.seen_from_near = sides_within(map, sides, 0.5 * tolerance_m);
  sided.clear_of_near = clear_of_walls(map.level(0), 0.5 * tolerance_m);
  const auto limit = static_cast<std::size_t>(max_points);
  const std::size_t step = std::max<std::size_t>(1, (map.walls().size() + limit - 1) / limit);
  sided.metres_a_wall = static_cast<double>(step) * map.level(0).resolution_m;
  const std::vector<float> widths_m = piece_widths_m(map);
  for (std::size_t i = 0; i < map.walls().size(); i += step) {
    sided.walls.push_back({map.walls()[i].at, sides[i], piece_of(widths_m[i])});
  }
  return sided;
}

}  // namespace gridmerge
