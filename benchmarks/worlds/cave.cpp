#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "worlds/builder.hpp"
#include "worlds/kinds.hpp"

namespace gridmerge::worlds {
namespace {

/// Numbers on a lattice, row by row.
struct Field {
  int columns = 0;
  int rows = 0;
  std::vector<double> values;

  Field(int width, int height)
      : columns(width), rows(height), values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
  [[nodiscard]] bool inside(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }
  [[nodiscard]] double& at(int column, int row) { return values[static_cast<std::size_t>(row * columns + column)]; }
  [[nodiscard]] double at(int column, int row) const {
    return inside(column, row) ? values[static_cast<std::size_t>(row * columns + column)] : 1;  // rock all round
  }
  [[nodiscard]] double round_about(int column, int row) const {
    double sum = 0;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        sum += inside(column + dx, row + dy) ? at(column + dx, row + dy) : 1;
      }
    }
    return sum;
  }
};

/// Rock (1) and air (0) by the cellular automaton that leaves caverns: a cell goes with most of its neighbours.
Field caverns(int columns, int rows, RandomStream& random) {
  Field rock(columns, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const bool border = column == 0 || row == 0 || column + 1 == columns || row + 1 == rows;
      const bool drawn = random.uniform() < 0.45;
      rock.at(column, row) = border || drawn ? 1 : 0;
    }
  }
  for (int round = 0; round < 4; ++round) {
    Field next = rock;
    for (int row = 1; row + 1 < rows; ++row) {
      for (int column = 1; column + 1 < columns; ++column) {
        next.at(column, row) = rock.round_about(column, row) >= 5 ? 1 : 0;
      }
    }
    rock = next;
  }
  return rock;
}

/// The cells of air that hang together with one of them.
std::vector<int> cavern_at(const Field& rock, int seed, std::vector<bool>& visited) {
  std::vector<int> cavern = {seed};
  visited[static_cast<std::size_t>(seed)] = true;
  for (std::size_t i = 0; i < cavern.size(); ++i) {
    const int column = cavern[i] % rock.columns;
    const int row = cavern[i] / rock.columns;
    for (const auto& [dx, dy] : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
      const int to = (row + dy) * rock.columns + column + dx;
      if (rock.inside(column + dx, row + dy) && rock.at(column + dx, row + dy) == 0 &&
          !visited[static_cast<std::size_t>(to)]) {
        visited[static_cast<std::size_t>(to)] = true;
        cavern.push_back(to);
      }
    }
  }
  return cavern;
}

/// A cell of either cavern, as near to each other as there are.
std::array<int, 2> nearest_cells(const Field& rock, const std::vector<int>& cavern, const std::vector<int>& other) {
  const auto far2 = [&](int a, int b) {
    const int dx = a % rock.columns - b % rock.columns;
    const int dy = a / rock.columns - b / rock.columns;
    return dx * dx + dy * dy;
  };
  std::array<int, 2> nearest = {cavern.front(), other.front()};
  for (const int a : cavern) {
    for (const int b : other) {
      if (far2(a, b) < far2(nearest[0], nearest[1])) {
        nearest = {a, b};
      }
    }
  }
  return nearest;
}

/// Two cells wide, step by step along the axis on which more is left to go.
void dig_passage(Field& rock, int from, int to) {
  int column = from % rock.columns;
  int row = from / rock.columns;
  while (column != to % rock.columns || row != to / rock.columns) {
    const int dx = to % rock.columns - column;
    const int dy = to / rock.columns - row;
    if (std::abs(dx) >= std::abs(dy)) {
      column += dx > 0 ? 1 : -1;
    } else {
      row += dy > 0 ? 1 : -1;
    }
    rock.at(column, row) = 0;
    rock.at(std::min(column + 1, rock.columns - 2), row) = 0;
    rock.at(column, std::min(row + 1, rock.rows - 2)) = 0;
  }
}

/// Joins every cavern to the largest one; small ones are filled.
void connect(Field& rock) {
  constexpr std::size_t kSmall = 12;  // [cells]
  std::vector<bool> visited(rock.values.size(), false);
  std::vector<std::vector<int>> parts;
  for (int cell = 0; cell < rock.columns * rock.rows; ++cell) {
    if (rock.values[static_cast<std::size_t>(cell)] == 0 && !visited[static_cast<std::size_t>(cell)]) {
      parts.push_back(cavern_at(rock, cell, visited));
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].size() < kSmall) {
      for (const int cell : parts[i]) {
        rock.values[static_cast<std::size_t>(cell)] = 1;
      }
      continue;
    }
    const auto [from, to] = nearest_cells(rock, parts[i], parts[0]);
    dig_passage(rock, from, to);
    parts[0].insert(parts[0].end(), parts[i].begin(), parts[i].end());
  }
}

/// A finer lattice: blurred a little, bilinear between the cells, with the roughness of rock.
Field roughened(const Field& rock, int finer, RandomStream& random) {
  Field blurred = rock;
  for (int row = 0; row < rock.rows; ++row) {
    for (int column = 0; column < rock.columns; ++column) {
      blurred.at(column, row) = 0.55 * rock.at(column, row) + 0.05 * rock.round_about(column, row);
    }
  }
  const Field& smooth = blurred;
  Field fine(rock.columns * finer, rock.rows * finer);
  for (int row = 0; row < fine.rows; ++row) {
    for (int column = 0; column < fine.columns; ++column) {
      const int i = column / finer;
      const int j = row / finer;
      const double u = static_cast<double>(column % finer) / finer;
      const double v = static_cast<double>(row % finer) / finer;
      const double below = (1 - u) * smooth.at(i, j) + u * smooth.at(i + 1, j);
      const double above = (1 - u) * smooth.at(i, j + 1) + u * smooth.at(i + 1, j + 1);
      fine.at(column, row) = (1 - v) * below + v * above + random.uniform(-0.1, 0.1);
    }
  }
  return fine;
}

/// The line where the field passes 1/2 (marching squares; where it is a toss-up, air joins air).
void draw_outline(Builder& builder, const Field& field, double cell_m) {
  constexpr double kLevel = 0.5;
  const auto crossing = [&](int c0, int r0, int c1, int r1) {
    const double first = field.at(c0, r0);
    const double part = (kLevel - first) / (field.at(c1, r1) - first);
    return cell_m * Point2{c0 + part * (c1 - c0), r0 + part * (r1 - r0)};
  };
  for (int r = 0; r + 1 < field.rows; ++r) {
    for (int c = 0; c + 1 < field.columns; ++c) {
      const std::array<std::array<int, 2>, 4> corners = {{{c, r}, {c + 1, r}, {c + 1, r + 1}, {c, r + 1}}};
      std::vector<Point2> points;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto& a = corners[i];
        const auto& b = corners[(i + 1) % corners.size()];
        if ((field.at(a[0], a[1]) < kLevel) != (field.at(b[0], b[1]) < kLevel)) {
          points.push_back(crossing(a[0], a[1], b[0], b[1]));
        }
      }
      const bool first_is_air = field.at(c, r) < kLevel;
      if (points.size() == 2) {
        builder.face(points[0], points[1]);
      } else if (points.size() == 4) {
        builder.face(points[first_is_air ? 0 : 3], points[first_is_air ? 1 : 0]);
        builder.face(points[first_is_air ? 2 : 1], points[first_is_air ? 3 : 2]);
      }
    }
  }
}

}  // namespace

/// Caverns and passages with an outline that no ruler drew.
World cave(const Plot& plot) {
  constexpr double kCavern = 1.1;  // [m] side of the automaton's cells
  constexpr int kFiner = 4;
  RandomStream& random = plot.random;
  const double length_m = plot.length_m > 0 ? plot.length_m : 45;
  const int columns = static_cast<int>(std::lround(length_m / kCavern));
  const int rows = std::max(12, columns * 2 / 3);
  Field rock = caverns(columns, rows, random);
  connect(rock);
  Builder builder(columns * kCavern, rows * kCavern);
  builder.in_rock();
  draw_outline(builder, roughened(rock, kFiner, random), kCavern / kFiner);
  for (int row = 2; row + 1 < rows; row += 3) {
    for (int column = 2; column + 1 < columns; column += 3) {
      if (rock.round_about(column, row) <= 1) {
        builder.place({column * kCavern, row * kCavern});
      }
    }
  }
  return builder.finish();
}

}  // namespace gridmerge::worlds
