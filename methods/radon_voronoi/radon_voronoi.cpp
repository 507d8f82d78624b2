#include "methods/radon_voronoi/radon_voronoi.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/radon_voronoi/radon.hpp"
#include "methods/radon_voronoi/rotation_record.hpp"

namespace gridmerge {
namespace {

using radon::Rotation;
using radon::Sinogram;
using voronoi::Diagram;

/// Levels of the maps: directions and rough poses show at 0.2 m, poses are improved one level finer.
constexpr int kCoarseLevel = 2;
constexpr int kClimbLevel = 1;

/// What one map looks like to this method.
struct Look {
  Sinogram sinogram;
  Diagram diagram;
};

Look look_at(const PreparedMap& map, const RadonVoronoiOptions& o, double radius_m) {
  const int angles = static_cast<int>(std::lround(360 / o.angle_step_deg));
  return {radon::sinogram(radon::wall_pieces(map, map.level(kCoarseLevel)), radon::Projection::kDirected, angles,
                          o.offset_step_m, radius_m),
          voronoi::diagram(map, o.diagram)};
}

/// The rotations that the sinograms suggest; where there is a fence, its own heading too.
std::vector<Rotation> rotations_to_try(const std::vector<double>& correlation, const std::optional<PoseWindow>& window,
                                       const RadonVoronoiOptions& o) {
  std::vector<Rotation> rotations = radon::rotations(correlation, window, static_cast<std::size_t>(o.rotations));
  const double least = 0.01 * o.likeness_percent * rotations.front().score;
  constexpr std::size_t kRightAngles = 4;  // the turns that walls at right angles cannot tell apart
  while (rotations.size() > kRightAngles && rotations.back().score < least) {
    rotations.pop_back();
  }
  if (window) {
    rotations.push_back({window->centre.theta_rad, radians(o.angle_step_deg), 0});
  }
  return rotations;
}

/// Where the fence's centre lies inside the votes' blur, the votes may have no peak: it stands for itself.
void add_centre(std::vector<ScoredPose>& poses, const Rotation& rotation, const std::optional<PoseWindow>& window) {
  if (window) {
    poses.push_back({{window->centre.x_m, window->centre.y_m, rotation.angle_rad}, 0});
  }
}

/// Shows the votes of the rotation that the best pose came from, and that pose.
void show(const std::array<Look, 2>& looks, const std::vector<double>& correlation,
          const std::vector<Rotation>& rotations, const std::optional<PoseWindow>& window,
          const std::vector<ScoredPose>& best_first, const RadonVoronoiOptions& o, TraceSink& trace) {
  const auto& [target, source] = looks;
  trace.on_view(radon::sinogram_view(target.sinogram, "target"));
  trace.on_view(radon::sinogram_view(source.sinogram, "source"));
  trace.on_view(radon::correlation_view(correlation, rotations));
  trace.on_view(voronoi::diagram_view(target.diagram, MapView::Map::kTarget));
  trace.on_view(voronoi::diagram_view(source.diagram, MapView::Map::kSource));
  if (best_first.empty()) {
    return;
  }
  const Pose2& best = best_first.front().pose;
  const auto off = [&](const Rotation& one) { return std::abs(wrap_angle(one.angle_rad - best.theta_rad)); };
  const Rotation& nearest = *std::min_element(rotations.begin(), rotations.end(),
                                              [&](const Rotation& a, const Rotation& b) { return off(a) < off(b); });
  const voronoi::VoteSurface surface = vote(target.diagram, source.diagram, nearest, window, o.votes);
  trace.on_view(vote_view(surface, peaks(surface, nearest.angle_rad, 8)));
  trace.on_view(voronoi::match_view(target.diagram, source.diagram, best));
}

}  // namespace

void RadonVoronoiOptions::describe(OptionList& list) {
  list.add("angle_step_deg", angle_step_deg, 0.1, 10,
           {"deg", "Step of the sinograms' angles.", "Finer than 1 deg the climb behind makes up for it."})
      .add("offset_step_m", offset_step_m, 0.01, 10, {"m", "Step of the sinograms' offsets.", ""})
      .add("rotations", rotations, 1, 1000,
           {"", "So many of the rotations that the sinograms suggest are tried.",
            "Four are enough where walls are at right angles; time grows with it."})
      .add("likeness_percent", likeness_percent, 0, 100,
           {"%", "After the first four, rotations less likely than this share of the likeliest are not tried.",
            "Raise it for speed, lower it for maps that overlap little."})
      .add("peaks_per_rotation", peaks_per_rotation, 1, 10000,
           {"poses", "So many peaks of the votes over translation are looked at for each rotation.",
            "More for large places that overlap little."})
      .add("climbed", climbed, 1, 10000, {"poses", "The best of them all that are improved by climbing.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Distinct poses proposed at the end.",
            "More give the Evaluator more to choose from, and cost time."})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses nearer than this, and than distinct_deg, are one: the better stays.", ""})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "See distinct_m.", ""})
      .add("max_points", max_points, 100, 1000000,
           {"points", "Wall points of each map that a pose is tried on while climbing.", ""});
  diagram.describe(list);
  votes.describe(list);
  fit.describe(list);
}

RadonVoronoiMerger::RadonVoronoiMerger(RadonVoronoiOptions options) : options_(std::move(options)) {
  require_valid(options_, "radon_voronoi");
}

MergerTraits RadonVoronoiMerger::traits() const {
  return {.stochastic = false, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal RadonVoronoiMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const RadonVoronoiOptions& o = options_;
  const std::optional<PoseWindow> window = window_of(request);
  Proposal proposal;
  const auto stopped = [&] {
    proposal.stopped = proposal.stopped || context.stop.stop_requested();
    return proposal.stopped;
  };

  announce(context, "propose/look");
  if (stopped()) {
    return proposal;
  }
  const double radius_m = std::max(request.target.radius_m(), request.source.radius_m());
  std::array<Look, 2> looks;
  parallel_for(2, context.num_threads, [&](std::size_t i, std::size_t) {
    looks[i] = look_at(i == 0 ? request.target : request.source, o, radius_m);
  });
  const auto& [target, source] = looks;

  announce(context, "propose/rotation");
  const std::vector<double> correlation = radon::angle_correlation(target.sinogram, source.sinogram);
  const std::vector<Rotation> rotations = rotations_to_try(correlation, window, o);

  announce(context, "propose/translation");
  const WallFit coarse(request.target, request.source, kCoarseLevel, o.fit, static_cast<std::size_t>(o.max_points));
  const auto budget = static_cast<std::size_t>(std::max(0, context.stop.iteration_budget()));
  std::vector<std::vector<ScoredPose>> found(std::min(rotations.size(), budget));
  std::vector<std::uint8_t> tried(found.size(), 0);
  parallel_for(found.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    if (context.stop.stop_requested()) {
      return;
    }
    found[i] = peaks(vote(target.diagram, source.diagram, rotations[i], window, o.votes), rotations[i].angle_rad,
                     static_cast<std::size_t>(o.peaks_per_rotation));
    add_centre(found[i], rotations[i], window);
    std::erase_if(found[i], [&](const ScoredPose& one) { return !inside(one.pose, window); });
    for (ScoredPose& one : found[i]) {
      one.score = coarse(one.pose);
    }
    tried[i] = 1;
  });
  stopped();
  std::vector<ScoredPose> poses;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (tried[i] == 0) {
      continue;
    }
    poses.insert(poses.end(), found[i].begin(), found[i].end());
    if (context.trace != nullptr) {
      context.trace->on_iteration(rotation_record(i, found.size(), poses, request));
    }
    ++proposal.iterations;
  }
  if (request.prior) {
    const Pose2 start = to_local(request.prior->target_from_source, request.target, request.source);
    poses.push_back({start, coarse(start)});
  }

  announce(context, "propose/climb");
  poses = distinct_poses(std::move(poses), {0.5 * o.distinct_m, 0.5 * radians(o.distinct_deg)},
                         static_cast<std::size_t>(o.climbed));
  const WallFit fine(request.target, request.source, kClimbLevel, o.fit, static_cast<std::size_t>(o.max_points));
  parallel_for(poses.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    poses[i].score = fine(poses[i].pose);
    if (!context.stop.stop_requested()) {
      poses[i] = climb(fine, poses[i].pose, {0.2, radians(1.5)}, {0.05, radians(0.4)}, window);
    }
  });
  stopped();
  poses =
      distinct_poses(std::move(poses), {o.distinct_m, radians(o.distinct_deg)}, static_cast<std::size_t>(o.candidates));
  proposal.candidates = candidates_of(poses, request);
  if (wants_views(context)) {
    show(looks, correlation, rotations, window, poses, o, *context.trace);
  }
  return proposal;
}

}  // namespace gridmerge
