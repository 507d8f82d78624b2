#include "verdict/pictures.hpp"

#include <algorithm>
#include <numeric>

#include "map_server/whole_files.hpp"
#include "report/view_picture.hpp"

namespace gridmerge::verdict_study {
namespace {

constexpr double kMostWrong = 0.05;

Curve reliability_curve(const Told& told) {
  Curve curve{.label = told.name, .x = {}, .y = {}};
  for (const ReliabilityBin& bin : reliability(told.rows, told.confidence)) {
    if (bin.rows > 0) {
      curve.x.push_back(bin.mean_confidence);
      curve.y.push_back(bin.share_right);
    }
  }
  return curve;
}

/// Down the confidences: what a threshold there would merge.
Curve roc_curve(const Told& told) {
  std::vector<std::size_t> order(told.rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return told.confidence[a] > told.confidence[b]; });
  const auto rights = std::count_if(told.rows.begin(), told.rows.end(), [](const Row& row) { return row.right; });
  const double all_right = std::max<double>(1, static_cast<double>(rights));
  const double all_wrong = std::max<double>(1, static_cast<double>(told.rows.size()) - static_cast<double>(rights));
  Curve curve{.label = told.name, .x = {0}, .y = {0}};
  double right = 0;
  double wrong = 0;
  for (const std::size_t i : order) {
    (told.rows[i].right ? right : wrong) += told.rows[i].vetoed ? 0 : 1;
    if (wrong / all_wrong > kMostWrong) {
      break;
    }
    curve.x.push_back(wrong / all_wrong);
    curve.y.push_back(right / all_right);
  }
  return curve;
}

std::string png_of(const std::string& name, CurvesView curves) {
  const PreparedMap nothing(unknown_grid({.width = 1, .height = 1, .resolution_m = 1, .map_from_grid = {}}), 1);
  return encode_png(draw_view({.name = name, .title = name, .content = std::move(curves)}, {nothing, nothing}).image);
}

}  // namespace

void write_pictures(const std::vector<Told>& told, const std::filesystem::path& folder) {
  CurvesView trust{.curves = {}, .x_label = "confidence", .y_label = "share right", .marks = {}};
  CurvesView roc{.curves = {},
                 .x_label = "wrong merges, of all that must not be",
                 .y_label = "right merges, of all that could be",
                 .marks = {}};
  for (const Told& one : told) {
    trust.curves.push_back(reliability_curve(one));
    roc.curves.push_back(roc_curve(one));
  }
  trust.curves.push_back({.label = "as told", .x = {0, 1}, .y = {0, 1}});
  WholeFiles files;
  files.stage(folder / "reliability.png", png_of("reliability", std::move(trust)));
  files.stage(folder / "roc.png", png_of("roc", std::move(roc)));
  files.commit();
}

}  // namespace gridmerge::verdict_study
