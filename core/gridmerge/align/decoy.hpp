#pragma once
/// The sweep over all poses that every alignment makes, and the same for the mirrored source.
#include "gridmerge/align/correlation_sweep.hpp"
#include "gridmerge/judge/decoy_level.hpp"

namespace gridmerge {

/// All angles by 3 degrees, cells of 0.2 m, of 0.4 m for larger maps.
[[nodiscard]] SweepOptions survey_options();

/// @param own  the sweep over the maps as they are, with survey_options()
[[nodiscard]] DecoyLevel decoy_level(const SweepResult& own, const AlignRequest& request, const RunContext& context);

}  // namespace gridmerge
