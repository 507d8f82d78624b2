#include "gridmerge/judge/sided_map.hpp"

#include "gridmerge/grid/pieces.hpp"

namespace gridmerge {

SidedMap sided_map(const PreparedMap& map, double tolerance_m, int max_points) {
  constexpr double kSmall = 2;  // [m]
  SidedMap sided;
  sided.map = &map;
  sided.seen_from = sides_within(map, tolerance_m);
  sided.seen_from_near = sides_within(map, 0.5 * tolerance_m);
  const auto limit = static_cast<std::size_t>(max_points);
  const std::size_t step = std::max<std::size_t>(1, (map.walls().size() + limit - 1) / limit);
  sided.metres_a_wall = static_cast<double>(step) * map.level(0).resolution_m;
  const std::vector<bool> small = in_small_pieces(map, kSmall);
  for (std::size_t i = 0; i < map.walls().size(); i += step) {
    sided.walls.push_back({map.walls()[i].at, WallSide(map.walls()[i]), small[i]});
  }
  return sided;
}

}  // namespace gridmerge
