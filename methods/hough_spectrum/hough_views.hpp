#pragma once
/// What the method sees inside, as views.
#include <span>
#include <string>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "methods/hough_spectrum/axis_spectra.hpp"
#include "methods/hough_spectrum/spectrum.hpp"

namespace gridmerge::hough {

/// A Hough transform over angle and rho.
[[nodiscard]] View transform_view(const std::string& name, const std::string& whose, const HoughTransform& transform);

/// Both spectra, and their cross-correlation (Eq. 2.10) with the rotations that are tried.
[[nodiscard]] std::vector<View> spectrum_views(std::span<const float> target, std::span<const float> source,
                                               std::span<const float> correlation,
                                               std::span<const double> rotations_rad);

/// Both maps' spectra along one axis, and their cross-correlation with the chosen translation.
/// @param axis  "x" or "y"
/// @param step_m  bin of the spectra, whose middle bin is offset 0
[[nodiscard]] std::vector<View> axis_views(const std::string& axis, std::span<const float> target,
                                           std::span<const float> source, double step_m, double chosen_m);

/// The agreement of all translations of one rotation.
[[nodiscard]] View agreement_view(const Agreement& agreement, std::span<const Translation> best);

/// Where the best candidate puts the source, and where the others put its centre.
[[nodiscard]] View hypotheses_view(const std::vector<Candidate>& candidates, const AlignRequest& request);

}  // namespace gridmerge::hough
