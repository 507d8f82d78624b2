#include "gridmerge/grid/pieces.hpp"

#include <algorithm>
#include <limits>
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
  const int pieces = cv::connectedComponents(occupied, labels, 8);
  const auto cell_of = [&](const WallPoint& wall) {
    return cv::Point(static_cast<int>((wall.at.x_m - level.lower_left.x_m) / level.resolution_m),
                     static_cast<int>((wall.at.y_m - level.lower_left.y_m) / level.resolution_m));
  };
  struct Box {
    cv::Point low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
    cv::Point high{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
  };
  std::vector<Box> boxes(static_cast<std::size_t>(pieces));
  for (const WallPoint& wall : map.walls()) {
    const cv::Point cell = cell_of(wall);
    Box& box = boxes[static_cast<std::size_t>(labels.at<int>(cell))];
    box.low = {std::min(box.low.x, cell.x), std::min(box.low.y, cell.y)};
    box.high = {std::max(box.high.x, cell.x), std::max(box.high.y, cell.y)};
  }
  for (std::size_t i = 0; i < small.size(); ++i) {
    const Box& box = boxes[static_cast<std::size_t>(labels.at<int>(cell_of(map.walls()[i])))];
    const int widest = std::max(box.high.x - box.low.x, box.high.y - box.low.y) + 1;
    small[i] = widest * level.resolution_m < width_m;
  }
  return small;
}

}  // namespace gridmerge
