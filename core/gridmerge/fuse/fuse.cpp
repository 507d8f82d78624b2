#include "gridmerge/fuse/fuse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// Evidence in thousandths of a nat: sums of integers are the same in any order.
class LogOdds {
 public:
  LogOdds(double free_probability, double occupied_probability) {
    for (int value = 0; value <= kOccupied; ++value) {
      const double p = std::clamp(value / 100.0, free_probability, occupied_probability);
      of_[static_cast<std::size_t>(value)] = static_cast<int>(std::lround(1000 * std::log(p / (1 - p))));
    }
    for (int sum = -kLimit; sum <= kLimit; ++sum) {
      percent_[static_cast<std::size_t>(sum + kLimit)] =
          static_cast<std::int8_t>(std::lround(100 / (1 + std::exp(-sum / 1000.0))));
    }
  }
  [[nodiscard]] int of(std::int8_t value) const { return of_[static_cast<std::size_t>(value)]; }
  [[nodiscard]] std::int8_t percent(int sum) const {
    return percent_[static_cast<std::size_t>(std::clamp(sum, -kLimit, kLimit) + kLimit)];
  }

 private:
  static constexpr int kLimit = 6000;  // 99.75 %
  std::array<int, 101> of_{};
  std::array<std::int8_t, 2 * kLimit + 1> percent_{};
};

/// What one map says of the cells of a tile and of an apron round it.
struct Layer {
  std::vector<std::int8_t> cells;
  std::vector<std::uint8_t> near_wall;  ///< 1 within the margin of a wall of this map
};

/// The maps that know anything there, the target first.
using Layers = std::vector<Layer>;

/// Order-independent Bayes with the same prior everywhere: the sum of log-odds.
struct LogOddsRule {
  const LogOdds& evidence;

  std::int8_t operator()(const Layers& layers, std::size_t count, std::size_t cell) const {
    int sum = 0;
    int near_wall = 0;  // the part of the sum that free cells close to their own map's wall gave
    int known = 0;
    bool wall = false;
    std::int8_t last = kUnknown;
    for (std::size_t layer = 0; layer < count; ++layer) {
      const std::int8_t value = layers[layer].cells[cell];
      if (value < 0) {
        continue;
      }
      const int odds = evidence.of(value);
      sum += odds;
      near_wall += odds < 0 && layers[layer].near_wall[cell] != 0 ? odds : 0;
      wall |= value > kUndecided;
      last = value;
      ++known;
    }
    return known <= 1 ? last : evidence.percent(wall ? sum - near_wall : sum);
  }
};

struct MaxRule {
  std::int8_t operator()(const Layers& layers, std::size_t count, std::size_t cell) const {
    std::int8_t highest = kUnknown;
    for (std::size_t layer = 0; layer < count; ++layer) {
      highest = std::max(highest, layers[layer].cells[cell]);
    }
    return highest;
  }
};

/// Eq. 2.15-2.17 [saeedi2012], for more than two maps one after the other (Eq. 1.2). Entropy (2.15) falls as the
/// log-odds leave 0 on either side, so the mutual information (2.16) is >= 0 where they have not come closer to 0.
struct EntropyRule {
  const LogOdds& evidence;

  std::int8_t operator()(const Layers& layers, std::size_t count, std::size_t cell) const {
    std::int8_t result = kUnknown;
    int odds = 0;  // unknown: probability 1/2, highest entropy
    for (std::size_t layer = 0; layer < count; ++layer) {
      const std::int8_t value = layers[layer].cells[cell];
      if (value < 0) {
        continue;
      }
      const int fused = odds + evidence.of(value);
      if (result == kUnknown) {
        result = value;
        odds = fused;
      } else if (std::abs(fused) >= std::abs(odds)) {  // Eq. 2.17
        result = evidence.percent(fused);
        odds = fused;
      }
    }
    return result;
  }
};

struct KeepTargetRule {
  std::int8_t operator()(const Layers& layers, std::size_t count, std::size_t cell) const {
    for (std::size_t layer = 0; layer < count; ++layer) {
      if (layers[layer].cells[cell] >= 0) {
        return layers[layer].cells[cell];
      }
    }
    return kUnknown;
  }
};

/// The target's cells, continued as far as any map knows a cell.
GridGeometry merged_geometry(const std::vector<PlacedMap>& maps, int max_cells) {
  constexpr double kDustCells = 1e-3;  // what rounding may put outside a cell
  const GridGeometry& target = maps.front().grid->geometry;
  const Pose2 merged_from_grid = maps.front().merged_from_map * target.map_from_grid;
  double left = 0;
  double bottom = 0;
  double right = target.width;
  double top = target.height;
  for (std::size_t index = 1; index < maps.size(); ++index) {
    if (const auto bounds = known_bounds(maps[index], inverse(merged_from_grid))) {
      left = std::min(left, std::floor(bounds->low.x_m / target.resolution_m + kDustCells));
      bottom = std::min(bottom, std::floor(bounds->low.y_m / target.resolution_m + kDustCells));
      right = std::max(right, std::ceil(bounds->high.x_m / target.resolution_m - kDustCells));
      top = std::max(top, std::ceil(bounds->high.y_m / target.resolution_m - kDustCells));
    }
  }
  const double width = right - left;
  const double height = top - bottom;
  if (!(std::max(width, 1.0) * std::max(height, 1.0) <= max_cells)) {
    throw std::invalid_argument("fuse: the merged map would have " + std::to_string(width) + " x " +
                                std::to_string(height) + " cells, more than max_cells = " + std::to_string(max_cells));
  }
  const Point2 corner = merged_from_grid * Point2{left * target.resolution_m, bottom * target.resolution_m};
  return {static_cast<int>(width),
          static_cast<int>(height),
          target.resolution_m,
          {corner.x_m, corner.y_m, merged_from_grid.theta_rad}};
}

bool is_ternary(const PlacedMap& map) {
  return std::all_of(map.grid->cells.begin(), map.grid->cells.end(),
                     [](std::int8_t cell) { return cell == kUnknown || cell == kFree || cell == kOccupied; });
}

/// Marks all cells within `margin` columns and rows of a wall.
void mark_near_wall(Layer& layer, const CellBox& box, int margin) {
  std::fill(layer.near_wall.begin(), layer.near_wall.end(), std::uint8_t{0});
  for (int row = 0; row < box.height; ++row) {
    for (int column = 0; column < box.width; ++column) {
      if (layer.cells[static_cast<std::size_t>(row * box.width + column)] <= kUndecided) {
        continue;
      }
      const int first = std::max(0, column - margin);
      const int last = std::min(box.width - 1, column + margin);
      for (int near_row = std::max(0, row - margin); near_row <= std::min(box.height - 1, row + margin); ++near_row) {
        std::fill_n(layer.near_wall.begin() + near_row * box.width + first, last - first + 1, std::uint8_t{1});
      }
    }
  }
}

std::int8_t to_ternary(std::int8_t value) {
  return value < 0 ? kUnknown : value >= kUndecided ? kOccupied : kFree;  // a tie is a wall: the safe side
}

template <typename Rule>
OccupancyGrid fuse_by(const Rule& rule, const std::vector<PlacedMap>& maps, const FuseOptions& options, int margin,
                      int num_threads) {
  OccupancyGrid merged = unknown_grid(merged_geometry(maps, options.max_cells));
  const bool ternary =
      options.output == "ternary" || (options.output == "auto" && std::all_of(maps.begin(), maps.end(), is_ternary));
  std::vector<Resampler> resamplers;
  for (const PlacedMap& map : maps) {
    resamplers.emplace_back(map, merged.geometry);
  }
  const std::vector<CellBox> boxes = tiles(merged.geometry);
  std::vector<Layers> layers_of_worker(static_cast<std::size_t>(std::max(1, num_threads)), Layers(maps.size()));
  parallel_for(boxes.size(), num_threads, [&](std::size_t index, std::size_t worker) {
    const CellBox& tile = boxes[index];
    const CellBox apron{
        {tile.first.column - margin, tile.first.row - margin}, tile.width + 2 * margin, tile.height + 2 * margin};
    Layers& layers = layers_of_worker[worker];
    std::size_t count = 0;  // of layers that know anything here
    for (const Resampler& resampler : resamplers) {
      layers[count].cells.resize(apron.cell_count());
      layers[count].near_wall.resize(apron.cell_count());
      count += resampler.read(apron, layers[count].cells) ? 1 : 0;
    }
    for (std::size_t layer = 0; margin > 0 && count > 1 && layer < count; ++layer) {
      mark_near_wall(layers[layer], apron, margin);
    }
    for (int row = 0; row < tile.height && count > 0; ++row) {
      const auto first = static_cast<std::size_t>((row + margin) * apron.width + margin);
      std::int8_t* out = merged.cells.data() + merged.geometry.offset({tile.first.column, tile.first.row + row});
      if (count == 1) {
        std::copy_n(layers.front().cells.data() + first, tile.width, out);
      } else {
        for (int column = 0; column < tile.width; ++column) {
          out[column] = rule(layers, count, first + static_cast<std::size_t>(column));
        }
      }
      if (ternary) {
        std::transform(out, out + tile.width, out, to_ternary);
      }
    }
  });
  return merged;
}

}  // namespace

void FuseOptions::describe(OptionList& list) {
  list.add(
      "rule", rule, {"log_odds", "max", "entropy", "keep_target"},
      {"", "How a cell's value is made of what several maps say of it.",
       "log_odds weighs all maps alike; max never clears an obstacle; entropy and keep_target favour the target."});
  list.add("occupied_probability", occupied_probability, 0.51, 0.999,
           {"", "The most that one map's occupied cell counts for, also of a map that knows only free and occupied.",
            "Raise it where a missed obstacle hurts more than a ghost. Used by log_odds and entropy."});
  list.add("free_probability", free_probability, 0.001, 0.49,
           {"", "The least that one map's free cell counts for, also of a map that knows only free and occupied.",
            "Below 1 - occupied_probability, one map's free space clears another's obstacle. Used by log_odds and "
            "entropy."});
  list.add("wall_margin_cells", wall_margin_cells, 0, 20,
           {"cells", "How close to its own wall a map's free space does not count against another map's wall.",
            "Raise it where walls vanish because maps are bent; walls become as thick as they are misplaced. Used by "
            "log_odds."});
  list.add("output", output, {"auto", "ternary", "probability"},
           {"", "Whether merged cells are free or occupied only, or any probability.",
            "auto: ternary when every map is. ternary counts 50 % as occupied."});
  list.add("max_cells", max_cells, 1, std::numeric_limits<int>::max(),
           {"cells", "The largest merged map, at one byte a cell; a larger one is refused before memory is taken.",
            "Raise it for very large sites."});
}

OccupancyGrid fuse(const std::vector<PlacedMap>& maps, const FuseOptions& options, int num_threads) {
  require_valid(options, "fuse");
  if (maps.empty()) {
    throw std::invalid_argument("fuse: there must be at least one map");
  }
  for (const PlacedMap& map : maps) {
    check_placed_map(map, "fuse");
  }
  const LogOdds evidence(options.free_probability, options.occupied_probability);
  if (options.rule == "max") {
    return fuse_by(MaxRule{}, maps, options, 0, num_threads);
  }
  if (options.rule == "entropy") {
    return fuse_by(EntropyRule{evidence}, maps, options, 0, num_threads);
  }
  if (options.rule == "keep_target") {
    return fuse_by(KeepTargetRule{}, maps, options, 0, num_threads);
  }
  return fuse_by(LogOddsRule{evidence}, maps, options, options.wall_margin_cells, num_threads);
}

}  // namespace gridmerge
