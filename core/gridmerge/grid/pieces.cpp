#include "gridmerge/grid/pieces.hpp"

#include <algorithm>
#include <cstdint>

#include "gridmerge/base/disjoint_sets.hpp"

namespace gridmerge {
namespace {

std::vector<CellIndex> cells_of_walls(const PreparedMap& map) {
  std::vector<CellIndex> cells;
  cells.reserve(map.walls().size());
  for (const WallPoint& wall : map.walls()) {
    cells.push_back(map.level(0).cell_at(wall.at));
  }
  return cells;
}

/// Joins the walls whose cells touch. They come row by row, so a wall's neighbours are the one before it and up to
/// three of the row below: `below` runs along with it.
DisjointSets touching(const std::vector<CellIndex>& cells) {
  DisjointSets pieces(cells.size());
  std::uint32_t below = 0;
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const auto [column, row] = cells[i];
    if (i > 0 && cells[i - 1].row == row && cells[i - 1].column == column - 1) {
      pieces.unite(i - 1, i);
    }
    const auto is_before = [&](CellIndex other) {
      return other.row < row - 1 || (other.row == row - 1 && other.column < column - 1);
    };
    while (below < i && is_before(cells[below])) {
      ++below;
    }
    for (std::uint32_t j = below; j < i && cells[j].row == row - 1 && cells[j].column <= column + 1; ++j) {
      pieces.unite(j, i);
    }
  }
  return pieces;
}

}  // namespace

std::vector<float> piece_widths_m(const PreparedMap& map) {
  struct Box {
    CellIndex low;
    CellIndex high;
  };
  const std::vector<CellIndex> cells = cells_of_walls(map);
  DisjointSets pieces = touching(cells);
  std::vector<Box> boxes(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const std::uint32_t first = pieces.name_of(i);
    if (first == i) {
      boxes[i] = {cells[i], cells[i]};
      continue;
    }
    Box& box = boxes[first];
    box.low = {std::min(box.low.column, cells[i].column), std::min(box.low.row, cells[i].row)};
    box.high = {std::max(box.high.column, cells[i].column), std::max(box.high.row, cells[i].row)};
  }
  std::vector<float> widths_m(cells.size());
  for (std::uint32_t i = 0; i < cells.size(); ++i) {
    const Box& box = boxes[pieces.name_of(i)];
    const int widest = std::max(box.high.column - box.low.column, box.high.row - box.low.row) + 1;
    widths_m[i] = static_cast<float>(widest * map.resolution_m());
  }
  return widths_m;
}

}  // namespace gridmerge
