#pragma once
/// From a window's description to the prior that a method is given.
#include <optional>

#include "gridmerge/align/merger.hpp"
#include "study/drawn_pair.hpp"

namespace gridmerge::study {

/// None for a window of anywhere.
///
/// Round the truth: the truth moved and turned by chance within the window, at the centre of the source's known cells;
/// the chance depends on the names of set and pair, on the window's, and on the seed. A pair that shares nothing is
/// laid centre on centre, at any heading.
/// @param choice  of the pair, for its names
[[nodiscard]] std::optional<PosePrior> prior_of(const WindowChoice& window, const PairChoice& choice,
                                                const DrawnPair& pair, std::uint64_t seed);

}  // namespace gridmerge::study
