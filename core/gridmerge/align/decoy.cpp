#include "gridmerge/align/decoy.hpp"

namespace gridmerge {

SweepOptions survey_options() {
  return {.lattice = {.angle_step_rad = radians(3), .coarsest_level = 3, .max_cells = 200}, .peaks_per_angle = 6};
}

DecoyLevel decoy_level(const SweepResult& own, const AlignRequest& request, const RunContext& context) {
  SweepOptions options = survey_options();
  options.peaks_per_angle = 1;
  const PreparedMap mirrored = request.source.mirrored();
  const SweepResult decoy = correlation_sweep(request.target, mirrored, window_of(request), options, context);
  const auto best = [](const SweepResult& sweep) { return sweep.peaks.empty() ? 0 : sweep.peaks.front().score; };
  return {.own = best(own), .decoy = best(decoy)};
}

}  // namespace gridmerge
