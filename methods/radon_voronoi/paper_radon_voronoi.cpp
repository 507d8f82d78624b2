#include "methods/radon_voronoi/paper_radon_voronoi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/radon_voronoi/edge_matrices.hpp"
#include "methods/radon_voronoi/edge_votes.hpp"
#include "methods/radon_voronoi/radon.hpp"
#include "methods/radon_voronoi/rotation_record.hpp"
#include "methods/radon_voronoi/voronoi.hpp"

namespace gridmerge {
namespace {

using radon::Rotation;
using radon::Sinogram;
using voronoi::Diagram;
using voronoi::EdgeMatch;
using voronoi::EdgeMatrix;
using voronoi::VoteSurface;

struct Look {
  Sinogram sinogram;
  Diagram diagram;
};

Look look_at(const PreparedMap& map, const PaperRadonVoronoiOptions& o, double radius_m) {
  const int angles = static_cast<int>(std::lround(360 / o.angle_step_deg));
  return {radon::sinogram(radon::wall_cells(map), radon::Projection::kPlain, angles, o.cell_m, radius_m),
          voronoi::morphological_diagram(map, o.cell_m, o.mask_m)};
}

/// The best rotation, and the same turned round: a Radon transform has period pi.
std::vector<Rotation> rotations_to_try(const std::vector<double>& correlation,
                                       const std::optional<PoseWindow>& window) {
  const Rotation best = radon::rotations(correlation, window, 1).front();
  const Rotation round{wrap_angle(best.angle_rad + kPi), best.sigma_rad, best.score};
  const bool allowed = !window || std::abs(wrap_angle(round.angle_rad - window->centre.theta_rad)) <= window->angle_rad;
  return allowed ? std::vector<Rotation>{best, round} : std::vector<Rotation>{best};
}

/// Each pair of edges says where the source lies if the two are the same; what many say is likely.
VoteSurface votes(const Look& target, const Look& source, const Rotation& rotation,
                  const std::optional<PoseWindow>& window, const PaperRadonVoronoiOptions& o, const StopToken& stop) {
  const double cell_m = target.diagram.cell_m;
  const std::vector<EdgeMatrix> of_target =
      edge_matrices(target.diagram, {}, {.cell_m = cell_m, .shortest_cells = o.shortest_cells, .most_blur_m = 0});
  const std::vector<EdgeMatrix> of_source = edge_matrices(
      source.diagram, rotation,
      {.cell_m = cell_m, .shortest_cells = o.shortest_cells, .most_blur_m = std::max(cell_m, o.most_blur_m)});
  VoteSurface surface = empty_surface(target.diagram, source.diagram, rotation.angle_rad, window, 2 * cell_m);
  if (surface.votes.empty()) {
    return surface;
  }
  for (const EdgeMatrix& a : of_target) {
    if (stop.stop_requested()) {
      break;
    }
    for (const EdgeMatrix& b : of_source) {
      const EdgeMatch match = cross_correlate(a, b);
      const double common_m = std::min(a.cells, b.cells) * cell_m;
      cast(surface, {match.columns * cell_m, match.rows * cell_m}, common_m * match.likeness);
    }
  }
  blur(surface, 2.5 * cell_m);
  return surface;
}

void show(const std::array<Look, 2>& looks, const std::vector<double>& correlation,
          const std::vector<Rotation>& rotations, const std::vector<VoteSurface>& surfaces,
          const std::vector<ScoredPose>& best_first, TraceSink& trace) {
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
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (rotations[i].angle_rad == best.theta_rad) {
      trace.on_view(vote_view(surfaces[i], peaks(surfaces[i], best.theta_rad, 8)));
    }
  }
  trace.on_view(voronoi::match_view(target.diagram, source.diagram, best));
}

}  // namespace

void PaperRadonVoronoiOptions::describe(OptionList& list) {
  list.add("angle_step_deg", angle_step_deg, 0.1, 10, {"deg", "Step of the sinograms' angles.", ""})
      .add("cell_m", cell_m, 0.01, 10,
           {"m", "Step of the sinograms' offsets; diagrams are drawn on the coarsest level with cells of at most this.",
            "Raise it for speed; doors narrower than three cells close."})
      .add("mask_m", mask_m, 0, 10, {"m", "Radius of the dilation mask that cuts the diagram at its vertices.", ""})
      .add("shortest_cells", shortest_cells, 1, 10000,
           {"cells", "Edges of fewer cells are left out.", "Raise it for speed on maps with rough walls."})
      .add("most_blur_m", most_blur_m, 0, 10,
           {"m", "How far the rotation's uncertainty may blur an edge, as a standard deviation.", ""})
      .add("candidates", candidates, 1, 1000, {"poses", "Translations proposed for each rotation.", ""});
}

PaperRadonVoronoiMerger::PaperRadonVoronoiMerger(PaperRadonVoronoiOptions options) : options_(options) {
  require_valid(options_, "radon_voronoi (paper)");
}

MergerTraits PaperRadonVoronoiMerger::traits() const {
  return {.stochastic = false, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal PaperRadonVoronoiMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const PaperRadonVoronoiOptions& o = options_;
  const std::optional<PoseWindow> window = window_of(request);
  Proposal proposal;
  announce(context, "propose/look");
  if (context.stop.stop_requested()) {
    proposal.stopped = true;
    return proposal;
  }
  const double radius_m = std::max(request.target.radius_m(), request.source.radius_m());
  std::array<Look, 2> looks;
  parallel_for(2, context.num_threads, [&](std::size_t i, std::size_t) {
    looks[i] = look_at(i == 0 ? request.target : request.source, o, radius_m);
  });
  const std::vector<double> correlation = radon::energy_correlation(looks[0].sinogram, looks[1].sinogram);
  const std::vector<Rotation> rotations = rotations_to_try(correlation, window);

  announce(context, "propose/translation");
  const auto budget = static_cast<std::size_t>(std::max(0, context.stop.iteration_budget()));
  std::vector<VoteSurface> surfaces(std::min(rotations.size(), budget));
  parallel_for(surfaces.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    surfaces[i] = votes(looks[0], looks[1], rotations[i], window, o, context.stop);
  });
  std::vector<ScoredPose> poses;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const std::vector<ScoredPose> found =
        peaks(surfaces[i], rotations[i].angle_rad, static_cast<std::size_t>(o.candidates));
    std::copy_if(found.begin(), found.end(), std::back_inserter(poses),
                 [&](const ScoredPose& one) { return inside(one.pose, window); });
    if (context.trace != nullptr) {
      context.trace->on_iteration(rotation_record(i, surfaces.size(), poses, request));
    }
    ++proposal.iterations;
  }
  proposal.stopped = context.stop.stop_requested();
  std::stable_sort(poses.begin(), poses.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  proposal.candidates = candidates_of(poses, request);
  if (wants_views(context)) {
    show(looks, correlation, rotations, surfaces, poses, *context.trace);
  }
  return proposal;
}

}  // namespace gridmerge
