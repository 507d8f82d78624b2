#include "gridmerge/align/decoy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
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

/// Cells of 0.4 m; of 0.2 m for maps that laid side by side span less than 20 m.
constexpr LatticeOptions kLattice{.angle_step_rad = radians(5), .coarsest_level = 3, .max_cells = 100};

/// Of the PreparedMaps: what is climbed on, in cells of 0.2 m.
constexpr int kFitLevel = 2;

/// Which way a map's walls run, by 5 degrees of a quarter turn; of neighbouring bins some is shared.
using WallDirections = std::array<double, 18>;

std::size_t direction_bin(double angle_rad) {
  const double quarters = angle_rad / (kPi / 2);
  const auto bins = static_cast<double>(WallDirections{}.size());
  return static_cast<std::size_t>((quarters - std::floor(quarters)) * bins) % WallDirections{}.size();
}

WallDirections wall_directions(const PreparedMap& map) {
  WallDirections counts{};
  for (const WallPoint& wall : map.walls()) {
    if (wall.surface_normal.x_m != 0 || wall.surface_normal.y_m != 0) {
      counts[direction_bin(std::atan2(wall.surface_normal.y_m, wall.surface_normal.x_m))] += 1;
    }
  }
  WallDirections smooth{};
  const std::size_t n = counts.size();
  for (std::size_t i = 0; i < n; ++i) {
    smooth[i] = counts[(i + n - 1) % n] + 2 * counts[i] + counts[(i + 1) % n];
  }
  return smooth;
}

/// Of the lattice's angles the third at which the walls of both maps run most alike: where they cross, little fits.
void keep_the_likely_third(PoseLattice& lattice, const PreparedMap& fixed, const PreparedMap& moving) {
  const WallDirections of_fixed = wall_directions(fixed);
  const WallDirections of_moving = wall_directions(moving);
  WallDirections alike{};
  for (std::size_t turn = 0; turn < alike.size(); ++turn) {
    for (std::size_t i = 0; i < alike.size(); ++i) {
      alike[turn] += of_moving[i] * of_fixed[(i + turn) % alike.size()];
    }
  }
  WallDirections sorted = alike;
  std::sort(sorted.begin(), sorted.end());
  // The lattice's angles begin the bins: a degree keeps the rounding off.
  lattice.keep_groups(
      [&](double angle) { return alike[direction_bin(angle + radians(1))] >= sorted[2 * sorted.size() / 3]; });
}

/// The best that can be climbed to from the best few.
double best_climb(const WallFit& fitness, std::vector<ScoredPose> poses, double resolution_m,
                  const std::optional<PoseWindow>& window, int num_threads) {
  const std::vector<ScoredPose> starts = distinct_poses(std::move(poses), {1, radians(6)}, kClimbed);
  std::vector<double> tops(starts.size());
  parallel_for(starts.size(), num_threads, [&](std::size_t i, std::size_t) {
    tops[i] = climb(fitness, starts[i].pose, {resolution_m, radians(2)}, {0.05, radians(0.5)}, window).score;
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
  const PreparedMap moving = (swapped ? target_ : source_).mirrored(kFitLevel);
  std::optional<PoseLattice> lattice;
  std::optional<WallFit> mirrored_fit;
  parallel_invoke(
      context.num_threads,
      [&] {
        lattice.emplace(fixed, moving, window_, kLattice);
        if (!window_) {
          keep_the_likely_third(*lattice, fixed, moving);
        }
      },
      [&] { mirrored_fit.emplace(fixed, moving, kFitLevel, WallFitOptions{}, kMaxPoints); },
      [&] { fit_.emplace(target_, source_, kFitLevel, WallFitOptions{}, kMaxPoints); });
  resolution_m_ = lattice->resolution_m();
  best_ = best_climb(*mirrored_fit, swept(*lattice, window_, *mirrored_fit, context, stopped_), resolution_m_, window_,
                     context.num_threads);
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
