#include "methods/random_walk/walk_views.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace gridmerge {
namespace {

MapView over_target(std::vector<Shape> shapes) {
  return {.map = MapView::Map::kTarget, .local_target_from_source = {}, .shapes = std::move(shapes)};
}

Curve curve_of(std::string label, const std::vector<BlockProgress>& blocks, double BlockProgress::*member) {
  Curve curve{.label = std::move(label), .x = {}, .y = {}};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(blocks[i].*member);
  }
  return curve;
}

void show_curves(TraceSink& trace, std::string name, std::string title, std::string y_label,
                 std::vector<Curve> curves) {
  trace.on_view(
      {.name = std::move(name),
       .title = std::move(title),
       .content = CurvesView{
           .curves = std::move(curves), .x_label = "block of steps", .y_label = std::move(y_label), .marks = {}}});
}

}  // namespace

void show_starts(TraceSink& trace, const std::vector<ScoredPose>& starts) {
  Shape points{.kind = Shape::Kind::kPoints, .label = "starts", .points = {}};
  for (const ScoredPose& start : starts) {
    points.points.push_back(start.pose.translation());
  }
  trace.on_view({.name = "starts",
                 .title = "where the starts put the source's centre, over the target",
                 .content = over_target({std::move(points)})});
}

void show_walks(TraceSink& trace, const std::vector<std::vector<Point2>>& paths) {
  constexpr std::size_t kNamed = 4;
  std::vector<Shape> lines;
  for (const std::vector<Point2>& path : paths) {
    if (path.size() > 1) {
      lines.push_back({.kind = Shape::Kind::kLine, .label = "the other walks", .points = path});
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
                   [](const Shape& a, const Shape& b) { return a.points.size() > b.points.size(); });
  for (std::size_t i = 0; i < std::min(kNamed, lines.size()); ++i) {
    lines[i].label = i == 0 ? "the longest walk" : "no. " + std::to_string(i + 1);
  }
  trace.on_view({.name = "walks",
                 .title = "walks of the source's centre, over the target",
                 .content = over_target(std::move(lines))});
}

void show_progress(TraceSink& trace, const std::vector<BlockProgress>& blocks) {
  show_curves(
      trace, "delta", "Delta of the walks, lower is better", "Delta",
      {curve_of("best", blocks, &BlockProgress::best_delta), curve_of("mean", blocks, &BlockProgress::mean_delta)});
  show_curves(trace, "acceptance", "steps accepted", "accepted [%]",
              {curve_of("accepted", blocks, &BlockProgress::acceptance_percent)});
  show_curves(trace, "step_widths", "standard deviation of the steps, mean of all walks", "sigma [m]",
              {curve_of("sigma", blocks, &BlockProgress::sigma_m)});
}

}  // namespace gridmerge
