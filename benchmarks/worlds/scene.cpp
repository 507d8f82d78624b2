#include "worlds/scene.hpp"

#include <utility>

#include "worlds/shares.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::worlds {
namespace {

void require_no_problems(const SceneOptions& options) {
  const std::vector<std::string> problems = scene_problems(options);
  if (!problems.empty()) {
    throw_invalid_options("scene", problems);
  }
}

Tracks tracks_with(const SceneOptions& options, double target_flown) {
  return {flight_of(options, Role::kTarget, target_flown).track, flight_of(options, Role::kSource).track};
}

}  // namespace

MapPair make_scene(const SceneOptions& options) {
  require_no_problems(options);
  return options.wanted_overlap > 0 ? draw_with_overlap(options) : draw_with_shares(options, 1);
}

Tracks tracks_of(const SceneOptions& options) {
  require_no_problems(options);
  return options.wanted_overlap > 0 ? tracks_of(options, draw_with_overlap(options)) : tracks_with(options, 1);
}

Tracks tracks_of(const SceneOptions& options, const MapPair& pair) {
  SceneOptions settled = options;
  if (options.wanted_overlap > 0) {
    settled.target_share = pair.target_share;
    settled.source_share = pair.source_share;
  }
  return tracks_with(settled, pair.target_flown);
}

double overlap_of(const OccupancyGrid& target, const OccupancyGrid& source, const Pose2& target_from_source) {
  std::size_t known = 0;
  std::size_t shared = 0;
  for (int row = 0; row < source.geometry.height; ++row) {
    for (int column = 0; column < source.geometry.width; ++column) {
      if (source.at({column, row}) == kUnknown) {
        continue;
      }
      ++known;
      const CellIndex cell = target.geometry.cell_at(target_from_source * source.geometry.cell_centre({column, row}));
      shared += target.geometry.contains(cell) && target.at(cell) != kUnknown ? 1 : 0;
    }
  }
  return known == 0 ? 0 : static_cast<double>(shared) / static_cast<double>(known);
}

}  // namespace gridmerge::worlds
