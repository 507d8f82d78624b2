#pragma once
/// The walls of a map, gathered by the cells of one of its levels.
#include <cstdint>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// One Sum for every cell of the level that holds walls, in the order in which the map's walls first meet it. A Sum is
/// made empty and has `add(const WallPoint&)`.
template <typename Sum>
[[nodiscard]] std::vector<Sum> summed_by_cell(const PreparedMap& map, const MapLevel& level) {
  std::vector<std::int32_t> slot(level.state.size(), -1);
  std::vector<Sum> sums;
  for (const WallPoint& wall : map.walls()) {
    const auto [column, row] = level.cell_at(wall.at);
    std::int32_t& index = slot[level.offset(column, row)];
    if (index < 0) {
      index = static_cast<std::int32_t>(sums.size());
      sums.emplace_back();
    }
    sums[static_cast<std::size_t>(index)].add(wall);
  }
  return sums;
}

}  // namespace gridmerge
