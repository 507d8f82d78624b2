#include "methods/hough_spectrum/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gridmerge::hough {
namespace {

struct Direction {
  float cos = 0;
  float sin = 0;
};

std::vector<Direction> directions(const HoughTransform& transform) {
  std::vector<Direction> all(static_cast<std::size_t>(transform.angles));
  for (int k = 0; k < transform.angles; ++k) {
    const double angle = transform.angle_rad(k);
    all[static_cast<std::size_t>(k)] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
  }
  return all;
}

std::size_t row_start(const HoughTransform& transform, int k) {
  return static_cast<std::size_t>(k) * static_cast<std::size_t>(transform.rhos);
}

}  // namespace

HoughTransform::HoughTransform(int angle_count, double reach_m, double rho_step)
    : angles(angle_count), rho_step_m(rho_step) {
  const int side = static_cast<int>(std::ceil(reach_m / rho_step)) + 1;
  rhos = 2 * side + 1;
  rho_low_m = -side * rho_step;
  votes.assign(static_cast<std::size_t>(angles) * static_cast<std::size_t>(rhos), 0.0F);
}

std::span<const float> HoughTransform::row(int k) const {
  return std::span(votes).subspan(row_start(*this, k), static_cast<std::size_t>(rhos));
}

HoughTransform full_transform(std::span<const WallPoint> walls, int angles, double reach_m, double rho_step_m) {
  HoughTransform transform(angles, reach_m, rho_step_m);
  const std::vector<Direction> direction = directions(transform);
  const float per_bin = static_cast<float>(1 / rho_step_m);
  const float half_up = static_cast<float>(-transform.rho_low_m / rho_step_m) + 0.5F;
  for (int k = 0; k < angles; ++k) {
    const auto [c, s] = direction[static_cast<std::size_t>(k)];
    float* votes = &transform.votes[row_start(transform, k)];
    for (const WallPoint& wall : walls) {
      votes[static_cast<std::size_t>((c * wall.at.x_m + s * wall.at.y_m) * per_bin + half_up)] += 1;
    }
  }
  return transform;
}

HoughTransform oriented_transform(std::span<const OrientedWall> walls, int angles, double reach_m, double rho_step_m,
                                  double spread_rad) {
  HoughTransform transform(angles, reach_m, rho_step_m);
  const std::vector<Direction> direction = directions(transform);
  const float per_bin = static_cast<float>(1 / rho_step_m);
  const float first = static_cast<float>(-transform.rho_low_m / rho_step_m);
  const double per_rad = angles / (2 * kPi);
  const double spread = spread_rad * per_rad;  // in bins
  const auto vote = [&](const OrientedWall& wall, double normal_rad) {
    const double centre = normal_rad * per_rad;
    const int last = static_cast<int>(std::floor(centre + spread));
    for (int k = static_cast<int>(std::ceil(centre - spread)); k <= last; ++k) {
      const int wrapped = (k % angles + angles) % angles;
      const auto [c, s] = direction[static_cast<std::size_t>(wrapped)];
      const float rho = (c * wall.at.x_m + s * wall.at.y_m) * per_bin + first;
      const auto bin = static_cast<std::size_t>(rho);
      const float share = rho - static_cast<float>(bin);
      // A vote is split between two bins: cells in rank and file would else favour the grid's own axes.
      float* votes = &transform.votes[row_start(transform, wrapped) + bin];
      votes[0] += wall.weight * (1 - share);
      votes[1] += wall.weight * share;
    }
  };
  for (const OrientedWall& wall : walls) {
    if (wall.facing != Facing::kUnclear) {
      vote(wall, wall.normal_rad);
    }
    if (wall.facing == Facing::kEither) {
      vote(wall, wall.normal_rad + kPi);
    }
  }
  return transform;
}

std::vector<float> hough_spectrum(const HoughTransform& transform) {
  std::vector<float> spectrum(static_cast<std::size_t>(transform.angles));
  for (int k = 0; k < transform.angles; ++k) {
    const std::span<const float> row = transform.row(k);
    spectrum[static_cast<std::size_t>(k)] = std::inner_product(row.begin(), row.end(), row.begin(), 0.0F);
  }
  return spectrum;
}

double contrast(std::span<const float> spectrum) {
  const double sum = std::accumulate(spectrum.begin(), spectrum.end(), 0.0);
  return sum > 0 ? *std::max_element(spectrum.begin(), spectrum.end()) * static_cast<double>(spectrum.size()) / sum : 1;
}

std::vector<Peak> periodic_peaks(std::span<const float> values) {
  const std::size_t n = values.size();
  std::vector<Peak> peaks;
  for (std::size_t i = 0; i < n; ++i) {
    const double before = values[(i + n - 1) % n];
    const double here = values[i];
    const double after = values[(i + 1) % n];
    if (here > before && here >= after) {
      const double off = 0.5 * (before - after) / (before - 2 * here + after);
      const double at = static_cast<double>(i) + off;
      peaks.push_back({at < 0 ? at + static_cast<double>(n) : at, here - 0.25 * (before - after) * off});
    }
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.value > b.value; });
  return peaks;
}

}  // namespace gridmerge::hough
