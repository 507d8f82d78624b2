#pragma once
/// Radon transforms of a map's walls, and the rotations between two maps that their sinograms allow.
///
/// A pure shift of a map moves every column of its sinogram (all offsets of one angle) along the offsets; a pure
/// rotation moves the columns round the circle. The spectrum's magnitude along the offsets forgets the shift, so what
/// is left to correlate is the angle alone.
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/base/view.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge::radon {

/// A piece of wall that a projection counts.
struct WallPiece {
  Point2f at;            ///< local frame
  float weight = 0;      ///< 1 where a wall crosses a whole cell; less for a speck
  float normal_rad = 0;  ///< across the wall, where has_normal
  bool has_normal = false;
  bool one_sided = false;  ///< normal_rad points towards the free space it was seen from
};

/// One piece for every cell of a level that holds walls.
[[nodiscard]] std::vector<WallPiece> wall_pieces(const PreparedMap& map, const MapLevel& level);

/// Every occupied cell, as it is.
[[nodiscard]] std::vector<WallPiece> wall_cells(const PreparedMap& map);

/// R(angle, offset): how much wall lies on the line {p : p . (cos, sin)(angle) = offset}.
struct Sinogram {
  int angles = 0;   ///< evenly over a whole turn, from 0
  int offsets = 0;  ///< odd; the middle one is offset 0
  double offset_step_m = 0;
  std::vector<float> value;  ///< row-major, a row an angle

  [[nodiscard]] const float* column(int angle) const {
    return &value[static_cast<std::size_t>(angle) * static_cast<std::size_t>(offsets)];
  }
};

/// Whether a wall counts in all projections, or only in those that look at it from its free side: the plain transform
/// has period pi and cannot tell a map from itself turned round; the directed one can.
enum class Projection { kPlain, kDirected };

/// @param radius_m  no piece lies farther from the local origin
[[nodiscard]] Sinogram sinogram(const std::vector<WallPiece>& pieces, Projection projection, int angles,
                                double offset_step_m, double radius_m);

/// How well the source, turned by each angle (as many as the sinograms have), looks like the target: 1 at the most.
/// Blind to translation. @throws std::invalid_argument unless both have one size and step
[[nodiscard]] std::vector<double> angle_correlation(const Sinogram& target, const Sinogram& source);

/// The published measure: circular correlation of the sum of squares of each angle's projection, mean taken off.
[[nodiscard]] std::vector<double> energy_correlation(const Sinogram& target, const Sinogram& source);

/// A rotation of the source with its uncertainty, as a Gaussian.
struct Rotation {
  double angle_rad = 0;  ///< local_target_from_source
  double sigma_rad = 0;
  double score = 0;
};

/// Local maxima of a correlation over a whole turn, best first, to a fraction of a step (parabola); the width of a peak
/// gives its sigma. Only those in the window; the window's own best where none is. Not empty.
[[nodiscard]] std::vector<Rotation> rotations(const std::vector<double>& correlation,
                                              const std::optional<PoseWindow>& window, std::size_t at_most);

[[nodiscard]] View sinogram_view(const Sinogram& sinogram, const std::string& which);
[[nodiscard]] View correlation_view(const std::vector<double>& correlation, const std::vector<Rotation>& chosen);

}  // namespace gridmerge::radon
