#include "methods/radon_voronoi/edge_matrices.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::voronoi {
namespace {

/// A turned edge before it is drawn: its cells on the lattice.
struct LatticeCell {
  int column;
  int row;
  float weight;
};

float norm_of(const std::vector<float>& values) {
  float sum = 0;
  for (const float v : values) {
    sum += v * v;
  }
  return std::sqrt(sum);
}

/// Each cell as a Gaussian of the given width; where several meet, the surest counts.
EdgeMatrix drawn(const std::vector<LatticeCell>& cells, double sigma_cells) {
  const int reach = static_cast<int>(std::ceil(2 * sigma_cells));
  EdgeMatrix matrix{.low_column = cells.front().column,
                    .low_row = cells.front().row,
                    .width = 0,
                    .height = 0,
                    .value = {},
                    .norm = 0,
                    .cells = static_cast<int>(cells.size())};
  int high_column = matrix.low_column;
  int high_row = matrix.low_row;
  for (const LatticeCell& cell : cells) {
    matrix.low_column = std::min(matrix.low_column, cell.column);
    matrix.low_row = std::min(matrix.low_row, cell.row);
    high_column = std::max(high_column, cell.column);
    high_row = std::max(high_row, cell.row);
  }
  matrix.low_column -= reach;
  matrix.low_row -= reach;
  matrix.width = high_column + reach - matrix.low_column + 1;
  matrix.height = high_row + reach - matrix.low_row + 1;
  matrix.value.assign(static_cast<std::size_t>(matrix.width) * static_cast<std::size_t>(matrix.height), 0.0F);
  for (const LatticeCell& cell : cells) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const double square = dx * dx + dy * dy;
        const double bell = reach == 0 ? 1 : std::exp(-0.5 * square / (sigma_cells * sigma_cells));
        float& value = matrix.value[static_cast<std::size_t>(cell.row + dy - matrix.low_row) *
                                        static_cast<std::size_t>(matrix.width) +
                                    static_cast<std::size_t>(cell.column + dx - matrix.low_column)];
        value = std::max(value, cell.weight * static_cast<float>(bell));
      }
    }
  }
  matrix.norm = static_cast<double>(norm_of(matrix.value));
  return matrix;
}

double top_of(float left, float middle, float right) {
  const float bend = left - 2 * middle + right;
  return bend < 0 ? std::clamp(0.5 * static_cast<double>((left - right) / bend), -0.5, 0.5) : 0;
}

}  // namespace

std::vector<EdgeMatrix> edge_matrices(const Diagram& diagram, const radon::Rotation& rotation,
                                      const EdgeRaster& raster) {
  const Pose2 turn{0, 0, rotation.angle_rad};
  std::vector<std::vector<LatticeCell>> cells(static_cast<std::size_t>(diagram.edges));
  std::vector<Point2> sum(cells.size());
  for (const RidgePoint& one : diagram.ridge) {
    if (one.edge >= 0) {
      const Point2 at = turn * Point2{static_cast<double>(one.at.x_m), static_cast<double>(one.at.y_m)};
      const auto edge = static_cast<std::size_t>(one.edge);
      cells[edge].push_back({static_cast<int>(std::floor(at.x_m / raster.cell_m)),
                             static_cast<int>(std::floor(at.y_m / raster.cell_m)), one.weight});
      sum[edge] = sum[edge] + at;
    }
  }
  std::vector<EdgeMatrix> matrices;
  for (std::size_t edge = 0; edge < cells.size(); ++edge) {
    if (static_cast<int>(cells[edge].size()) < raster.shortest_cells) {
      continue;
    }
    const double far_m = norm(sum[edge]) / static_cast<double>(cells[edge].size());
    matrices.push_back(drawn(cells[edge], std::min(far_m * rotation.sigma_rad, raster.most_blur_m) / raster.cell_m));
  }
  return matrices;
}

EdgeMatch cross_correlate(const EdgeMatrix& a, const EdgeMatrix& b) {
  // Cell (u, v) of the surface is the shift that puts b's far corner on a's near one, and on by (u, v).
  const int width = a.width + b.width - 1;
  const int height = a.height + b.height - 1;
  std::vector<float> surface(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F);
  const std::vector<float> flipped(b.value.rbegin(), b.value.rend());
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  };
  for (int row = 0; row < a.height; ++row) {
    for (int column = 0; column < a.width; ++column) {
      const float weight =
          a.value[static_cast<std::size_t>(row) * static_cast<std::size_t>(a.width) + static_cast<std::size_t>(column)];
      if (weight <= 0) {
        continue;
      }
      for (int y = 0; y < b.height; ++y) {
        const float* from = &flipped[static_cast<std::size_t>(y) * static_cast<std::size_t>(b.width)];
        float* to = &surface[at(column, row + y)];
        for (int x = 0; x < b.width; ++x) {
          to[x] += weight * from[x];
        }
      }
    }
  }
  const auto highest = std::max_element(surface.begin(), surface.end());
  const int column = static_cast<int>((highest - surface.begin()) % width);
  const int row = static_cast<int>((highest - surface.begin()) / width);
  const bool inner_x = column > 0 && column + 1 < width;
  const bool inner_y = row > 0 && row + 1 < height;
  const double x = inner_x ? top_of(surface[at(column - 1, row)], *highest, surface[at(column + 1, row)]) : 0;
  const double y = inner_y ? top_of(surface[at(column, row - 1)], *highest, surface[at(column, row + 1)]) : 0;
  const double norms = a.norm * b.norm;
  return {.columns = column + x + a.low_column - (b.low_column + b.width - 1),
          .rows = row + y + a.low_row - (b.low_row + b.height - 1),
          .likeness = norms > 0 ? static_cast<double>(*highest) / norms : 0};
}

}  // namespace gridmerge::voronoi
