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

  friend bool operator==(const KnownPose&, const KnownPose&) = default;
};

/// A row of the manifest.
struct ManifestPair {
  std::string set;
  std::string target_name;  ///< as written: relative to the manifest
  std::string source_name;
  std::filesystem::path target_yaml;
  std::filesystem::path source_yaml;
  std::optional<KnownPose> truth;  ///< none: the maps do not overlap, unless `truth_known` says that nobody knows
  std::string scenario = {};       ///< first of the row's tags
  std::string tags = {};           ///< all of them, a space between two
  std::optional<Point2> source_centre = {};  ///< of the source's known cells, in the source's frame
  std::optional<double> overlap = {};        ///< share of the source's known area that the target has seen, 0..1
  bool truth_known = true;                   ///< of a pair that was read from a manifest: always

  friend bool operator==(const ManifestPair&, const ManifestPair&) = default;
};

/// Reads a CSV file with the columns set, a, b, truth (same or different), tx, ty, theta, tol_m, tol_deg, tags and, if
/// they are there, cx, cy and overlap (others are passed over); paths are relative to the file.
/// @throws InputError naming file, line and column
[[nodiscard]] std::vector<ManifestPair> read_manifest(const std::filesystem::path& csv);

/// The manifest as text, with all of these columns in the order that the referee's form has them. What read_manifest
/// makes of it is equal to `pairs`, if the file stands where the names lead to the maps.
/// @param csv  the file it is for, for messages
/// @throws InputError naming file, line and column, if a name or a tag cannot stand in a CSV cell;
/// std::invalid_argument if a truth is not known, or a pair with a pose has no source_centre
[[nodiscard]] std::string manifest_text(const std::filesystem::path& csv, const std::vector<ManifestPair>& pairs);

/// Writes manifest_text, whole or not at all.
/// @throws as manifest_text, and InputError naming the file, if it cannot be written
void write_manifest(const std::filesystem::path& csv, const std::vector<ManifestPair>& pairs);

}  // namespace gridmerge
