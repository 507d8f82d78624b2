#include "gridmerge/grid/pieces.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace gridmerge {

std::vector<bool> in_small_pieces(const PreparedMap& map, double width_m) {
  const MapLevel& level = map.level(0);
  std::vector<bool> small(map.walls().size(), false);
  if (small.empty()) {
    return small;
  }
  cv::Mat occupied(level.height, level.width, CV_8UC1);
  std::transform(level.state.begin(), level.state.end(), occupied.begin<std::uint8_t>(),
                 [](CellState state) { return static_cast<std::uint8_t>(state == CellState::kWall ? 1 : 0); });
  cv::Mat labels;
  cv::Mat pieces;
  cv::Mat centres;
  cv::connectedComponentsWithStats(occupied, labels, pieces, centres, 8);
  for (std::size_t i = 0; i < small.size(); ++i) {
    const Point2f at = map.walls()[i].at;
    const auto column = static_cast<int>((at.x_m - level.lower_left.x_m) / level.resolution_m);
    const auto row = static_cast<int>((at.y_m - level.lower_left.y_m) / level.resolution_m);
    const int piece = labels.at<int>(row, column);
    const int widest = std::max(pieces.at<int>(piece, cv::CC_STAT_WIDTH), pieces.at<int>(piece, cv::CC_STAT_HEIGHT));
    small[i] = widest * level.resolution_m < width_m;
  }
  return small;
}

}  // namespace gridmerge
