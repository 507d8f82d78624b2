#pragma once
/// The few results of the mathematical library that a world hangs on, made the same on every machine.
#include <cmath>

#include "gridmerge/grid/pose2.hpp"

namespace gridmerge::worlds {

/// Libraries (and one library on two processors) differ in the last bits of a sine; 2^-30 is coarse enough to hide that
/// and finer than a micrometre at a kilometre.
[[nodiscard]] inline double snapped(double value) { return std::nearbyint(value * 0x1p30) * 0x1p-30; }

/// The unit vector of an angle.
[[nodiscard]] inline Point2 direction(double angle_rad) {
  return {snapped(std::cos(angle_rad)), snapped(std::sin(angle_rad))};
}

}  // namespace gridmerge::worlds
