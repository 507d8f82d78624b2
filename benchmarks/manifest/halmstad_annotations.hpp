#pragma once
/// The hand-picked points of Halmstad-Robot-Maps: `annotations/keypoints_NAME.npy` and `association_A_B.npy`.
#include <filesystem>
#include <string>
#include <vector>

#include "worlds/point_fit.hpp"

namespace gridmerge {

/// Points of one map: a row each, x to the right and y up from the lower-left pixel's centre, in pixels.
/// @throws InputError naming file and rule
[[nodiscard]] std::vector<Point2> read_keypoints(const std::filesystem::path& annotations, const std::string& map);

/// The points that are marked in both maps, in pixels. The file may be of either order of the two: its columns are the
/// numbers of the points, from 0, in the maps of its name. A row with a negative number has no partner and is passed
/// over.
/// @throws InputError naming file and rule: no such file, two columns, whole numbers, points that there are, at least
/// three different ones
[[nodiscard]] std::vector<PointMatch> read_matches(const std::filesystem::path& annotations, const std::string& target,
                                                   const std::vector<Point2>& target_points, const std::string& source,
                                                   const std::vector<Point2>& source_points);

}  // namespace gridmerge
