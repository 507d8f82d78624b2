#pragma once
/// How well two maps fit anywhere, held against a decoy: the source in a mirror.
///
/// A search over all poses finds something that fits in any two buildings. How well, depends on the maps: on their
/// size, their walls, how self-similar they are. The mirror image of the source has all of that and is not in the
/// target, so what the same search finds for it is what a wrong answer looks like on these very maps (a decoy, as in
/// target-decoy searches: Elias, Gygi, Nature Methods 4, 2007).
#include <algorithm>
#include <cmath>

namespace gridmerge {

struct DecoyLevel {
  double own = 0;    ///< the best smooth fitness that any pose was found to have [points of wall]
  double decoy = 0;  ///< the same for the mirrored source, of all poses

  /// ln(own / decoy), with five points added to each, so that specks say nothing. Below 0: the maps fit better in a
  /// mirror.
  [[nodiscard]] double log_ratio() const {
    constexpr double kSpecks = 5;
    return std::log((std::max(0.0, own) + kSpecks) / (std::max(0.0, decoy) + kSpecks));
  }
};

}  // namespace gridmerge
