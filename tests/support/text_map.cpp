#include "support/text_map.hpp"

#include <algorithm>
#include <ostream>
#include <stdexcept>

namespace gridmerge {
namespace {

std::int8_t cell_of(char sign) {
  switch (sign) {
    case '#':
      return kOccupied;
    case '.':
      return kFree;
    case '?':
    case ' ':
      return kUnknown;
    default:
      if (sign >= '1' && sign <= '9') {
        return static_cast<std::int8_t>(10 * (sign - '0'));
      }
      throw std::invalid_argument(std::string("text map: '") + sign + "' means nothing; known: # . ? 1..9 and space");
  }
}

char sign_of(std::int8_t cell) {
  if (cell < 0) {
    return '?';
  }
  const int tens = (cell + 5) / 10;
  return tens == 0 ? '.' : tens >= 10 ? '#' : static_cast<char>('0' + tens);
}

}  // namespace

OccupancyGrid text_map(std::initializer_list<std::string_view> rows_from_top, double resolution_m,
                       const Pose2& map_from_grid) {
  const std::size_t width = rows_from_top.size() == 0 ? 0 : rows_from_top.begin()->size();
  OccupancyGrid grid = unknown_grid({.width = static_cast<int>(width),
                                     .height = static_cast<int>(rows_from_top.size()),
                                     .resolution_m = resolution_m,
                                     .map_from_grid = map_from_grid});
  int row = grid.geometry.height;
  for (const std::string_view text : rows_from_top) {
    --row;
    if (text.size() != width) {
      throw std::invalid_argument("text map: rows of " + std::to_string(width) + " and of " +
                                  std::to_string(text.size()) + " cells");
    }
    for (std::size_t column = 0; column < width; ++column) {
      grid.at({static_cast<int>(column), row}) = cell_of(text[column]);
    }
  }
  return grid;
}

std::string to_text(const OccupancyGrid& grid) {
  std::string text;
  for (int row = grid.geometry.height - 1; row >= 0; --row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      text += sign_of(grid.at({column, row}));
    }
    text += '\n';
  }
  return text;
}

void PrintTo(CellIndex cell, std::ostream* out) { *out << "column " << cell.column << ", row " << cell.row; }

void PrintTo(Point2 point, std::ostream* out) { *out << "(" << point.x_m << ", " << point.y_m << ")"; }

void PrintTo(const Pose2& pose, std::ostream* out) {
  *out << "(" << pose.x_m << ", " << pose.y_m << ", " << pose.theta_rad << ")";
}

void PrintTo(const GridGeometry& geometry, std::ostream* out) {
  *out << geometry.width << " x " << geometry.height << " cells of " << geometry.resolution_m << " m, origin ";
  PrintTo(geometry.map_from_grid, out);
}

void PrintTo(const OccupancyGrid& grid, std::ostream* out) {
  constexpr int kScreen = 120;
  PrintTo(grid.geometry, out);
  *out << '\n';
  if (std::max(grid.geometry.width, grid.geometry.height) <= kScreen &&
      grid.cells.size() == grid.geometry.cell_count()) {
    *out << to_text(grid);
  }
}

}  // namespace gridmerge
