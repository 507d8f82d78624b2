#include "gridmerge/grid/pieces.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace gridmerge {
namespace {

struct Cell {
  int column = 0;
  int row = 0;
};

std::vector<Cell> cells_of_walls(const PreparedMap& map) {
  const MapLevel& level = map.level(0);
  std::vector<Cell> cells;
  cells.reserve(map.walls().size());
  for (const WallPoint& wall : map.walls()) {
    cells.push_back({static_cast<int>((wall.at.x_m - level.lower_left.x_m) / level.resolution_m),
                     static_cast<int>((wall.at.y_m - level.lower_left.y_m) / level.resolution_m)});
  }
  return cells;
}

/// Which walls hang together, as trees: each names another of its piece, the one at the root itself.
class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  [[nodiscard]] std::size_t root(std::size_t i) {
    while (parent_[i] != i) {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t low = root(a);
    const std::size_t high = root(b);
    parent_[std::max(low, high)] = static_cast<std::uint32_t>(std::min(low, high));
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Joins the walls whose cells touch. They come row by row, so a wall's neighbours are the one before it and up to
/// three of the row below: `below` runs along with it.
Forest touching(const std::vector<Cell>& cells) {
  Forest forest(cells.size());
  std::size_t below = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto [column, row] = cells[i];
    if (i > 0 && cells[i - 1].row == row && cells[i - 1].column == column - 1) {
      forest.join(i - 1, i);
    }
    const auto is_before = [&](const Cell& other) {
      return other.row < row - 1 || (other.row == row - 1 && other.column < column - 1);
    };
    while (below < i && is_before(cells[below])) {
      ++below;
    }
    for (std::size_t j = below; j < i && cells[j].row == row - 1 && cells[j].column <= column + 1; ++j) {
      forest.join(j, i);
    }
  }
  return forest;
}

}  // namespace

std::vector<float> piece_widths_m(const PreparedMap& map) {
  struct Box {
    Cell low;
    Cell high;
  };
  const std::vector<Cell> cells = cells_of_walls(map);
  Forest forest = touching(cells);
  std::vector<Box> boxes(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t root = forest.root(i);  // the first of its piece
    if (root == i) {
      boxes[i] = {cells[i], cells[i]};
      continue;
    }
    Box& box = boxes[root];
    box.low = {std::min(box.low.column, cells[i].column), std::min(box.low.row, cells[i].row)};
    box.high = {std::max(box.high.column, cells[i].column), std::max(box.high.row, cells[i].row)};
  }
  std::vector<float> widths_m(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Box& box = boxes[forest.root(i)];
    const int widest = std::max(box.high.column - box.low.column, box.high.row - box.low.row) + 1;
    widths_m[i] = static_cast<float>(widest * map.resolution_m());
  }
  return widths_m;
}

}  // namespace gridmerge
