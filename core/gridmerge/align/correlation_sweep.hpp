#pragma once
/// All angles, all translations: the smooth fitness over a lattice of poses by fast Fourier transform.
///
/// For a fixed angle, the fitness of all translations at once is a sum of two cross-correlations: the source's walls
/// with the target's table, and the source's table with the target's walls. It sees the whole space of poses at the
/// price of a few FFTs an angle, so nothing that stands out at its resolution is missed.
#include <optional>
#include <vector>

#include "gridmerge/align/pose_lattice.hpp"
#include "gridmerge/align/scored_pose.hpp"

namespace gridmerge {

struct SweepOptions {
  LatticeOptions lattice;
  int peaks_per_angle = 12;
};

struct SweepResult {
  /// Local maxima over translation of the smooth fitness, at most peaks_per_angle an angle; best first.
  std::vector<ScoredPose> peaks;
  double resolution_m = 0;
  int angles = 0;
  bool stopped = false;
};

[[nodiscard]] SweepResult correlation_sweep(const PreparedMap& target, const PreparedMap& source,
                                            const std::optional<PoseWindow>& window, const SweepOptions& options,
                                            const RunContext& context);

}  // namespace gridmerge
