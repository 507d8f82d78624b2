#pragma once
/// Keypoints of two maps seen as images, and which of them look alike.
#include <string>
#include <vector>

#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

/// Points are given in local frames.
struct KeypointMatch {
  Point2 target;
  Point2 source;
  double turn_rad = 0;  ///< by how much the look of the one is turned against that of the other
};

struct KeypointMatches {
  std::vector<Point2> target_keypoints;
  std::vector<Point2> source_keypoints;
  std::vector<KeypointMatch> matches;

  void append(const KeypointMatches& more);
};

enum class MapImage {
  kBytes,    ///< the occupancy's bytes as they are: free 0, occupied 100, unknown 255; level 0 only
  kShading,  ///< unknown half way between free and occupied, blurred
};

struct KeypointSearch {
  std::string detector = "akaze";  ///< "akaze" or "orb"
  MapImage image = MapImage::kShading;
  int level = 0;
  int max_keypoints = 2000;  ///< of each map, the strongest
  double threshold = 0.001;  ///< of the AKAZE detector's response
  int neighbours = 1;        ///< a keypoint is matched with this many that look most like it,
  double ratio = 1;          ///< each nearer than this share of the distance of the next one after them
};

/// Matched from either side; a match found from both counts once. In a fixed order. Deterministic.
[[nodiscard]] KeypointMatches match_keypoints(const PreparedMap& target, const PreparedMap& source,
                                              const KeypointSearch& search);

}  // namespace gridmerge
