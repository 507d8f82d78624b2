#pragma once
/// Several placed maps become one, by a named rule.
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/fuse/resample.hpp"

namespace gridmerge {

struct FuseOptions {
  std::string rule = "log_odds";
  double occupied_probability = 0.9;
  double free_probability = 0.1;
  int wall_margin_cells = 2;
  std::string output = "auto";
  int max_cells = 1 << 28;

  void describe(OptionList& list);
};

/// The first map is the target. The merged map lies in the frame in which the maps are placed, and its cells are the
/// target's own cells, continued: the target's resolution and yaw, its whole rectangle, and an origin that differs from
/// the target's by whole cells. It reaches as far as any map knows a cell. A cell that one map alone knows keeps that
/// map's value.
///
/// Each map is brought to the target's cells once, so walls do not wear out, however many maps there are.
/// The answer is the same at any number of threads; memory is one byte a merged cell.
///
/// @throws std::invalid_argument if there is no map, one is malformed (see check_grid) or placed at a pose that is not
/// finite, an option is out of range, or the merged map would have more than max_cells cells
[[nodiscard]] OccupancyGrid fuse(const std::vector<PlacedMap>& maps, const FuseOptions& options = {},
                                 int num_threads = 1);

}  // namespace gridmerge
