#include "gridmerge/align/decoy.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "gridmerge/align/lattice_scores.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// Decoys that are climbed from.
constexpr std::size_t kClimbed = 6;

/// Walls of each map that a pose is weighed by while climbing.
constexpr std::size_t kMaxPoints = 1500;

/// Cells of 0.2 m, of 0.4 m for larger maps.
constexpr LatticeOptions kLattice{.angle_step_rad = radians(5), .coarsest_level = 3, .max_cells = 200};

/// The best that can be climbed to from the best few.
double best_climb(const WallFit& fitness, std::vector<ScoredPose> poses, double resolution_m,
                  const std::optional<PoseWindow>& window, int num_threads) {
  const std::vector<ScoredPose> starts = distinct_poses(std::move(poses), {1, radians(6)}, kClimbed);
  std::vector<double> tops(starts.size());
  parallel_for(starts.size(), num_threads, [&](std::size_t i, std::size_t) {
    tops[i] =
        climb(fitness, starts[i].pose, {resolution_m, radians(2)}, {resolution_m / 4, radians(0.5)}, window).score;
  });
  return std::accumulate(tops.begin(), tops.end(), 0.0, [](double a, double b) { return std::max(a, b); });
}

/// The best peak of every angle that has one. Between local frames, fixed_from_moving.
std::vector<ScoredPose> swept(const PoseLattice& lattice, const std::optional<PoseWindow>& window,
                              const WallFit& fitness, const RunContext& context, bool& stopped) {
  const auto accept = [&](const LatticePose& at) { return !window || lattice.holds(at); };
  // A fence is narrow: little is saved there, and what lies in it must not be mixed with what does not.
  const Torus torus = window ? Torus::kWhole : Torus::kShared;
  std::vector<std::optional<ScoredPose>> best_of(static_cast<std::size_t>(lattice.angles()));
  const LatticeScores scores = score_lattice(
      lattice, context,
      [&](const ScoreSurface& surface, std::size_t) {
        std::optional<ScoredPose>& best = best_of[static_cast<std::size_t>(surface.angle)];
        for (const LatticePeak& peak : surface_peaks(surface, 1, accept)) {
          if (torus == Torus::kWhole) {
            best = ScoredPose{lattice.pose(peak.at), PoseLattice::fitness(static_cast<double>(peak.score))};
            continue;
          }
          // Of the poses that share the place, the best.
          for (const int columns : {0, surface.size}) {
            for (const int rows : {0, surface.size}) {
              const LatticePose at{peak.at.angle, peak.at.column - columns, peak.at.row - rows};
              if (at.column < -surface.reach || at.row < -surface.reach) {
                continue;  // the maps would not touch
              }
              const Pose2 pose = lattice.pose(at);
              const double score = fitness(pose);
              if (!best || score > best->score) {
                best = ScoredPose{pose, score};
              }
            }
          }
        }
      },
      torus);
  stopped = scores.stopped;
  std::vector<ScoredPose> all;
  for (const std::optional<ScoredPose>& best : best_of) {
    if (best) {
      all.push_back(*best);
    }
  }
  return all;
}

}  // namespace

Decoy::Decoy(const AlignRequest& request, const RunContext& context)
    : target_(request.target), source_(request.source), window_(window_of(request)) {
  // The smaller map is the one to turn: the transform is then smaller. A window lies in the target's frame, and stays.
  const bool swapped = !window_ && source_.radius_m() > target_.radius_m();
  const PreparedMap& fixed = swapped ? source_ : target_;
  const PreparedMap moving = (swapped ? target_ : source_).mirrored();
  const PoseLattice lattice(fixed, moving, window_, kLattice);
  resolution_m_ = lattice.resolution_m();
  const WallFit fitness(fixed, moving, lattice.level(), {}, kMaxPoints);
  best_ = best_climb(fitness, swept(lattice, window_, fitness, context, stopped_), resolution_m_, window_,
                     context.num_threads);
  fit_.emplace(target_, source_, lattice.level(), WallFitOptions{}, kMaxPoints);
}

double Decoy::fit_of(const std::vector<Candidate>& candidates, int num_threads) const {
  std::vector<ScoredPose> poses(candidates.size());
  parallel_for(poses.size(), num_threads, [&](std::size_t i, std::size_t) {
    const Pose2 pose = to_local(candidates[i].target_from_source, target_, source_);
    poses[i] = {pose, (*fit_)(pose)};
  });
  return best_climb(*fit_, std::move(poses), resolution_m_, window_, num_threads);
}

}  // namespace gridmerge
