#include "gridmerge/align/decoy.hpp"

#include <algorithm>
#include <utility>

#include "gridmerge/align/lattice_scores.hpp"

namespace gridmerge {
namespace {

/// Decoys that are climbed from.
constexpr std::size_t kClimbed = 6;

/// Walls of each map that a pose is weighed by while climbing.
constexpr std::size_t kMaxPoints = 1500;

LatticeOptions decoy_lattice() {
  LatticeOptions options = survey_options().lattice;
  options.angle_step_rad = radians(5);
  return options;
}

/// The best that can be climbed to from the best few.
double best_climb(const WallFit& fitness, std::vector<ScoredPose> poses, double resolution_m,
                  const std::optional<PoseWindow>& window) {
  double best = 0;
  for (const ScoredPose& start : distinct_poses(std::move(poses), {1, radians(6)}, kClimbed)) {
    const ScoredPose top =
        climb(fitness, start.pose, {resolution_m, radians(2)}, {resolution_m / 4, radians(0.5)}, window);
    best = std::max(best, top.score);
  }
  return best;
}

/// The best peak of every angle. Between local frames, fixed_from_moving.
std::vector<ScoredPose> swept(const PoseLattice& lattice, const std::optional<PoseWindow>& window,
                              const WallFit& fitness, const RunContext& context, bool& stopped) {
  const auto accept = [&](const LatticePose& at) { return !window || lattice.holds(at); };
  // A fence is narrow: little is saved there, and what lies in it must not be mixed with what does not.
  const Torus torus = window ? Torus::kWhole : Torus::kShared;
  std::vector<ScoredPose> best_of(static_cast<std::size_t>(lattice.angles()));
  const LatticeScores scores = score_lattice(
      lattice, context,
      [&](const ScoreSurface& surface, std::size_t) {
        ScoredPose& best = best_of[static_cast<std::size_t>(surface.angle)];
        for (const LatticePeak& peak : surface_peaks(surface, 1, accept)) {
          best = {lattice.pose(peak.at), PoseLattice::fitness(static_cast<double>(peak.score))};
          if (torus == Torus::kWhole) {
            continue;
          }
          // Of the poses that share the place, the best.
          best.score = fitness(best.pose);
          for (const auto& [columns, rows] :
               {std::pair{surface.size, 0}, {0, surface.size}, {surface.size, surface.size}}) {
            const Pose2 other = lattice.pose({peak.at.angle, peak.at.column - columns, peak.at.row - rows});
            const double score = fitness(other);
            if (score > best.score) {
              best = {other, score};
            }
          }
        }
      },
      torus);
  stopped = scores.stopped;
  return best_of;
}

}  // namespace

SweepOptions survey_options() {
  return {.lattice = {.angle_step_rad = radians(3), .coarsest_level = 3, .max_cells = 200}, .peaks_per_angle = 6};
}

Decoy::Decoy(const AlignRequest& request, const RunContext& context)
    : target_(request.target), source_(request.source), window_(window_of(request)) {
  // The smaller map is the one to turn: the transform is then smaller. A window lies in the target's frame, and stays.
  const bool swapped = !window_ && source_.radius_m() > target_.radius_m();
  const PreparedMap& fixed = swapped ? source_ : target_;
  const PreparedMap moving = (swapped ? target_ : source_).mirrored();
  const PoseLattice lattice(fixed, moving, window_, decoy_lattice());
  resolution_m_ = lattice.resolution_m();
  const WallFit fitness(fixed, moving, lattice.level(), {}, kMaxPoints);
  best_ = best_climb(fitness, swept(lattice, window_, fitness, context, stopped_), resolution_m_, window_);
  fit_.emplace(target_, source_, lattice.level(), WallFitOptions{}, kMaxPoints);
}

double Decoy::fit_of(const std::vector<Candidate>& candidates) const {
  std::vector<ScoredPose> poses;
  for (const Candidate& candidate : candidates) {
    const Pose2 pose = to_local(candidate.target_from_source, target_, source_);
    poses.push_back({pose, (*fit_)(pose)});
  }
  return best_climb(*fit_, std::move(poses), resolution_m_, window_);
}

}  // namespace gridmerge
