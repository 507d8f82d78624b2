#include "manifest/halmstad_annotations.hpp"

#include <cmath>
#include <set>
#include <tuple>

#include "gridmerge/base/error.hpp"
#include "manifest/npy_array.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

constexpr int kFewestMatches = 3;

NpyTable read_two_columns(const fs::path& file) {
  NpyTable table = read_npy(file);
  if (table.columns != 2) {
    throw InputError(file.string(), "has " + std::to_string(table.columns) + " columns, not 2");
  }
  return table;
}

const Point2& point_at(const std::vector<Point2>& points, double number, const fs::path& file, int row) {
  if (number != std::floor(number) || !(number < static_cast<double>(points.size()))) {
    throw InputError(file.string(), "row " + std::to_string(row) + ": there is no point " + std::to_string(number) +
                                        ", the map has " + std::to_string(points.size()));
  }
  return points[static_cast<std::size_t>(number)];
}

}  // namespace

std::vector<Point2> read_keypoints(const fs::path& annotations, const std::string& map) {
  const fs::path file = annotations / ("keypoints_" + map + ".npy");
  const NpyTable table = read_two_columns(file);
  std::vector<Point2> points;
  for (int row = 0; row < table.rows; ++row) {
    points.push_back({table.at(row, 0), table.at(row, 1)});
    if (!std::isfinite(points.back().x_m) || !std::isfinite(points.back().y_m)) {
      throw InputError(file.string(), "row " + std::to_string(row) + ": not finite");
    }
  }
  return points;
}

std::vector<PointMatch> read_matches(const fs::path& annotations, const std::string& target,
                                     const std::vector<Point2>& target_points, const std::string& source,
                                     const std::vector<Point2>& source_points) {
  const fs::path forward = annotations / ("association_" + target + "_" + source + ".npy");
  const fs::path backward = annotations / ("association_" + source + "_" + target + ".npy");
  const bool swapped = !fs::exists(forward) && fs::exists(backward);
  const fs::path& file = swapped ? backward : forward;
  const NpyTable table = read_two_columns(file);
  std::vector<PointMatch> matches;
  std::set<std::tuple<double, double>> different;
  for (int row = 0; row < table.rows; ++row) {
    const double of_target = table.at(row, swapped ? 1 : 0);
    const double of_source = table.at(row, swapped ? 0 : 1);
    if (of_target < 0 || of_source < 0) {
      continue;
    }
    matches.push_back({.in_target = point_at(target_points, of_target, file, row),
                       .in_source = point_at(source_points, of_source, file, row)});
    different.emplace(matches.back().in_source.x_m, matches.back().in_source.y_m);
  }
  if (different.size() < kFewestMatches) {
    throw InputError(file.string(), "holds " + std::to_string(different.size()) + " different points, a pose needs " +
                                        std::to_string(kFewestMatches));
  }
  return matches;
}

}  // namespace gridmerge
