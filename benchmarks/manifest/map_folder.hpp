#pragma once
/// A folder of maps as map_server keeps them, and the pairs that can be made of it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "manifest/manifest.hpp"

namespace gridmerge {

/// One map of a folder.
struct FolderMap {
  std::string name;  ///< of its YAML file
  std::filesystem::path yaml;
  std::optional<Pose2> world_from_map;  ///< none: not told
};

/// What lies in a folder.
struct MapFolder {
  std::string name;             ///< of the folder
  std::vector<FolderMap> maps;  ///< by name
};

/// Lists the maps: every .yaml or .yml file that has the key `image` (others are passed over). Subfolders are not
/// looked into. If there is a file `world.csv` with the columns map, x, y, theta, it gives the poses [m, rad] of the
/// maps' frames in one world frame. No image is read, but each must be there.
/// @throws InputError with a line for every problem: no folder, no map in it, a YAML file that is none or breaks a
/// rule, an image that is not there, a row of world.csv for no map or for one that has a row already
[[nodiscard]] MapFolder read_map_folder(const std::filesystem::path& folder);

struct FolderPairOptions {
  bool both_orders = false;
  double tolerance_m = 1;
  double tolerance_deg = 5;
  double least_overlap = 0.05;

  void describe(OptionList& list);
};

/// Every pair of maps, in the order of their names, the first of two as target; set and names are those of the folder.
/// Where both poses are told the maps are read (on up to `num_threads` threads): overlap and source_centre are filled
/// in, and the truth is `same` from `least_overlap` of the source's known area on, `different` where nothing is shared,
/// not known between. Where a pose is missing the truth is not known.
/// @throws InputError if a map cannot be read; std::invalid_argument listing the options out of range
[[nodiscard]] std::vector<ManifestPair> pairs_of(const MapFolder& folder, const FolderPairOptions& options = {},
                                                 int num_threads = 1);

}  // namespace gridmerge
