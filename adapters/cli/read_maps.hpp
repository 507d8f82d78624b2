#pragma once
/// The maps named on the command line.
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::cli {

/// Reads all, up to `num_threads` at a time.
/// @throws InputError for the first, in the order given, that cannot be read
[[nodiscard]] std::vector<OccupancyGrid> read_maps(const std::vector<std::string>& files, int num_threads);

}  // namespace gridmerge::cli
