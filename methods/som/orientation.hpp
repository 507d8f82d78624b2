#pragma once
/// How far one map is turned against the other: the histogram of its clusters' normals, tuned by the Radon transform.
#include <optional>
#include <span>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/grid/cluster_points.hpp"

namespace gridmerge::som {

/// Bins of a degree, the first at 0. Metres of wall that face each direction; a wall without a side counts half for
/// each of its two. Blurred by a Gaussian.
using NormalHistogram = std::vector<float>;
inline constexpr int kHistogramBins = 360;

[[nodiscard]] NormalHistogram normal_histogram(std::span<const ClusterPoint> clusters, double blur_deg);

/// How sharp the map's projections are: for directions over half a turn, the first along x, the sum of squares of the
/// Radon transform of the clusters, less its mean, scaled to length 1. High where walls are seen end on.
using Sharpness = std::vector<float>;
inline constexpr int kSharpnessSteps = 360;  ///< of half a degree

[[nodiscard]] Sharpness projection_sharpness(std::span<const ClusterPoint> clusters, double bin_m);

/// A turn of the source that may be right.
struct Rotation {
  double angle_rad = 0;  ///< of the source in the target's frame
  double score = 0;      ///< of the correlation at it, as a share of the best there can be
};

/// What correlating both maps' histograms and sharpness gives.
struct RotationSpectrum {
  std::vector<float> normals;    ///< for a turn of so many degrees
  std::vector<float> sharpness;  ///< for a turn of so many half degrees, over half a turn
};

[[nodiscard]] RotationSpectrum rotation_spectrum(std::span<const ClusterPoint> target,
                                                 std::span<const ClusterPoint> source, double blur_deg, double bin_m);

struct RotationOptions {
  double tuning_rad = 0;      ///< how far a turn may be moved to where the projections agree best
  double flank_rad = 0;       ///< turns this far to either side of a good one are tried too; 0: not
  std::size_t at_most = 100;  ///< without the flanks
};

/// The local maxima of the normals' correlation inside the window, best first, tuned and with their flanks. The middle
/// of a window that shuts some turns out is always among them.
[[nodiscard]] std::vector<Rotation> rotations(const RotationSpectrum& spectrum, const RotationOptions& options,
                                              const std::optional<PoseWindow>& window);

}  // namespace gridmerge::som
