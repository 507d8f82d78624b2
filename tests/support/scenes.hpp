#pragma once
/// Pairs of maps with known truth, by name: what the tests of many units share.
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"
#include "worlds/scene.hpp"

namespace gridmerge {

/// A pair that a test asks for by name, and what is true of it.
struct KnownPair {
  std::string name;
  worlds::SceneOptions options;
  bool overlaps = true;    ///< false: the only right answer is not to merge
  bool ambiguous = false;  ///< nobody could tell from the maps where the source lies
};

/// How a failing test names it.
void PrintTo(const KnownPair& pair, std::ostream* out);

/// All of them. "flat" is the quickest: two maps of about 200 x 200 cells.
[[nodiscard]] std::vector<KnownPair> known_pairs();

/// The options of a known pair, with another seed.
/// @throws std::invalid_argument for an unknown name
[[nodiscard]] worlds::SceneOptions known_pair(std::string_view name, int seed = 1);

/// Centre of the known cells, in the map frame: where errors are measured. The origin for a grid without known cells.
[[nodiscard]] Point2 centre_of_known(const OccupancyGrid& grid);

/// How far an answer is off the truth, at the centre of the source's known cells.
[[nodiscard]] PoseDifference pose_error(const worlds::MapPair& pair, const Pose2& target_from_source);

/// Posts and short walls in a free field of so many cells of 0.05 m: a map small enough to try every pose.
[[nodiscard]] PreparedMap posts_and_walls(std::uint64_t seed, int width, int height);

}  // namespace gridmerge
