#include "study/curve.hpp"

#include <cmath>
#include <limits>

namespace gridmerge::study {

double acceptance_index(const PreparedMap& target, const PreparedMap& source, const Pose2& target_from_source) {
  const MapLevel& fixed = target.level(0);
  const MapLevel& moving = source.level(0);
  const Pose2 local = to_local(target_from_source, target, source);
  const double c = std::cos(local.theta_rad);
  const double s = std::sin(local.theta_rad);
  std::int64_t agreeing = 0;
  std::int64_t disagreeing = 0;
  for (int row = 0; row < moving.height; ++row) {
    const double y_m = moving.lower_left.y_m + (row + 0.5) * moving.resolution_m;
    for (int column = 0; column < moving.width; ++column) {
      const CellState in_source = moving.state[moving.offset(column, row)];
      if (in_source == CellState::kUnseen) {
        continue;
      }
      const double x_m = moving.lower_left.x_m + (column + 0.5) * moving.resolution_m;
      const double at_x = (c * x_m - s * y_m + local.x_m - fixed.lower_left.x_m) / fixed.resolution_m;
      const double at_y = (s * x_m + c * y_m + local.y_m - fixed.lower_left.y_m) / fixed.resolution_m;
      const auto to_column = static_cast<int>(std::floor(at_x));
      const auto to_row = static_cast<int>(std::floor(at_y));
      if (!fixed.contains(to_column, to_row)) {
        continue;
      }
      const CellState in_target = fixed.state[fixed.offset(to_column, to_row)];
      if (in_target != CellState::kUnseen) {
        ++(in_target == in_source ? agreeing : disagreeing);
      }
    }
  }
  const std::int64_t both = agreeing + disagreeing;
  return both == 0 ? 0 : static_cast<double>(agreeing) / static_cast<double>(both);
}

std::vector<CurvePoint> CurveRecorder::curve(std::int64_t run, const DrawnPair& pair) const {
  constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  std::vector<CurvePoint> points;
  const Best* last = nullptr;
  for (const Best& best : best_) {
    CurvePoint point = {.run = run, .iteration = static_cast<int>(points.size()), .fitness = best.score};
    if (last != nullptr && last->target_from_source == best.target_from_source) {  // measured already
      point.acceptance_index = points.back().acceptance_index;
      point.error_m = points.back().error_m;
      point.error_deg = points.back().error_deg;
    } else {
      point.acceptance_index = acceptance_index(*pair.target, *pair.source, best.target_from_source);
      point.error_m = point.error_deg = kNotKnown;
      if (pair.truth == "same") {
        const PoseDifference error =
            difference_at(pair.centre_in_map[1], best.target_from_source, pair.first_from_map[1]);
        point.error_m = error.distance_m;
        point.error_deg = degrees(error.angle_rad);
      }
    }
    points.push_back(point);
    last = &best;
  }
  return points;
}

}  // namespace gridmerge::study
