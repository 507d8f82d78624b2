#include "gridmerge/grid/occupancy_grid.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace gridmerge {
namespace {

void check_geometry(const GridGeometry& geometry) {
  if (geometry.width < 0 || geometry.height < 0) {
    throw std::invalid_argument("grid of " + std::to_string(geometry.width) + " x " + std::to_string(geometry.height) +
                                " cells: a size must not be negative");
  }
  if (!std::isfinite(geometry.resolution_m) || geometry.resolution_m <= 0) {
    throw std::invalid_argument("grid resolution " + std::to_string(geometry.resolution_m) +
                                " m: it must be finite and positive");
  }
  const Pose2& origin = geometry.map_from_grid;
  if (!std::isfinite(origin.x_m) || !std::isfinite(origin.y_m) || !std::isfinite(origin.theta_rad)) {
    throw std::invalid_argument("grid origin: x, y and yaw must be finite");
  }
}

}  // namespace

OccupancyGrid unknown_grid(const GridGeometry& geometry) {
  check_geometry(geometry);
  return {geometry, std::vector<std::int8_t>(geometry.cell_count(), kUnknown)};
}

void check_grid(const OccupancyGrid& grid) {
  check_geometry(grid.geometry);
  if (grid.cells.size() != grid.geometry.cell_count()) {
    throw std::invalid_argument("grid holds " + std::to_string(grid.cells.size()) + " cells, its geometry says " +
                                std::to_string(grid.geometry.cell_count()));
  }
  // One pass without branches, so that the compiler vectorises it: -1..100 becomes 0..101 as an unsigned byte.
  bool all_valid = true;
  for (const std::int8_t cell : grid.cells) {
    all_valid &= static_cast<std::uint8_t>(cell + 1) <= kOccupied + 1;
  }
  if (!all_valid) {
    const auto bad = std::find_if(grid.cells.begin(), grid.cells.end(),
                                  [](std::int8_t cell) { return cell < kUnknown || cell > kOccupied; });
    throw std::invalid_argument("grid cell value " + std::to_string(*bad) + ": cells must be -1 (unknown) or 0..100");
  }
}

}  // namespace gridmerge
