#include "gridmerge/align/correlation_sweep.hpp"

#include <algorithm>

#include "gridmerge/align/lattice_scores.hpp"

namespace gridmerge {

SweepResult correlation_sweep(const PreparedMap& target, const PreparedMap& source,
                              const std::optional<PoseWindow>& window, const SweepOptions& options,
                              const RunContext& context) {
  // The smaller map is the one to turn: the transform is then smaller. A window lies in the target's frame, and stays.
  if (!window && source.radius_m() > target.radius_m()) {
    SweepResult swapped = correlation_sweep(source, target, window, options, context);
    for (ScoredPose& peak : swapped.peaks) {
      peak.pose = inverse(peak.pose);
    }
    return swapped;
  }
  const PoseLattice lattice(target, source, window, options.lattice);
  const auto accept = [&](const LatticePose& at) {
    return !window || norm(lattice.pose(at).translation() - window->centre.translation()) <=
                          window->radius_m + lattice.resolution_m();
  };
  std::vector<std::vector<LatticePeak>> peaks_of(static_cast<std::size_t>(lattice.angles()));
  const LatticeScores scores = score_lattice(lattice, context, [&](const ScoreSurface& surface, std::size_t) {
    peaks_of[static_cast<std::size_t>(surface.angle)] = surface_peaks(surface, options.peaks_per_angle, accept);
  });

  SweepResult result{
      .peaks = {}, .resolution_m = lattice.resolution_m(), .angles = lattice.angles(), .stopped = scores.stopped};
  for (const std::vector<LatticePeak>& peaks : peaks_of) {
    for (const LatticePeak& peak : peaks) {
      result.peaks.push_back({lattice.pose(peak.at), PoseLattice::fitness(static_cast<double>(peak.score))});
    }
  }
  std::stable_sort(result.peaks.begin(), result.peaks.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  return result;
}

}  // namespace gridmerge
