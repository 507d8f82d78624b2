#include "methods/random_walk/manhattan.hpp"

#include <algorithm>

namespace gridmerge {

std::vector<int> manhattan_distances(const MapLevel& level, CellState state) {
  const int none = level.width + level.height;
  std::vector<int> distance(level.state.size());
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      const std::size_t at = level.offset(column, row);
      int nearest = level.state[at] == state ? 0 : none;
      if (column > 0) {
        nearest = std::min(nearest, distance[at - 1] + 1);
      }
      if (row > 0) {
        nearest = std::min(nearest, distance[level.offset(column, row - 1)] + 1);
      }
      distance[at] = nearest;
    }
  }
  for (int row = level.height - 1; row >= 0; --row) {
    for (int column = level.width - 1; column >= 0; --column) {
      const std::size_t at = level.offset(column, row);
      if (column + 1 < level.width) {
        distance[at] = std::min(distance[at], distance[at + 1] + 1);
      }
      if (row + 1 < level.height) {
        distance[at] = std::min(distance[at], distance[level.offset(column, row + 1)] + 1);
      }
    }
  }
  return distance;
}

}  // namespace gridmerge
