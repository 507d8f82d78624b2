#pragma once
/// The pairs of maps on which the verdict is judged, and from which its weights are fitted.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "manifest/manifest.hpp"
#include "worlds/scene.hpp"

namespace gridmerge::verdict_study {

/// What pairs to make. All chance comes from `seed`.
struct PairOptions {
  std::vector<std::filesystem::path> manifests;
  /// Sets that show the same building, at least in part: no pair of kind `cross` joins two of a group.
  std::vector<std::vector<std::string>> same_building;
  int cross = 320;  ///< pairs of maps of different buildings
  int scenes = 0;   ///< drawn
  std::uint64_t seed = 1;
  int threads = 1;  ///< they do not change the pairs
};

/// How to make one pair; small, so that there may be thousands.
struct PairPlan {
  std::string kind;    ///< pair, erased, split, cross, cut; drawn: overlap, two_worlds, mirrored, two_ends, ambiguous
  std::string set;     ///< the target's manifest set, or the kind of world drawn
  std::string places;  ///< every building that the pair shows, joined by '+'
  std::string target_name;
  std::string source_name;
  std::filesystem::path target_yaml;  ///< empty: drawn
  std::filesystem::path source_yaml;
  std::optional<KnownPose> truth;  ///< of the pair that it is made from
  worlds::SceneOptions scene;
  std::uint64_t seed = 1;
  std::uint64_t index = 0;  ///< with the seed and the kind: its chance
};

/// Every pair of the manifests, what can be derived from them, and the scenes, in a fixed order.
/// @throws InputError for a manifest or a map that cannot be read, or a set in `same_building` that no manifest has
[[nodiscard]] std::vector<PairPlan> plan_pairs(const PairOptions& options);

/// The maps of one pair.
struct StudyPair {
  OccupancyGrid target;
  OccupancyGrid source;
  std::string truth;              ///< same, different, or ambiguous: no single pose is the right one
  std::optional<KnownPose> pose;  ///< where the robots were, unless the truth is "different"
  double met_residual_m = 0;      ///< drawn: how bent the maps are where they meet (worlds::MapPair)
  double overlap = 0;             ///< share of the source's known area that the target knows, 0..1
};

/// None where the derived maps would be too small to say anything.
/// @throws InputError for a map that cannot be read
[[nodiscard]] std::optional<StudyPair> build_pair(const PairPlan& plan);

}  // namespace gridmerge::verdict_study
