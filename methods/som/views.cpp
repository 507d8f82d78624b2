#include "methods/som/views.hpp"

#include <algorithm>
#include <utility>

namespace gridmerge::som {
namespace {

/// How long a normal is drawn.
constexpr double kNormal_m = 0.4;

Point2 wide(Point2f p) { return {static_cast<double>(p.x_m), static_cast<double>(p.y_m)}; }

Shape points_of(std::span<const ClusterPoint> clusters, const Pose2& moved_by, std::string label) {
  Shape shape{.kind = Shape::Kind::kPoints, .label = std::move(label), .points = {}};
  for (const ClusterPoint& one : clusters) {
    shape.points.push_back(moved_by * wide(one.at));
  }
  return shape;
}

Curve histogram_curve(std::string label, std::span<const ClusterPoint> clusters, double blur_deg) {
  Curve curve{.label = std::move(label), .x = {}, .y = {}};
  const NormalHistogram histogram = normal_histogram(clusters, blur_deg);
  for (std::size_t i = 0; i < histogram.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(static_cast<double>(histogram[i]));
  }
  return curve;
}

}  // namespace

View neurons_view(MapView::Map map, std::span<const ClusterPoint> clusters) {
  const bool target = map == MapView::Map::kTarget;
  Shape normals{.kind = Shape::Kind::kSegments, .label = "normals", .points = {}};
  for (const ClusterPoint& one : clusters) {
    normals.points.push_back(wide(one.at));
    normals.points.push_back(wide(one.at) + kNormal_m * wide(one.normal));
  }
  return {.name = target ? "som_neurons_target" : "som_neurons_source",
          .title = std::string(target ? "target" : "source") + ": " + std::to_string(clusters.size()) +
                   " neurons of the self-organising map, with the direction their walls face",
          .content = MapView{.map = map,
                             .local_target_from_source = {},
                             .shapes = {std::move(normals), points_of(clusters, {}, "neurons")}}};
}

View normals_view(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source, double blur_deg) {
  return {.name = "som_normals",
          .title = "metres of wall that face each direction",
          .content = CurvesView{
              .curves = {histogram_curve("target", target, blur_deg), histogram_curve("source", source, blur_deg)},
              .x_label = "direction faced [deg]",
              .y_label = "wall per degree [m]",
              .marks = {}}};
}

View turns_view(const RotationSpectrum& spectrum, std::span<const Rotation> turns) {
  Curve normals{.label = "normals", .x = {}, .y = {}};
  Curve projections{.label = "sharpness of projections", .x = {}, .y = {}};
  for (std::size_t i = 0; i < spectrum.normals.size(); ++i) {
    normals.x.push_back(static_cast<double>(i));
    normals.y.push_back(static_cast<double>(spectrum.normals[i]));
  }
  for (std::size_t i = 0; i < 2 * spectrum.sharpness.size(); ++i) {
    projections.x.push_back(0.5 * static_cast<double>(i));
    projections.y.push_back(static_cast<double>(spectrum.sharpness[i % spectrum.sharpness.size()]));
  }
  CurvesView view{.curves = {std::move(normals), std::move(projections)},
                  .x_label = "turn of the source [deg]",
                  .y_label = "circular correlation",
                  .marks = {}};
  for (const Rotation& one : turns) {
    const double turn_deg = degrees(one.angle_rad);
    view.marks.push_back(turn_deg < 0 ? turn_deg + 360 : turn_deg);
  }
  return {.name = "som_turns", .title = "which turns of the source the normals allow", .content = std::move(view)};
}

View votes_view(const VoteSurface& surface, std::span<const ScoredPose> peaks) {
  SurfaceView view{.width = surface.width,
                   .height = surface.height,
                   .values = surface.votes,
                   .x_low = surface.lower_left.x_m,
                   .x_high = surface.lower_left.x_m + surface.width * surface.cell_m,
                   .y_low = surface.lower_left.y_m,
                   .y_high = surface.lower_left.y_m + surface.height * surface.cell_m,
                   .x_label = "x [m]",
                   .y_label = "y [m]",
                   .value_label = "votes [m of wall]",
                   .marks = {}};
  constexpr std::size_t kMarks = 10;
  for (const ScoredPose& one : peaks.first(std::min(kMarks, peaks.size()))) {
    view.marks.push_back(one.pose.translation());
  }
  return {.name = "som_votes",
          .title = "votes for where the source's centre lies, turned as the best pose is",
          .content = std::move(view)};
}

View matches_view(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source, const ClusterMatch& match,
                  const Pose2& local_target_from_source) {
  Shape joined{.kind = Shape::Kind::kSegments, .label = "matches", .points = {}};
  for (const auto& [k, i] : match.pairs) {
    joined.points.push_back(wide(target[k].at));
    joined.points.push_back(local_target_from_source * wide(source[i].at));
  }
  return {.name = "som_matches",
          .title = std::to_string(match.pairs.size()) + " clusters of the source matched with the target's",
          .content = MapView{.map = MapView::Map::kBoth,
                             .local_target_from_source = local_target_from_source,
                             .shapes = {std::move(joined), points_of(target, {}, "target's neurons"),
                                        points_of(source, local_target_from_source, "source's neurons")}}};
}

}  // namespace gridmerge::som
