#pragma once
/// What every converter of a data set gives: maps as map_server keeps them, and a manifest.
#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "manifest/manifest.hpp"

namespace gridmerge {

/// What came of a conversion.
struct Conversion {
  std::size_t maps = 0;
  std::size_t pairs = 0;              ///< in pairs.csv; 0: there is no such file
  std::vector<std::string> left_out;  ///< "file: why", of what is no part of the result
};

/// A map to be written, by the name that its files get.
struct NamedGrid {
  std::string name;  ///< without extension
  OccupancyGrid grid;
  Point2 centre;  ///< of its known cells
};

/// Writes NAME.yaml and NAME.png (free, occupied, unknown) for every map and, if there are pairs, pairs.csv: all of
/// them or none. The folder must exist.
/// @throws InputError naming the file that cannot be written, or that two maps have one name
void write_conversion(const std::filesystem::path& out, const std::vector<NamedGrid>& maps,
                      const std::vector<ManifestPair>& pairs);

/// @throws InputError if `out` is no folder, or the one that is read
void check_output_folder(const std::filesystem::path& in, const std::filesystem::path& out);

/// A pair of two of the maps, its numbers no finer than hand-picked points are: 0.1 mm, 1e-6 rad.
/// @param tags  a space between two
[[nodiscard]] ManifestPair pair_of(const std::string& set, const NamedGrid& target, const NamedGrid& source,
                                   const std::optional<KnownPose>& truth, const std::string& tags);

}  // namespace gridmerge
