#pragma once
/// Many robots in one world.
#include <vector>

#include "worlds/scene.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

struct Swarm {
  World world;
  std::vector<OccupancyGrid> maps;    ///< each in the frame of its robot's first pose
  std::vector<Pose2> world_from_map;  ///< exact
};

/// So many robots share a world out among them: each visits the places of its own part, and the nearest of those round
/// about, so that it overlaps with its neighbours. Kinds that grow are drawn the larger the more robots there are,
/// unless `length_m` says how long. Each robot's frame is turned by `rotation_deg` against that of the one before. The
/// bytes are the same at any number of threads.
/// @param robots  2..32
/// @throws std::invalid_argument listing the problems of the options: those of make_scene, and what only pairs have
/// (another relation than overlap, shares, a wanted overlap, a start that is not random); or a world with fewer places
/// than robots
[[nodiscard]] Swarm make_swarm(const SceneOptions& options, int robots, int num_threads = 1);

}  // namespace gridmerge::worlds
