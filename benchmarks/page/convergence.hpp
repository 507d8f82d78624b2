#pragma once
/// When a run got how far. Only for this folder's .cpp files.
#include <span>
#include <vector>

#include "study/row.hpp"

namespace gridmerge::page {

/// Iterations of one run; NaN: never, or not known.
struct Milestones {
  double half_fitness = 0;      ///< the first with half of the fitness at the end; NaN where that is not positive
  double most_fitness = 0;      ///< the first with 90 % of it
  double within_tolerance = 0;  ///< from it on, to the end, both errors are within the row's tolerance
};

/// @param curve  of one run, by iteration; not empty
[[nodiscard]] Milestones milestones_of(std::span<const study::CurvePoint> curve, const study::Row& row);

/// Sorts the points by run and iteration, and tells each run's stretch of them.
[[nodiscard]] std::vector<std::span<const study::CurvePoint>> curves_of(std::vector<study::CurvePoint>& points);

}  // namespace gridmerge::page
