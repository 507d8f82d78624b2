#pragma once
/// The one step from options to a pair, and the search for the shares that give it the overlap wanted.
#include "worlds/flight.hpp"
#include "worlds/scene.hpp"

namespace gridmerge::worlds {

/// By the shares of the options.
/// @param target_flown  how much of its way the target's robot goes, 0..1
[[nodiscard]] MapPair draw_with_shares(const SceneOptions& options, double target_flown);

/// Tries shares on coarse maps (quick), draws the best of them as the options say, and mends what the coarse maps
/// misjudged: at most four pairs are drawn. The nearest to the overlap wanted. Where it leaps from one share to the
/// next, the target's robot stops before the end of its way.
[[nodiscard]] MapPair draw_with_overlap(const SceneOptions& options);

}  // namespace gridmerge::worlds
