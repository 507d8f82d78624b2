#include "methods/features/keypoints.hpp"

#include <algorithm>
#include <cassert>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace gridmerge {
namespace {

std::uint8_t shade(CellState state) {
  switch (state) {
    case CellState::kOpen:
      return 255;
    case CellState::kWall:
      return 0;
    default:
      return 128;
  }
}

/// Row 0 is the map's lowest, so that pixel angles are angles in the local frame.
cv::Mat image_of(const PreparedMap& map, const KeypointSearch& search) {
  assert(search.image != MapImage::kBytes || search.level == 0);
  const MapLevel& level = map.level(search.level);
  cv::Mat image(level.height, level.width, CV_8UC1);
  std::uint8_t* pixels = image.data;
  for (std::size_t i = 0; i < level.state.size(); ++i) {
    pixels[i] =
        search.image == MapImage::kBytes ? static_cast<std::uint8_t>(map.occupancy()[i]) : shade(level.state[i]);
  }
  if (search.image == MapImage::kShading) {
    cv::GaussianBlur(image, image, {}, 1.2);
  }
  return image;
}

/// The keypoints of one map.
struct Found {
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
};

Found keypoints_of(const PreparedMap& map, const KeypointSearch& search) {
  const cv::Mat image = image_of(map, search);
  Found found;
  if (search.detector == "orb") {
    constexpr float kScale = 1.3F;  // as in OpenCV's stitching, which the nodes build on
    constexpr int kScales = 5;
    const auto orb = cv::ORB::create(search.max_keypoints, kScale, kScales);
    orb->detectAndCompute(image, cv::noArray(), found.keypoints, found.descriptors);
    return found;
  }
  const auto akaze = cv::AKAZE::create(cv::AKAZE::DESCRIPTOR_MLDB, 0, 3, static_cast<float>(search.threshold));
  akaze->detect(image, found.keypoints);
  // The strongest, ties in the order of detection.
  std::stable_sort(found.keypoints.begin(), found.keypoints.end(),
                   [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
  found.keypoints.resize(std::min(found.keypoints.size(), static_cast<std::size_t>(search.max_keypoints)));
  akaze->compute(image, found.keypoints, found.descriptors);
  return found;
}

Point2 place_of(const cv::KeyPoint& keypoint, const MapLevel& level) {
  return {level.lower_left.x_m + (static_cast<double>(keypoint.pt.x) + 0.5) * level.resolution_m,
          level.lower_left.y_m + (static_cast<double>(keypoint.pt.y) + 0.5) * level.resolution_m};
}

std::vector<Point2> places_of(const Found& found, const MapLevel& level) {
  std::vector<Point2> places;
  for (const cv::KeyPoint& keypoint : found.keypoints) {
    places.push_back(place_of(keypoint, level));
  }
  return places;
}

/// Index pairs (of one, of other): for each of the one, those of the other that look most like it.
std::vector<std::pair<int, int>> alike(const Found& one, const Found& other, const KeypointSearch& search) {
  std::vector<std::pair<int, int>> pairs;
  if (one.descriptors.rows == 0 || other.descriptors.rows == 0) {
    return pairs;
  }
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(one.descriptors, other.descriptors, nearest, search.neighbours + 1);
  for (const std::vector<cv::DMatch>& ranked : nearest) {
    const auto asked = static_cast<std::size_t>(search.neighbours);
    if (ranked.size() <= asked) {
      continue;  // nothing to be compared with
    }
    const double bar = search.ratio * static_cast<double>(ranked[asked].distance);
    for (std::size_t k = 0; k < asked; ++k) {
      if (search.ratio >= 1 || static_cast<double>(ranked[k].distance) < bar) {
        pairs.emplace_back(ranked[k].queryIdx, ranked[k].trainIdx);
      }
    }
  }
  return pairs;
}

}  // namespace

void KeypointMatches::append(const KeypointMatches& more) {
  target_keypoints.insert(target_keypoints.end(), more.target_keypoints.begin(), more.target_keypoints.end());
  source_keypoints.insert(source_keypoints.end(), more.source_keypoints.begin(), more.source_keypoints.end());
  matches.insert(matches.end(), more.matches.begin(), more.matches.end());
}

KeypointMatches match_keypoints(const PreparedMap& target, const PreparedMap& source, const KeypointSearch& search) {
  const Found in_target = keypoints_of(target, search);
  const Found in_source = keypoints_of(source, search);
  KeypointMatches result{.target_keypoints = places_of(in_target, target.level(search.level)),
                         .source_keypoints = places_of(in_source, source.level(search.level)),
                         .matches = {}};
  std::vector<std::pair<int, int>> pairs = alike(in_target, in_source, search);
  for (const auto& [s, t] : alike(in_source, in_target, search)) {
    pairs.emplace_back(t, s);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [t, s] : pairs) {
    const auto at = static_cast<std::size_t>(t);
    const auto from = static_cast<std::size_t>(s);
    const auto turn_deg = static_cast<double>(in_target.keypoints[at].angle - in_source.keypoints[from].angle);
    result.matches.push_back(
        {result.target_keypoints[at], result.source_keypoints[from], wrap_angle(radians(turn_deg))});
  }
  return result;
}

}  // namespace gridmerge
