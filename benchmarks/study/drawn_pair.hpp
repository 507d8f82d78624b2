#pragma once
/// The maps of a pair, or of a swarm, with what is true of them: drawn or read once, then used by many runs.
#include <memory>
#include <string>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"
#include "gridmerge/select/scene_features.hpp"
#include "study/study.hpp"

namespace gridmerge::study {

/// Const once made, so shared by any number of threads.
struct DrawnPair {
  std::vector<OccupancyGrid> maps;      ///< target and source; of a swarm all
  std::string truth;                    ///< same, different, unknown
  std::vector<Pose2> first_from_map;    ///< where the truth is "same": of every map, in the first one's frame
  std::vector<Point2> centre_in_map;    ///< of each map's known cells: where errors are measured
  std::vector<std::int64_t> walls;      ///< of each map: occupied cells
  std::vector<SceneFeatures> features;  ///< of a pair: of both maps
  double overlap = 0;                   ///< share of the source's known area that the target knows; NaN: not known
  std::shared_ptr<const PreparedMap> target;  ///< where asked for
  std::shared_ptr<const PreparedMap> source;
  std::size_t bytes = 0;  ///< about what it takes in memory
};

/// @param keep_prepared  fill in target and source, of a pair
/// @throws InputError if a map cannot be read
[[nodiscard]] DrawnPair draw(const PairChoice& choice, bool keep_prepared);

/// JSON: all that it takes to draw or read the maps again.
///
///     {"scene": {"kind": "office", ...}}    {"swarm": {...}, "robots": 4}    {"target": "A.yaml", "source": "B.yaml"}
[[nodiscard]] std::string spec_of(const PairChoice& choice);

}  // namespace gridmerge::study
