#pragma once
/// The true ways of a scene's robots, without any mapping.
#include <vector>

#include "worlds/scene.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

/// One robot's: where it was when it scanned. Its map lies in the frame of the first pose.
struct Track {
  World world;
  Pose2 world_from_map;
  std::vector<Pose2> world_from_robot;
};

/// The frames of the two worlds are one, or a kilometre apart: MapPair::target_from_source.
struct Tracks {
  Track target;
  Track source;
};

/// Those of make_scene(options). With wanted_overlap that takes the search for the shares; without, milliseconds.
/// @throws std::invalid_argument listing the problems of the options
[[nodiscard]] Tracks tracks_of(const SceneOptions& options);
/// The same where the pair is drawn already: the search need not be made again.
/// @param pair  make_scene(options)
[[nodiscard]] Tracks tracks_of(const SceneOptions& options, const MapPair& pair);

}  // namespace gridmerge::worlds
