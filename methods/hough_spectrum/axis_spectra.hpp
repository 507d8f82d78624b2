#pragma once
/// X- and Y-spectra of two maps turned alike, and the translations at which they agree.
///
/// The X-spectrum of a map is the row of its Hough transform across one direction: the votes of all walls that face
/// along it, by their offset. Here it is kept apart by the side that walls face, and by stretches along the walls: a
/// wall then meets only walls that face the same way and lie in the same stretch.
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/base/fourier.hpp"
#include "methods/hough_spectrum/oriented_walls.hpp"

namespace gridmerge::hough {

struct AxisOptions {
  double offset_step_m = 0.1;  ///< bin of a spectrum
  double stretch_m = 2;        ///< length of a stretch along the walls
  double blur_m = 0.2;         ///< standard deviation by which offsets may differ
  double background_m = 1;     ///< standard deviation of the background that is taken off; infinite: the mean alone
  double spread_rad = radians(30);  ///< how far a wall's normal may lie off the axis
};

/// The translations of one rotation, along two axes at right angles.
struct Agreement {
  double axis_rad = 0;  ///< of x, in the target's local frame
  int side = 0;         ///< the lattice runs from -side to side, in x and in y
  double step_m = 0;
  std::vector<float> value;  ///< (2 side + 1)^2, row-major: a row for each y

  [[nodiscard]] int columns() const { return 2 * side + 1; }
  /// The translation of a lattice point, in the target's local frame.
  [[nodiscard]] Point2 translation(double x_steps, double y_steps) const;
};

/// A local maximum of an agreement.
struct Translation {
  Point2 at;  ///< in the target's local frame
  double value = 0;
};

/// X- and Y-spectra of one map at one angle, Fourier transformed: a row for each facing and stretch.
struct MapSpectra {
  FourierArray<std::complex<float>> x;
  FourierArray<std::complex<float>> y;
};

/// For two maps of given sizes. Const and shared by threads.
class AxisMatcher {
 public:
  AxisMatcher(double target_reach_m, double source_reach_m, const AxisOptions& options);
  [[nodiscard]] const AxisOptions& options() const { return options_; }

  /// Of a map of which `axis_rad` is the x axis.
  [[nodiscard]] MapSpectra spectra(std::span<const OrientedWall> walls, double axis_rad) const;

  /// Agreement of all translations. The source's axis is the target's, less the rotation.
  [[nodiscard]] Agreement agreement(const MapSpectra& target, const MapSpectra& source, double target_axis_rad) const;

  /// The spectrum of one map along one axis, summed over facings and stretches: what the paper calls its X-spectrum.
  /// Bin i is for the offset (i - size / 2) * offset_step_m.
  [[nodiscard]] std::vector<float> axis_spectrum(std::span<const OrientedWall> walls, double axis_rad) const;

 private:
  using Spectrum = FourierArray<std::complex<float>>;

  [[nodiscard]] std::vector<float> binned(std::span<const OrientedWall> walls, double axis_rad) const;
  [[nodiscard]] Spectrum transformed(std::span<const OrientedWall> walls, double axis_rad) const;
  [[nodiscard]] std::vector<float> correlated(const Spectrum& target, const Spectrum& source) const;

  AxisOptions options_;
  double reach_m_ = 0;  ///< of a translation between the maps
  int stretches_ = 0;
  int bins_ = 0;
  std::size_t spectrum_stride_ = 0;
  RealTransform transform_;
  std::vector<float> filter_;  ///< by frequency
};

/// The highest local maxima of an agreement, best first; with a window, of those whose translation it allows.
[[nodiscard]] std::vector<Translation> best_translations(const Agreement& agreement, std::size_t at_most,
                                                         const std::optional<PoseWindow>& window);

}  // namespace gridmerge::hough
