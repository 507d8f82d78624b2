#pragma once
/// The Hough transform of a map's walls, its spectrum over angle, and how two spectra are turned against each other.
#include <span>
#include <vector>

#include "methods/hough_spectrum/oriented_walls.hpp"

namespace gridmerge::hough {

/// HT(rho, k): votes for the line x cos(theta_k) + y sin(theta_k) = rho, theta_k = k * 2 pi / angles.
struct HoughTransform {
  int angles = 0;
  int rhos = 0;
  double rho_step_m = 0;
  double rho_low_m = 0;      ///< of the first bin's centre
  std::vector<float> votes;  ///< one row of `rhos` for each angle

  HoughTransform(int angle_count, double reach_m, double rho_step);
  [[nodiscard]] double angle_rad(int k) const { return 2 * kPi * k / angles; }
  [[nodiscard]] std::span<const float> row(int k) const;
};

/// Every occupied cell votes for all lines through it, each time for the nearest bin.
[[nodiscard]] HoughTransform full_transform(std::span<const WallPoint> walls, int angles, double reach_m,
                                            double rho_step_m);

/// A wall votes only for lines whose normal lies within `spread_rad` of its own, on the side it faces; where that is
/// not known, on both.
[[nodiscard]] HoughTransform oriented_transform(std::span<const OrientedWall> walls, int angles, double reach_m,
                                                double rho_step_m, double spread_rad);

/// Eq. 2.9: HS(k) = sum over rho of HT(rho, k)^2.
[[nodiscard]] std::vector<float> hough_spectrum(const HoughTransform& transform);

/// How much the strongest directions of a spectrum stand out: its highest value over its mean; 1 for a flat one.
[[nodiscard]] double contrast(std::span<const float> spectrum);

/// A maximum of a periodic sequence, between its samples.
struct Peak {
  double at = 0;  ///< in samples, 0 <= at < size
  double value = 0;
};

/// The local maxima, highest first, each placed by a parabola through three samples.
[[nodiscard]] std::vector<Peak> periodic_peaks(std::span<const float> values);

}  // namespace gridmerge::hough
