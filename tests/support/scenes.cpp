#include "support/scenes.hpp"

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include "gridmerge/base/random.hpp"

namespace gridmerge {

void PrintTo(const KnownPair& pair, std::ostream* out) { *out << pair.name; }

std::vector<KnownPair> known_pairs() {
  return {
      {.name = "office", .options = {.kind = "office"}},
      {.name = "office_small_overlap", .options = {.kind = "office", .target_share = 0.5, .source_share = 0.5}},
      {.name = "office_drift", .options = {.kind = "office", .drift_m = 0.01, .drift_deg = 0.15}},
      {.name = "office_probabilistic", .options = {.kind = "office", .probabilistic = true}},
      {.name = "maze", .options = {.kind = "maze"}},
      {.name = "flat", .options = {.kind = "flat", .target_share = 0.8, .source_share = 0.8}},
      {.name = "forest", .options = {.kind = "forest"}},
      {.name = "corridor", .options = {.kind = "corridor"}, .ambiguous = true},
      {.name = "hall", .options = {.kind = "hall", .target_share = 1, .source_share = 1}, .ambiguous = true},
      {.name = "two_ends", .options = {.kind = "office", .relation = "two_ends"}, .overlaps = false},
      {.name = "two_offices", .options = {.kind = "office", .relation = "two_worlds"}, .overlaps = false},
      {.name = "two_flats", .options = {.kind = "flat", .relation = "two_worlds"}, .overlaps = false},
      {.name = "mirrored", .options = {.kind = "office", .relation = "mirrored"}, .overlaps = false},
  };
}

worlds::SceneOptions known_pair(std::string_view name, int seed) {
  const std::vector<KnownPair> pairs = known_pairs();
  const auto found = std::find_if(pairs.begin(), pairs.end(), [&](const KnownPair& pair) { return pair.name == name; });
  if (found == pairs.end()) {
    throw std::invalid_argument("no known pair is called '" + std::string(name) + "'");
  }
  worlds::SceneOptions options = found->options;
  options.seed = seed;
  return options;
}

Point2 centre_of_known(const OccupancyGrid& grid) {
  Point2 sum;
  int known = 0;
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      if (grid.at({column, row}) != kUnknown) {
        sum = sum + grid.geometry.cell_centre({column, row});
        ++known;
      }
    }
  }
  return known == 0 ? Point2{} : 1.0 / known * sum;
}

PoseDifference pose_error(const worlds::MapPair& pair, const Pose2& target_from_source) {
  return difference_at(centre_of_known(pair.source), target_from_source, pair.target_from_source);
}

PreparedMap posts_and_walls(std::uint64_t seed, int width, int height) {
  OccupancyGrid grid = unknown_grid({.width = width, .height = height, .resolution_m = 0.05, .map_from_grid = {}});
  std::fill(grid.cells.begin(), grid.cells.end(), kFree);
  RandomStream random(seed, "posts and walls");
  for (int k = 0; k < 8; ++k) {
    const int column = static_cast<int>(random.below(static_cast<std::uint32_t>(width - 12)));
    const int row = static_cast<int>(random.below(static_cast<std::uint32_t>(height - 12)));
    const int length = 3 + static_cast<int>(random.below(9));
    const bool upright = random.below(2) == 0;
    for (int i = 0; i < length; ++i) {
      grid.at({column + (upright ? 0 : i), row + (upright ? i : 0)}) = kOccupied;
    }
  }
  return PreparedMap(grid, 0.05);
}

}  // namespace gridmerge
