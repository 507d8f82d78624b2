#pragma once
/// Which scenes are drawn to judge the verdict: worlds, relations, lidars and ways of mapping, mixed by chance.
#include <cstdint>
#include <string>

#include "worlds/scene.hpp"

namespace gridmerge::verdict_study {

struct DrawnScene {
  std::string kind;  ///< overlap, two_ends, two_worlds, two_buildings, two_floors, mirrored; ambiguous: corridor, hall
  worlds::SceneOptions options;
};

/// The scene of an index: every other one overlaps, the rest take turns among the relations that share nothing. The
/// same for the same seed and index on every machine.
[[nodiscard]] DrawnScene drawn_scene(std::uint64_t seed, std::uint64_t index);

}  // namespace gridmerge::verdict_study
