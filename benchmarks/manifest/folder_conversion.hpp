#pragma once
/// A folder of maps turned into a data set of its own.
#include <filesystem>

#include "manifest/conversion.hpp"
#include "manifest/map_folder.hpp"

namespace gridmerge {

/// Reads every map of a folder, as read_map_folder finds them, and writes it to `out` as free, occupied and unknown
/// cells, and what world.csv tells as pairs.csv. Pairs whose truth is not known are left out and named.
/// @throws InputError naming every file and rule broken; std::invalid_argument for options out of range
Conversion convert_folder(const std::filesystem::path& path, const std::filesystem::path& out,
                          const FolderPairOptions& options = {}, int num_threads = 1);

}  // namespace gridmerge
