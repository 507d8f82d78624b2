#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "worlds/builder.hpp"
#include "worlds/kinds.hpp"
#include "worlds/portable.hpp"

namespace gridmerge::worlds {

/// On average as large as the thesis's maze, 34 m x 17 m, unless another length is asked for.
World maze(const Plot& plot) {
  RandomStream& random = plot.random;
  const int columns = plot.length_m > 0 ? std::max(2, static_cast<int>(std::lround(plot.length_m / 3.4))) : 10;
  const int rows = columns / 2;
  struct Cell {
    bool visited = false;
    bool open_right = false;
    bool open_up = false;
  };
  std::vector<Cell> cells(static_cast<std::size_t>(columns * rows));
  const auto at = [&](int column, int row) -> Cell& { return cells[static_cast<std::size_t>(column * rows + row)]; };
  struct Step {
    int column = 0;
    int row = 0;
  };
  constexpr std::array<Step, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

  std::vector<Step> trail = {{0, 0}};
  at(0, 0).visited = true;
  while (!trail.empty()) {  // depth first, with a way back
    const Step here = trail.back();
    std::vector<Step> fresh;
    for (const Step& step : kSteps) {
      const Step to = {here.column + step.column, here.row + step.row};
      const bool inside = to.column >= 0 && to.row >= 0 && to.column < columns && to.row < rows;
      if (inside && !at(to.column, to.row).visited) {
        fresh.push_back(to);
      }
    }
    if (fresh.empty()) {
      trail.pop_back();
      continue;
    }
    const Step to = fresh[random.below(static_cast<std::uint32_t>(fresh.size()))];
    at(to.column, to.row).visited = true;
    Cell& lower = at(std::min(here.column, to.column), std::min(here.row, to.row));
    (to.column != here.column ? lower.open_right : lower.open_up) = true;
    trail.push_back(to);
  }

  // Passages of unequal width: on an even lattice a maze fits itself, and any other, in many places.
  std::vector<double> x_m(static_cast<std::size_t>(columns) + 1);
  std::vector<double> y_m(static_cast<std::size_t>(rows) + 1);
  for (std::size_t i = 1; i < x_m.size(); ++i) {
    x_m[i] = x_m[i - 1] + random.uniform(2.6, 4.2);
  }
  for (std::size_t i = 1; i < y_m.size(); ++i) {
    y_m[i] = y_m[i - 1] + random.uniform(2.6, 4.2);
  }
  Builder builder(x_m.back(), y_m.back());
  builder.outer_walls();
  for (int column = 0; column < columns; ++column) {
    for (int row = 0; row < rows; ++row) {
      const auto i = static_cast<std::size_t>(column);
      const auto j = static_cast<std::size_t>(row);
      const Point2 low = {x_m[i], y_m[j]};
      const Point2 high = {x_m[i + 1], y_m[j + 1]};
      // A quarter of the inner walls falls, so that there is more than one way round.
      if (column + 1 < columns && !at(column, row).open_right && random.below(4) != 0) {
        builder.wall({high.x_m, low.y_m}, high);
      }
      if (row + 1 < rows && !at(column, row).open_up && random.below(4) != 0) {
        builder.wall({low.x_m, high.y_m}, high);
      }
      const Point2 centre = 0.5 * (low + high);
      if (random.below(5) == 0) {
        const Point2 at_off = centre + Point2{random.uniform(-1, 1), random.uniform(-1, 1)};
        const Point2 size = {random.uniform(0.4, 1.6), random.uniform(0.3, 0.8)};
        if (random.below(2) == 0) {
          builder.disc(at_off, size.y_m / 2);
        } else {
          builder.box(at_off, size, direction(random.uniform(0, kPi)));
        }
      }
      builder.place(centre);
    }
  }
  return builder.finish();
}
/// One passage, wound up. Its wall is a spiral of Archimedes, with buttresses here and there: bare, it would fit itself
/// all along.
World spiral(const Plot& plot) {
  constexpr int kSteps = 40;  // of a turn
  constexpr double kTurns = 4.25;
  RandomStream& random = plot.random;
  const double pitch_m = random.uniform(2.6, 3.2);
  const double begin_rad = random.uniform(0, 2 * kPi);
  const double radius_m = (kTurns + 0.5) * pitch_m;
  Builder builder(2 * radius_m + 0.4, 2 * radius_m + 0.4);
  const Point2 centre = {radius_m + 0.2, radius_m + 0.2};
  const auto at = [&](int step, double aside_m) {
    const double turns = static_cast<double>(step) / kSteps;
    return centre + (pitch_m * (0.5 + turns) + aside_m) * direction(begin_rad + 2 * kPi * turns);
  };
  builder.winds();
  const int last = static_cast<int>(kTurns * kSteps);
  for (int step = 0; step < last; ++step) {
    builder.wall(at(step, 0), at(step + 1, 0));
    if (random.below(9) == 0) {
      const double side = random.below(2) == 0 ? 1 : -1;
      builder.wall(at(step, 0), at(step, side * random.uniform(0.4, 0.9)));
    }
  }
  for (int step = kSteps / 2; step + kSteps / 5 < last; step += kSteps * kSteps / (kSteps + 3 * step)) {
    builder.place(at(step, -pitch_m / 2));
  }
  return builder.finish();
}

}  // namespace gridmerge::worlds
