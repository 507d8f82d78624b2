#include "gridmerge/fuse/resample.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// Cell coordinates of grid a from those of grid b.
Eigen::Affine2d cells_from_cells(const Pose2& a_from_b, double a_resolution_m, double b_resolution_m) {
  return Eigen::Scaling(1 / a_resolution_m) * Eigen::Translation2d(a_from_b.x_m, a_from_b.y_m) *
         Eigen::Rotation2Dd(a_from_b.theta_rad) * Eigen::Scaling(b_resolution_m);
}

std::optional<CellIndex> whole_cells(const Eigen::Affine2d& a_from_b, const GridGeometry& b) {
  constexpr double kToleranceCells = 1e-3;
  const double turn_cells = (a_from_b.linear() - Eigen::Matrix2d::Identity()).norm() * std::hypot(b.width, b.height);
  const Eigen::Vector2d shift = a_from_b.translation().array().round();
  if (turn_cells > kToleranceCells || (a_from_b.translation() - shift).norm() > kToleranceCells ||
      shift.cwiseAbs().maxCoeff() > 1e9) {
    return std::nullopt;
  }
  return CellIndex{static_cast<int>(shift.x()), static_cast<int>(shift.y())};
}

}  // namespace

void check_placed_map(const PlacedMap& map, const std::string& owner) {
  if (map.grid == nullptr) {
    throw std::invalid_argument(owner + ": a placed map without a grid");
  }
  check_grid(*map.grid);
  const Pose2& pose = map.merged_from_map;
  if (!std::isfinite(pose.x_m) || !std::isfinite(pose.y_m) || !std::isfinite(pose.theta_rad)) {
    throw std::invalid_argument(owner + ": the pose of a map must be finite");
  }
}

std::optional<Bounds> known_bounds(const PlacedMap& map, const Pose2& frame_from_merged) {
  const GridGeometry& geometry = map.grid->geometry;
  const Pose2 frame_from_grid = frame_from_merged * map.merged_from_map * geometry.map_from_grid;
  const auto known = [](std::int8_t cell) { return cell >= 0; };
  std::optional<Bounds> bounds;
  for (int row = 0; row < geometry.height; ++row) {
    const std::int8_t* cells = map.grid->cells.data() + geometry.offset({0, row});
    const std::int8_t* first = std::find_if(cells, cells + geometry.width, known);
    if (first == cells + geometry.width) {
      continue;
    }
    const std::int8_t* last = cells + geometry.width - 1;
    while (!known(*last)) {
      --last;
    }
    for (const auto column : {first - cells, last - cells + 1}) {
      for (const int edge : {row, row + 1}) {
        const Point2 corner =
            frame_from_grid * Point2{static_cast<double>(column) * geometry.resolution_m, edge * geometry.resolution_m};
        if (!bounds) {
          bounds = Bounds{corner, corner};
        }
        bounds->low = {std::min(bounds->low.x_m, corner.x_m), std::min(bounds->low.y_m, corner.y_m)};
        bounds->high = {std::max(bounds->high.x_m, corner.x_m), std::max(bounds->high.y_m, corner.y_m)};
      }
    }
  }
  return bounds;
}

/// The cells of a box, in which walls are drawn with points given in merged cell coordinates.
class Resampler::Canvas {
 public:
  Canvas(const CellBox& box, std::span<std::int8_t> cells) : box_(box), cells_(cells) {}

  void mark(double x, double y, std::int8_t value) {
    const double column = std::floor(x) - box_.first.column;
    const double row = std::floor(y) - box_.first.row;
    if (column >= 0 && row >= 0 && column < box_.width && row < box_.height) {
      std::int8_t& cell = cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(box_.width) +
                                 static_cast<std::size_t>(column)];
      cell = std::max(cell, value);
    }
  }

  /// Marks in steps of a cell at the most: cells that touch at least at a corner, at a side if asked.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool side_by_side, std::int8_t value) {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm())));
    Eigen::Vector2d before = from;
    for (int step = 1; step <= steps; ++step) {
      const Eigen::Vector2d here = step == steps ? to : from + (to - from) * (static_cast<double>(step) / steps);
      mark(here.x(), here.y(), value);
      if (side_by_side) {
        mark(here.x(), before.y(), value);
      }
      before = here;
    }
  }

 private:
  CellBox box_;
  std::span<std::int8_t> cells_;
};

Resampler::Resampler(const PlacedMap& map, const GridGeometry& onto)
    : grid_(map.grid),
      merged_from_source_(
          cells_from_cells(inverse(onto.map_from_grid) * map.merged_from_map * map.grid->geometry.map_from_grid,
                           onto.resolution_m, map.grid->geometry.resolution_m)),
      source_from_merged_(merged_from_source_.inverse()),
      whole_cells_(whole_cells(merged_from_source_, map.grid->geometry)),
      source_is_finer_(map.grid->geometry.resolution_m < onto.resolution_m * (1 - 1e-9)) {}

bool Resampler::read(const CellBox& box, std::span<std::int8_t> cells) const {
  std::fill(cells.begin(), cells.end(), kUnknown);
  const CellBox source = source_cells_under(box);
  if (source.width <= 0 || source.height <= 0) {
    return false;
  }
  if (whole_cells_) {
    copy(box, source, cells);
  } else {
    look_up(box, cells);
    if (source_is_finer_) {
      average(box, source, cells);
    }
    draw_walls(box, source, cells);
  }
  return std::any_of(cells.begin(), cells.end(), [](std::int8_t cell) { return cell >= 0; });
}

/// The upright rectangle of source cells whose centres, or whose wall's links to a neighbour, may fall into the box.
CellBox Resampler::source_cells_under(const CellBox& box) const {
  constexpr double kLink = 2;
  const Eigen::Vector2d origin = source_from_merged_ * Eigen::Vector2d(box.first.column, box.first.row);
  const Eigen::Vector2d along = source_from_merged_.linear() * Eigen::Vector2d(box.width, 0);
  const Eigen::Vector2d across = source_from_merged_.linear() * Eigen::Vector2d(0, box.height);
  const Eigen::Vector2d size(grid_->geometry.width, grid_->geometry.height);
  const Eigen::Vector2d low = (origin + along.cwiseMin(0) + across.cwiseMin(0)).array().floor() - kLink;
  const Eigen::Vector2d high = (origin + along.cwiseMax(0) + across.cwiseMax(0)).array().ceil() + kLink;
  const Eigen::Vector2d first = low.cwiseMax(0).cwiseMin(size);
  const Eigen::Vector2d extent = high.cwiseMax(first).cwiseMin(size) - first;
  return {{static_cast<int>(first.x()), static_cast<int>(first.y())},
          static_cast<int>(extent.x()),
          static_cast<int>(extent.y())};
}

void Resampler::copy(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const {
  const int shift_column = whole_cells_->column - box.first.column;
  const int shift_row = whole_cells_->row - box.first.row;
  const int first_column = std::max(source.first.column, -shift_column);
  const int last_column = std::min(source.first.column + source.width, box.width - shift_column);
  const int first_row = std::max(source.first.row, -shift_row);
  const int last_row = std::min(source.first.row + source.height, box.height - shift_row);
  for (int row = first_row; row < last_row && first_column < last_column; ++row) {
    std::copy_n(grid_->cells.data() + grid_->geometry.offset({first_column, row}), last_column - first_column,
                cells.data() + static_cast<std::ptrdiff_t>(row + shift_row) * box.width + first_column + shift_column);
  }
}

void Resampler::look_up(const CellBox& box, std::span<std::int8_t> cells) const {
  const Eigen::Vector2d step = source_from_merged_.linear().col(0);
  const GridGeometry& geometry = grid_->geometry;
  std::int8_t* cell = cells.data();
  for (int row = 0; row < box.height; ++row) {
    const Eigen::Vector2d start =
        source_from_merged_ * Eigen::Vector2d(box.first.column + 0.5, box.first.row + row + 0.5);
    for (int column = 0; column < box.width; ++column, ++cell) {
      const double x = start.x() + step.x() * column;
      const double y = start.y() + step.y() * column;
      if (x >= 0 && y >= 0 && x < geometry.width && y < geometry.height) {
        *cell = grid_->at({static_cast<int>(x), static_cast<int>(y)});
      }
    }
  }
}

void Resampler::average(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const {
  std::vector<int> sum(cells.size(), 0);
  std::vector<int> count(cells.size(), 0);
  const Eigen::Vector2d step = merged_from_source_.linear().col(0);
  for (int row = source.first.row; row < source.first.row + source.height; ++row) {
    const Eigen::Vector2d start = merged_from_source_ * Eigen::Vector2d(source.first.column + 0.5, row + 0.5) -
                                  Eigen::Vector2d(box.first.column, box.first.row);
    const std::int8_t* values = grid_->cells.data() + grid_->geometry.offset({source.first.column, row});
    for (int column = 0; column < source.width; ++column) {
      const double x = start.x() + step.x() * column;
      const double y = start.y() + step.y() * column;
      const std::int8_t value = values[column];
      if (value >= 0 && value <= kUndecided && x >= 0 && y >= 0 && x < box.width && y < box.height) {
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(box.width) + static_cast<std::size_t>(x);
        sum[at] += value;
        ++count[at];
      }
    }
  }
  for (std::size_t at = 0; at < cells.size(); ++at) {
    if (count[at] > 0 && cells[at] <= kUndecided) {
      cells[at] = static_cast<std::int8_t>((sum[at] + count[at] / 2) / count[at]);
    }
  }
}

void Resampler::draw_walls(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const {
  Canvas canvas(box, cells);
  const auto centre = [this](int column, int row) -> Eigen::Vector2d {
    return merged_from_source_ * Eigen::Vector2d(column + 0.5, row + 0.5);
  };
  for (int row = source.first.row; row < source.first.row + source.height; ++row) {
    for (int column = source.first.column; column < source.first.column + source.width; ++column) {
      const std::int8_t value = grid_->at({column, row});
      if (value <= kUndecided) {
        continue;
      }
      const Eigen::Vector2d here = centre(column, row);
      canvas.mark(here.x(), here.y(), value);
      const std::int8_t right = wall_at(column + 1, row);
      const std::int8_t up = wall_at(column, row + 1);
      if (right > 0) {
        canvas.line(here, centre(column + 1, row), true, std::min(value, right));
      }
      if (up > 0) {
        canvas.line(here, centre(column, row + 1), true, std::min(value, up));
      }
      // Corner to corner, where no wall beside them links the two already.
      const std::int8_t up_right = wall_at(column + 1, row + 1);
      if (up_right > 0 && right == 0 && up == 0) {
        canvas.line(here, centre(column + 1, row + 1), false, std::min(value, up_right));
      }
      const std::int8_t up_left = wall_at(column - 1, row + 1);
      if (up_left > 0 && up == 0 && wall_at(column - 1, row) == 0) {
        canvas.line(here, centre(column - 1, row + 1), false, std::min(value, up_left));
      }
    }
  }
}

/// The value of a wall, 0 where there is none.
std::int8_t Resampler::wall_at(int column, int row) const {
  const CellIndex cell{column, row};
  const std::int8_t value = grid_->geometry.contains(cell) ? grid_->at(cell) : kUnknown;
  return value > kUndecided ? value : std::int8_t{0};
}

std::vector<CellBox> tiles(const GridGeometry& geometry) {
  constexpr int kSide = 128;
  std::vector<CellBox> boxes;
  for (int row = 0; row < geometry.height; row += kSide) {
    for (int column = 0; column < geometry.width; column += kSide) {
      boxes.push_back(
          {{column, row}, std::min(kSide, geometry.width - column), std::min(kSide, geometry.height - row)});
    }
  }
  return boxes;
}

OccupancyGrid resample(const PlacedMap& map, const GridGeometry& onto, int num_threads) {
  OccupancyGrid result = unknown_grid(onto);
  const Resampler resampler(map, onto);
  const std::vector<CellBox> boxes = tiles(onto);
  parallel_for(boxes.size(), num_threads, [&](std::size_t index, std::size_t) {
    const CellBox& box = boxes[index];
    std::vector<std::int8_t> cells(box.cell_count());
    resampler.read(box, cells);
    for (int row = 0; row < box.height; ++row) {
      std::copy_n(cells.data() + static_cast<std::ptrdiff_t>(row) * box.width, box.width,
                  result.cells.data() + onto.offset({box.first.column, box.first.row + row}));
    }
  });
  return result;
}

}  // namespace gridmerge
