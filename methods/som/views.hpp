#pragma once
/// What the method sees inside, for whoever watches.
#include <span>
#include <string>

#include "gridmerge/base/trace.hpp"
#include "methods/som/orientation.hpp"
#include "methods/som/translation.hpp"

namespace gridmerge::som {

/// The neurons over one map, each with its normal.
[[nodiscard]] View neurons_view(MapView::Map map, std::span<const ClusterPoint> clusters);

/// The histograms of both maps' normals.
[[nodiscard]] View normals_view(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source,
                                double blur_deg);

/// The circular correlations of normals and of projections, with the turns chosen.
[[nodiscard]] View turns_view(const RotationSpectrum& spectrum, std::span<const Rotation> turns);

/// The votes for translations at one turn, with their best peaks.
[[nodiscard]] View votes_view(const VoteSurface& surface, std::span<const ScoredPose> peaks);

/// Both maps at a pose, matched clusters joined.
[[nodiscard]] View matches_view(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source,
                                const ClusterMatch& match, const Pose2& local_target_from_source);

}  // namespace gridmerge::som
