#pragma once
/// What the method sees: keypoints, matches, and which of them a pose brings together.
#include <vector>

#include "gridmerge/base/trace.hpp"
#include "methods/features/rigid_ransac.hpp"

namespace gridmerge {

/// @param poses  best first; the first is shown
void show_matches(TraceSink& trace, const KeypointMatches& found, const std::vector<RansacPose>& poses);

}  // namespace gridmerge
