#pragma once
/// The list of map pairs with known truth.
#include <filesystem>
#include <string>
#include <vector>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge::thesis {

/// A row of the manifest whose maps show the same place.
struct KnownPair {
  std::filesystem::path target_yaml;
  std::filesystem::path source_yaml;
  Pose2 target_from_source;  ///< between the frames that the YAML files give
  double tolerance_m = 0;
  double tolerance_rad = 0;
  std::string scenario;  ///< first of the row's tags
};

/// Reads a CSV file with the columns a, b, truth, tx, ty, theta, tol_m, tol_deg, tags (others are passed over); paths
/// are relative to the file. Rows whose truth is not "same" are left out.
/// @throws InputError naming file, line and column
[[nodiscard]] std::vector<KnownPair> read_manifest(const std::filesystem::path& csv);

}  // namespace gridmerge::thesis
