#pragma once
/// All angles, all translations: the smooth fitness over a lattice of poses by fast Fourier transform.
///
/// For a fixed angle, the fitness of all translations at once is a sum of two cross-correlations: the source's walls
/// with the target's table, and the source's table with the target's walls. It sees the whole space of poses at the
/// price of a few FFTs an angle, so nothing that stands out at its resolution is missed.
#include <optional>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"

namespace gridmerge {

struct SweepOptions {
  double angle_step_rad = radians(2);
  int max_cells = 420;  ///< side of the transform [cells]: the level is chosen to stay below it, where it can
  int peaks_per_angle = 12;
  WallFitOptions fit;
};

/// Where to look: all poses that put the source's local origin within `radius_m` of where `centre` puts it, turned by
/// at most `angle_rad`.
struct SweepWindow {
  Pose2 centre;  ///< between local frames
  double radius_m = 0;
  double angle_rad = kPi;
};

/// The window that a request's prior allows; none: anywhere. (A prior without radius and angle is no fence.)
[[nodiscard]] std::optional<SweepWindow> window_of(const AlignRequest& request);

/// Whether a pose between local frames lies in the window; always, where there is none.
[[nodiscard]] bool inside(const Pose2& local_target_from_source, const std::optional<SweepWindow>& window);

struct SweepPeak {
  Pose2 local_target_from_source;
  double score = 0;  ///< the smooth fitness at the sweep's resolution
};

struct SweepResult {
  std::vector<SweepPeak> peaks;  ///< local maxima over translation, at most peaks_per_angle an angle; best first
  double resolution_m = 0;
  int angles = 0;
  bool stopped = false;
};

[[nodiscard]] SweepResult correlation_sweep(const PreparedMap& target, const PreparedMap& source,
                                            const std::optional<SweepWindow>& window, const SweepOptions& options,
                                            const RunContext& context);

}  // namespace gridmerge
