#include "methods/features/feature_views.hpp"

#include <string>
#include <utility>

namespace gridmerge {
namespace {

Shape points(std::string label, std::vector<Point2> at) {
  return {.kind = Shape::Kind::kPoints, .label = std::move(label), .points = std::move(at)};
}

void show_over(TraceSink& trace, std::string name, std::string title, MapView view) {
  trace.on_view({.name = std::move(name), .title = std::move(title), .content = std::move(view)});
}

/// Keypoints of one map, and those of them that have a match.
void show_keypoints(TraceSink& trace, MapView::Map map, const std::vector<Point2>& keypoints,
                    std::vector<Point2> matched) {
  const std::string which = map == MapView::Map::kTarget ? "target" : "source";
  show_over(trace, "keypoints_" + which, "keypoints of the " + which + ", and the matched ones",
            {.map = map,
             .local_target_from_source = {},
             .shapes = {points("keypoints", keypoints), points("matched", std::move(matched))}});
}

}  // namespace

void show_matches(TraceSink& trace, const KeypointMatches& found, const std::vector<RansacPose>& poses) {
  std::vector<Point2> in_target;
  std::vector<Point2> in_source;
  for (const KeypointMatch& match : found.matches) {
    in_target.push_back(match.target);
    in_source.push_back(match.source);
  }
  show_keypoints(trace, MapView::Map::kTarget, found.target_keypoints, in_target);
  show_keypoints(trace, MapView::Map::kSource, found.source_keypoints, in_source);
  if (poses.empty()) {
    return;
  }
  const Pose2& pose = poses.front().pose;
  Shape inliers{.kind = Shape::Kind::kSegments, .label = "inliers", .points = {}};
  std::vector<Point2> ends;
  for (const KeypointMatch& match : poses.front().inliers) {
    inliers.points.push_back(match.target);
    inliers.points.push_back(pose * match.source);
    ends.push_back(match.target);
  }
  show_over(trace, "inliers", "matches that the first pose brings together, over both maps",
            {.map = MapView::Map::kBoth,
             .local_target_from_source = pose,
             .shapes = {points("matched keypoints", std::move(ends)), std::move(inliers)}});
}

}  // namespace gridmerge
