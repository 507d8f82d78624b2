/// The centroid method: it lays the centres of both maps' walls on each other, and the directions in which most walls
/// run along each other.
///
/// Directions that repeat every quarter turn have a mean: four times the angle (Mardia, Jupp: Directional Statistics,
/// 2000). It needs two maps of nearly the same place, which is why nobody uses it; it shows how a method comes from
/// outside.
#include <algorithm>
#include <cmath>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "plugin/method_plugin.hpp"

namespace {

using gridmerge::Point2;
using gridmerge::Pose2;
using gridmerge::radians;

struct CentroidOptions {
  bool climb = true;

  void describe(gridmerge::OptionList& list) {
    list.add("climb", climb,
             {.unit = "",
              .meaning = "Climb from each of the four poses to the nearest one that fits best.",
              .advice = "Turn it off to see what centres and directions alone are worth."});
  }
};

/// Centre of the walls and the direction of most of them, up to quarter turns, as a pose in the map's local frame.
Pose2 frame_of_walls(const gridmerge::PreparedMap& map) {
  Point2 sum;
  Point2 fourfold;
  for (const gridmerge::WallPoint& wall : map.walls()) {
    sum = sum + Point2{wall.at.x_m, wall.at.y_m};
    const double angle = 4 * std::atan2(wall.surface_normal.y_m, wall.surface_normal.x_m);
    const double clear = std::hypot(wall.surface_normal.x_m, wall.surface_normal.y_m);
    fourfold = fourfold + clear * Point2{std::cos(angle), std::sin(angle)};
  }
  const Point2 centre = (1.0 / static_cast<double>(map.walls().size())) * sum;
  return {centre.x_m, centre.y_m, std::atan2(fourfold.y_m, fourfold.x_m) / 4};
}

/// What the method sees, for `gridmerge inspect`.
gridmerge::View view_of(const Pose2& frame, double reach_m, gridmerge::MapView::Map map, const char* name,
                        const char* title) {
  using gridmerge::Shape;
  gridmerge::MapView view;
  view.map = map;
  view.shapes = {{Shape::Kind::kPoints, "centre of the walls", {frame.translation()}},
                 {Shape::Kind::kSegments,
                  "direction of the walls",
                  {frame * Point2{-reach_m, 0}, frame * Point2{reach_m, 0}, frame * Point2{0, -reach_m},
                   frame * Point2{0, reach_m}}}};
  return {name, title, view};
}

class CentroidMerger final : public gridmerge::Merger {
 public:
  explicit CentroidMerger(CentroidOptions options) : options_(options) {}

  [[nodiscard]] gridmerge::MergerTraits traits() const override { return {}; }

  [[nodiscard]] gridmerge::Proposal propose(const gridmerge::AlignRequest& request,
                                            const gridmerge::RunContext& context) const override {
    gridmerge::Proposal proposal;
    if (context.stop.stop_requested()) {
      proposal.stopped = true;
      return proposal;
    }
    const Pose2 target = frame_of_walls(request.target);
    const Pose2 source = frame_of_walls(request.source);
    if (context.trace != nullptr) {
      context.trace->on_stage("propose/centroid");
      if (context.trace->wants_views()) {
        using Map = gridmerge::MapView::Map;
        context.trace->on_view(view_of(target, 0.5 * request.target.radius_m(), Map::kTarget, "target_walls",
                                       "Centre and direction of the target's walls"));
        context.trace->on_view(view_of(source, 0.5 * request.source.radius_m(), Map::kSource, "source_walls",
                                       "Centre and direction of the source's walls"));
      }
    }
    const gridmerge::WallFit fit(request.target, request.source, 0, {}, 2000);
    std::vector<gridmerge::ScoredPose> poses;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Pose2 local = target * Pose2{0, 0, radians(90.0 * quarter)} * inverse(source);
      const bool climb = options_.climb && !context.stop.stop_requested();
      poses.push_back(climb ? gridmerge::climb(fit, local, {0.2, radians(2)}, {0.05, radians(0.5)}, {})
                            : gridmerge::ScoredPose{local, fit(local)});
    }
    std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
    proposal.candidates = candidates_of(poses, request);
    proposal.stopped = context.stop.stop_requested();
    return proposal;
  }

 private:
  CentroidOptions options_;
};

void add_methods(gridmerge::MethodRegistry& methods) {
  methods.add({.name = "centroid",
               .summary = "centres of the walls and their main directions, laid on each other",
               .paper = "after K. V. Mardia, P. E. Jupp: Directional Statistics, 2000 (the mean of directions)",
               .profiles = {{.name = "default", .summary = "four headings", .config = [] {
                               return std::make_unique<gridmerge::TypedMethodConfig<CentroidOptions, CentroidMerger>>(
                                   CentroidOptions{});
                             }}}});
}

}  // namespace

GRIDMERGE_METHOD_PLUGIN(add_methods)
