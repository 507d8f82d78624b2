#include "gridmerge/grid/prepared_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <type_traits>

#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// Cells of margin round the known area, so that what lies just outside still finds the walls at its rim. A multiple
/// of 2^(levels-1): the levels then share one lower-left corner.
constexpr int kMargin = 16;

/// A rectangle of cells; empty if high < low.
struct Box {
  int low_column, low_row, high_column, high_row;
};

Box known_box(const OccupancyGrid& grid, int num_threads) {
  const int width = grid.geometry.width;
  const int height = grid.geometry.height;
  std::vector<std::pair<int, int>> span_of_row(static_cast<std::size_t>(height), {width, -1});
  constexpr std::size_t kRowsAtATime = 64;
  const std::size_t blocks = (static_cast<std::size_t>(height) + kRowsAtATime - 1) / kRowsAtATime;
  parallel_for(blocks, num_threads, [&](std::size_t block, std::size_t) {
    const std::size_t end = std::min((block + 1) * kRowsAtATime, static_cast<std::size_t>(height));
    for (std::size_t row = block * kRowsAtATime; row < end; ++row) {
      const auto first = grid.cells.begin() + static_cast<std::ptrdiff_t>(row * static_cast<std::size_t>(width));
      const auto last = first + width;
      const auto known = [](std::int8_t value) { return value != kUnknown; };
      const auto low = std::find_if(first, last, known);
      if (low != last) {
        const auto high = std::find_if(std::reverse_iterator(last), std::reverse_iterator(low), known);
        span_of_row[row] = {static_cast<int>(low - first), static_cast<int>(high.base() - first) - 1};
      }
    }
  });
  Box box{width, height, -1, -1};
  for (int row = 0; row < height; ++row) {
    const auto [low, high] = span_of_row[static_cast<std::size_t>(row)];
    if (high >= 0) {
      box.low_column = std::min(box.low_column, low);
      box.high_column = std::max(box.high_column, high);
      box.low_row = std::min(box.low_row, row);
      box.high_row = row;
    }
  }
  return box;
}

CellState state_of(int percent, const PrepareOptions& options) {
  if (percent >= options.occupied_percent) {
    return CellState::kWall;
  }
  return percent >= 0 && percent <= options.free_percent ? CellState::kOpen : CellState::kUnseen;
}

/// Exact Euclidean distance of every cell's centre to the nearest occupied cell's centre.
std::vector<float> wall_distances(const MapLevel& level) {
  std::vector<std::uint8_t> not_wall(level.state.size());
  std::transform(level.state.begin(), level.state.end(), not_wall.begin(),
                 [](CellState s) { return static_cast<std::uint8_t>(s == CellState::kWall ? 0 : 1); });
  std::vector<float> distance(level.state.size(), kFarFromWalls);
  if (std::find(not_wall.begin(), not_wall.end(), 0) == not_wall.end()) {
    return distance;
  }
  const cv::Mat binary(level.height, level.width, CV_8UC1, not_wall.data());
  cv::Mat cells(level.height, level.width, CV_32FC1, distance.data());
  cv::distanceTransform(binary, cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  const float resolution = static_cast<float>(level.resolution_m);
  for (float& d : distance) {
    d *= resolution;
  }
  return distance;
}

/// Four cells make one: occupied wins, then free.
MapLevel coarser(const MapLevel& fine) {
  MapLevel coarse{.width = (fine.width + 1) / 2,
                  .height = (fine.height + 1) / 2,
                  .resolution_m = 2 * fine.resolution_m,
                  .lower_left = fine.lower_left,
                  .state = {},
                  .wall_distance_m = {}};
  coarse.state.assign(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height),
                      CellState::kUnseen);
  for (int row = 0; row < fine.height; ++row) {
    for (int column = 0; column < fine.width; ++column) {
      CellState& cell = coarse.state[coarse.offset(column / 2, row / 2)];
      cell = std::max(cell, fine.state[fine.offset(column, row)]);
    }
  }
  return coarse;
}

/// The surface that an occupied cell belongs to, from the cells within three of it: free cells pull the free normal;
/// the other occupied cells span the wall, and the normal lies across their principal direction.
WallPoint wall_point(const MapLevel& level, int column, int row, Point2f at) {
  constexpr int kReach = 3;
  float free_x = 0;
  float free_y = 0;
  float free_cells = 0;
  float xx = 0;
  float xy = 0;
  float yy = 0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if ((dx == 0 && dy == 0) || !level.contains(column + dx, row + dy)) {
        continue;
      }
      const CellState state = level.state[level.offset(column + dx, row + dy)];
      const auto x = static_cast<float>(dx);
      const auto y = static_cast<float>(dy);
      if (state == CellState::kOpen) {
        const float w = 1.0F / std::sqrt(x * x + y * y);
        free_x += w * x;
        free_y += w * y;
        free_cells += 1;
      } else if (state == CellState::kWall) {
        xx += x * x;
        xy += x * y;
        yy += y * y;
      }
    }
  }
  WallPoint point{.at = at, .free_normal = {}, .surface_normal = {}};
  // Free cells all round pull in no direction: a post, a speck, a thin wall seen from both sides.
  const float length = std::hypot(free_x, free_y);
  if (free_cells > 0 && length >= 0.25F * free_cells) {
    point.free_normal = {free_x / length, free_y / length};
  }
  // Eigenvalues of the scatter: mean +- half_gap. Elongated at least 3 : 1, or it is a corner or a blob.
  const float mean = 0.5F * (xx + yy);
  const float half_gap = std::hypot(0.5F * (xx - yy), xy);
  if (half_gap > 0.5F * mean) {
    const float along = 0.5F * std::atan2(2 * xy, xx - yy);
    point.surface_normal = {-std::sin(along), std::cos(along)};
  } else {
    point.surface_normal = point.free_normal;
  }
  return point;
}

}  // namespace

void PrepareOptions::describe(OptionList& list) {
  list.add("finest_resolution_m", finest_resolution_m, 0.005, 10,
           {"m", "Maps finer than this are brought to it before they are aligned.",
            "Lower it for maps of very small places; time and memory grow with its inverse square."})
      .add("occupied_percent", occupied_percent, 1, 100,
           {"%", "A cell of at least this occupancy is occupied.",
            "Lower it (60 in [li2013]) for maps whose walls are uncertain; noise then becomes walls."})
      .add("free_percent", free_percent, 0, 99,
           {"%", "A known cell of at most this occupancy is free.",
            "Must lie below occupied_percent; cells between the two count as unknown."});
}

PreparedMap::PreparedMap(const OccupancyGrid& grid, double resolution_m, const PrepareOptions& options,
                         int num_threads) {
  require_valid(options, "prepare");
  if (options.free_percent >= options.occupied_percent) {
    throw std::invalid_argument("prepare: free_percent must lie below occupied_percent");
  }
  const GridGeometry& geometry = grid.geometry;
  if (!std::isfinite(resolution_m) || resolution_m < geometry.resolution_m * (1 - 1e-9)) {
    throw std::invalid_argument("prepare: the resolution must be finite, and not finer than the map's own");
  }
  resolution_m_ = resolution_m;
  const Box box = known_box(grid, num_threads);
  if (box.high_column < 0) {
    map_from_local_ = geometry.map_from_grid;
    levels_.resize(kLevels);
    for (int k = 0; k < kLevels; ++k) {
      levels_[static_cast<std::size_t>(k)].resolution_m = resolution_m * (1 << k);
    }
    return;
  }

  // Level 0, still with its corner at the grid's: the local origin is known only once all cells have been seen.
  const double scale = geometry.resolution_m / resolution_m_;  // <= 1: no cell of level 0 is skipped
  const auto scaled = [&](int index) { return static_cast<int>(std::floor((index + 0.5) * scale)); };
  const int low_column = scaled(box.low_column) - kMargin;
  const int low_row = scaled(box.low_row) - kMargin;
  MapLevel base{.width = scaled(box.high_column) - low_column + 1 + kMargin,
                .height = scaled(box.high_row) - low_row + 1 + kMargin,
                .resolution_m = resolution_m_,
                .lower_left = {},
                .state = {},
                .wall_distance_m = {}};
  const std::size_t cells = static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height);
  occupancy_.assign(cells, kUnknown);
  std::vector<int> column_of(static_cast<std::size_t>(box.high_column - box.low_column + 1));
  for (int column = box.low_column; column <= box.high_column; ++column) {
    column_of[static_cast<std::size_t>(column - box.low_column)] = scaled(column) - low_column;
  }
  for (int row = box.low_row; row <= box.high_row; ++row) {
    const std::int8_t* from = &grid.cells[geometry.offset({box.low_column, row})];
    std::int8_t* to = &occupancy_[base.offset(0, scaled(row) - low_row)];
    for (const int column : column_of) {
      to[column] = std::max(to[column], *from++);  // of several cells in one, the most occupied counts
    }
  }
  base.state.resize(cells);
  std::array<CellState, 102> state_of_percent{};
  for (int percent = kUnknown; percent <= kOccupied; ++percent) {
    state_of_percent[static_cast<std::size_t>(percent + 1)] = state_of(percent, options);
  }
  double sum_column = 0;
  double sum_row = 0;
  std::size_t occupied = 0;
  for (int row = 0; row < base.height; ++row) {
    double in_row = 0;
    for (int column = 0; column < base.width; ++column) {
      const std::size_t at = base.offset(column, row);
      const CellState s = state_of_percent[static_cast<std::size_t>(occupancy_[at] + 1)];
      base.state[at] = s;
      if (s != CellState::kUnseen) {
        sum_column += column + 0.5;
        in_row += 1;
        occupied += s == CellState::kWall ? 1 : 0;
      }
    }
    sum_row += in_row * (row + 0.5);
    known_cells_ += static_cast<std::size_t>(in_row);
  }
  known_area_m2_ = static_cast<double>(known_cells_) * resolution_m_ * resolution_m_;
  const double known = std::max<double>(1, static_cast<double>(known_cells_));
  const Point2 centre_in_base{sum_column / known * resolution_m_, sum_row / known * resolution_m_};
  base.lower_left = {-centre_in_base.x_m, -centre_in_base.y_m};
  map_from_local_ = geometry.map_from_grid * Pose2{low_column * resolution_m_ + centre_in_base.x_m,
                                                   low_row * resolution_m_ + centre_in_base.y_m, 0};

  walls_.reserve(occupied);
  double radius2 = 0;
  for (int row = 0; row < base.height; ++row) {
    for (int column = 0; column < base.width; ++column) {
      const CellState s = base.state[base.offset(column, row)];
      if (s == CellState::kUnseen) {
        continue;
      }
      const double x = base.lower_left.x_m + (column + 0.5) * resolution_m_;
      const double y = base.lower_left.y_m + (row + 0.5) * resolution_m_;
      radius2 = std::max(radius2, x * x + y * y);
      if (s == CellState::kWall) {
        walls_.push_back(wall_point(base, column, row, {static_cast<float>(x), static_cast<float>(y)}));
      }
    }
  }
  radius_m_ = std::sqrt(radius2);

  levels_.push_back(std::move(base));
  for (int k = 1; k < kLevels; ++k) {
    levels_.push_back(coarser(levels_.back()));
  }
  parallel_for(kLevels, num_threads,
               [&](std::size_t k, std::size_t) { levels_[k].wall_distance_m = wall_distances(levels_[k]); });
}

PreparedMap PreparedMap::mirrored(int finest_level) const {
  const auto flipped_rows = [](const auto& cells, int width) {
    std::decay_t<decltype(cells)> flipped;
    flipped.reserve(cells.size());
    for (auto end = cells.end(); end != cells.begin(); end -= width) {
      flipped.insert(flipped.end(), end - width, end);
    }
    return flipped;
  };
  PreparedMap flipped;
  flipped.resolution_m_ = resolution_m_;
  flipped.radius_m_ = radius_m_;
  flipped.known_area_m2_ = known_area_m2_;
  flipped.known_cells_ = known_cells_;
  flipped.levels_.resize(levels_.size());
  for (std::size_t k = static_cast<std::size_t>(finest_level); k < levels_.size(); ++k) {
    const MapLevel& level = levels_[k];
    flipped.levels_[k] = {
        .width = level.width,
        .height = level.height,
        .resolution_m = level.resolution_m,
        .lower_left = {level.lower_left.x_m, -(level.lower_left.y_m + level.height * level.resolution_m)},
        .state = flipped_rows(level.state, level.width),
        .wall_distance_m = flipped_rows(level.wall_distance_m, level.width)};
  }
  if (finest_level == 0 && !occupancy_.empty()) {
    flipped.occupancy_ = flipped_rows(occupancy_, level(0).width);
  }
  // Row by row from below, as the constructor lists them.
  flipped.walls_.reserve(walls_.size());
  for (auto end = walls_.end(); end != walls_.begin();) {
    auto begin = end - 1;
    while (begin != walls_.begin() && (begin - 1)->at.y_m == begin->at.y_m) {
      --begin;
    }
    flipped.walls_.insert(flipped.walls_.end(), begin, end);
    end = begin;
  }
  for (WallPoint& wall : flipped.walls_) {
    wall.at.y_m = -wall.at.y_m;
    wall.free_normal.y_m = -wall.free_normal.y_m;
    wall.surface_normal.y_m = -wall.surface_normal.y_m;
  }
  return flipped;
}

double common_resolution_m(const OccupancyGrid& a, const OccupancyGrid& b, const PrepareOptions& options) {
  return std::max({a.geometry.resolution_m, b.geometry.resolution_m, options.finest_resolution_m});
}

Pose2 to_local(const Pose2& target_from_source, const PreparedMap& target, const PreparedMap& source) {
  return inverse(target.map_from_local()) * target_from_source * source.map_from_local();
}

Pose2 from_local(const Pose2& local_from_local, const PreparedMap& target, const PreparedMap& source) {
  return target.map_from_local() * local_from_local * inverse(source.map_from_local());
}

}  // namespace gridmerge
