#pragma once
/// How well two maps fit if each patch of a map may shift by itself, a little: a bent map then fits where it belongs,
/// and no better than before where it does not.
#include "gridmerge/judge/sided_map.hpp"

namespace gridmerge {

/// Of the walls of one map, where the other knows. Lengths [m], as in WallMeeting.
struct ElasticMeeting {
  double same_side_m = 0;  ///< within half the tolerance of a wall seen from the same side
  double in_free_m = 0;    ///< in the other map's free space, beyond half the tolerance of any wall
  // Of walls and fittings alone, as furniture moves by itself:
  double shift_m = 0;   ///< sum over neighbouring patches of how far their shifts differ, times their walls [m2]
  double beside_m = 0;  ///< the walls that shift_m was summed over
};

/// Each patch of 4 m x 4 m takes of the shifts up to 0.6 m the one with the most walls on walls less walls in free
/// space: by 0.2 m, of equal ones the shortest, then by 0.1 m beside it. A millisecond.
[[nodiscard]] ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving,
                                              const Pose2& fixed_from_moving, double tolerance_m);

}  // namespace gridmerge
