#include "page/convergence.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

namespace gridmerge::page {
namespace {

using study::CurvePoint;

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

double first_with(std::span<const CurvePoint> curve, double share) {
  const double wanted = share * curve.back().fitness;
  if (!(curve.back().fitness > 0)) {
    return kNever;
  }
  const auto found =
      std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& point) { return point.fitness >= wanted; });
  return found == curve.end() ? kNever : found->iteration;
}

double settled_at(std::span<const CurvePoint> curve, const study::Row& row) {
  double at = kNever;
  for (auto point = curve.rbegin(); point != curve.rend(); ++point) {
    if (!(point->error_m <= row.tolerance_m && point->error_deg <= row.tolerance_deg)) {
      break;
    }
    at = point->iteration;
  }
  return at;
}

}  // namespace

Milestones milestones_of(std::span<const CurvePoint> curve, const study::Row& row) {
  return {first_with(curve, 0.5), first_with(curve, 0.9), settled_at(curve, row)};
}

std::vector<std::span<const CurvePoint>> curves_of(std::vector<CurvePoint>& points) {
  std::stable_sort(points.begin(), points.end(), [](const CurvePoint& a, const CurvePoint& b) {
    return std::tie(a.run, a.iteration) < std::tie(b.run, b.iteration);
  });
  std::vector<std::span<const CurvePoint>> curves;
  for (auto begin = points.begin(); begin != points.end();) {
    const auto end =
        std::find_if(begin, points.end(), [&](const CurvePoint& point) { return point.run != begin->run; });
    curves.emplace_back(begin, end);
    begin = end;
  }
  return curves;
}

}  // namespace gridmerge::page
