#pragma once
/// The list of map pairs with known truth.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge {

/// Where the source lies, and how far off an answer may be at the centre of its known cells and still be right.
struct KnownPose {
  Pose2 target_from_source;  ///< between the frames that the YAML files give
  double tolerance_m = 0;
  double tolerance_rad = 0;
};

/// A row of the manifest.
struct ManifestPair {
  std::string set;
  std::string target_name;  ///< as written: relative to the manifest
  std::string source_name;
  std::filesystem::path target_yaml;
  std::filesystem::path source_yaml;
  std::optional<KnownPose> truth;  ///< none: the maps do not overlap
  std::string scenario;            ///< first of the row's tags
};

/// Reads a CSV file with the columns set, a, b, truth (same or different), tx, ty, theta, tol_m, tol_deg, tags (others
/// are passed over); paths are relative to the file.
/// @throws InputError naming file, line and column
[[nodiscard]] std::vector<ManifestPair> read_manifest(const std::filesystem::path& csv);

}  // namespace gridmerge
