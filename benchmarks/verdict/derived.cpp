#include "verdict/derived.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace gridmerge::verdict_study {
namespace {

/// Calls `visit(cell index, centre in the map frame)` for every known cell, in order of storage.
template <typename Visit>
void for_each_known(const OccupancyGrid& grid, Visit&& visit) {
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      if (grid.at({column, row}) != kUnknown) {
        visit(CellIndex{column, row}, grid.geometry.cell_centre({column, row}));
      }
    }
  }
}

bool knows(const OccupancyGrid& grid, CellIndex cell) {
  return grid.geometry.contains(cell) && grid.at(cell) != kUnknown;
}

/// Free wherever a known cell of the grid lies within the reach, unknown elsewhere; larger than the grid by the reach.
OccupancyGrid grown(const OccupancyGrid& grid, double reach_m) {
  const int reach = static_cast<int>(std::ceil(reach_m / grid.geometry.resolution_m));
  const double margin_m = -reach * grid.geometry.resolution_m;
  OccupancyGrid result = unknown_grid({.width = grid.geometry.width + 2 * reach,
                                       .height = grid.geometry.height + 2 * reach,
                                       .resolution_m = grid.geometry.resolution_m,
                                       .map_from_grid = grid.geometry.map_from_grid * Pose2{margin_m, margin_m, 0}});
  for_each_known(grid, [&](CellIndex cell, Point2) {
    const auto [column, row] = cell;
    const bool inside = knows(grid, {column - 1, row}) && knows(grid, {column + 1, row}) &&
                        knows(grid, {column, row - 1}) && knows(grid, {column, row + 1});
    const int around = inside ? 0 : reach;  // what is near a cell inside is near one on the border, or known itself
    for (int dy = -around; dy <= around; ++dy) {
      for (int dx = -around; dx <= around; ++dx) {
        if (dx * dx + dy * dy <= around * around) {
          result.at({column + reach + dx, row + reach + dy}) = kFree;
        }
      }
    }
  });
  return result;
}

/// How far a point lies along a heading.
struct Along {
  double c, s;
  explicit Along(double heading_rad) : c(std::cos(heading_rad)), s(std::sin(heading_rad)) {}
  [[nodiscard]] double operator()(Point2 p) const { return c * p.x_m + s * p.y_m; }
};

/// What lies from `low_m` to `high_m` along a heading.
OccupancyGrid strip(const OccupancyGrid& grid, const Along& along, double low_m, double high_m) {
  OccupancyGrid kept = unknown_grid(grid.geometry);
  for_each_known(grid, [&](CellIndex cell, Point2 centre) {
    if (along(centre) >= low_m && along(centre) <= high_m) {
      kept.at(cell) = grid.at(cell);
    }
  });
  return kept;
}

constexpr double kEndless = 1e9;  // [m]

}  // namespace

KnownCells known_cells(const OccupancyGrid& grid) {
  KnownCells known;
  Point2 sum;
  std::size_t occupied = 0;
  for_each_known(grid, [&](CellIndex cell, Point2 centre) {
    sum = sum + centre;
    occupied += grid.at(cell) == kOccupied ? 1 : 0;
    ++known.count;
  });
  const double resolution_m = grid.geometry.resolution_m;
  known.area_m2 = static_cast<double>(known.count) * resolution_m * resolution_m;
  known.walls_m = static_cast<double>(occupied) * resolution_m;
  known.centre = known.count == 0 ? Point2{} : 1.0 / static_cast<double>(known.count) * sum;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for_each_known(grid, [&](CellIndex, Point2 centre) {
    const Point2 d = centre - known.centre;
    xx += d.x_m * d.x_m;
    xy += d.x_m * d.y_m;
    yy += d.y_m * d.y_m;
  });
  known.principal_rad = 0.5 * std::atan2(2 * xy, xx - yy);
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const std::int8_t cell : grid.cells) {
    hash = (hash ^ static_cast<std::uint8_t>(cell)) * 0x100000001b3U;
  }
  known.fingerprint = hash;
  return known;
}

OccupancyGrid erase_overlap(const OccupancyGrid& target, OccupancyGrid source, const Pose2& target_from_source,
                            double reach_m) {
  const OccupancyGrid near = grown(target, reach_m);
  for_each_known(source, [&](CellIndex cell, Point2 centre) {
    if (knows(near, near.geometry.cell_at(target_from_source * centre))) {
      source.at(cell) = kUnknown;
    }
  });
  return source;
}

std::pair<OccupancyGrid, OccupancyGrid> split_in_two(const OccupancyGrid& grid, double heading_rad, double share,
                                                     double gap_m) {
  const Along along(heading_rad);
  std::vector<double> places_m;
  for_each_known(grid, [&](CellIndex, Point2 centre) { places_m.push_back(along(centre)); });
  if (places_m.empty()) {
    return {grid, grid};
  }
  const auto middle = static_cast<std::ptrdiff_t>(share * static_cast<double>(places_m.size() - 1));
  std::nth_element(places_m.begin(), places_m.begin() + middle, places_m.end());
  const double line_m = places_m[static_cast<std::size_t>(middle)];
  return {strip(grid, along, -kEndless, line_m - gap_m / 2), strip(grid, along, line_m + gap_m / 2, kEndless)};
}

OccupancyGrid mirrored(OccupancyGrid grid) {
  const int height = grid.geometry.height;
  for (int row = 0; row < height / 2; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      std::swap(grid.at({column, row}), grid.at({column, height - 1 - row}));
    }
  }
  return grid;
}

std::optional<OccupancyGrid> cut_to_overlap(const OccupancyGrid& target, const OccupancyGrid& source,
                                            const Pose2& target_from_source, double heading_rad, double overlap) {
  constexpr double kLeastArea = 50;   // [m2]
  constexpr double kLeastCommon = 8;  // [m2]
  constexpr double kMostKept = 0.9;
  constexpr double kNearEnough = 0.02;
  const Along along(heading_rad);
  std::vector<std::pair<double, bool>> cells;  // how far along, known to the target
  for_each_known(source, [&](CellIndex, Point2 centre) {
    cells.emplace_back(along(centre), knows(target, target.geometry.cell_at(target_from_source * centre)));
  });
  std::sort(cells.rbegin(), cells.rend());
  const double cell_m2 = source.geometry.resolution_m * source.geometry.resolution_m;
  std::optional<double> line_m;
  double off = kNearEnough;
  double common = 0;
  for (std::size_t i = 0; i < cells.size() && static_cast<double>(i) < kMostKept * static_cast<double>(cells.size());
       ++i) {
    common += cells[i].second ? 1 : 0;
    const auto kept = static_cast<double>(i + 1);
    const double this_off = std::abs(common / kept - overlap);
    if (kept * cell_m2 >= kLeastArea && common * cell_m2 >= kLeastCommon && this_off < off) {
      off = this_off;
      line_m = cells[i].first;
    }
  }
  if (!line_m) {
    return std::nullopt;
  }
  return strip(source, along, *line_m, kEndless);
}

}  // namespace gridmerge::verdict_study
