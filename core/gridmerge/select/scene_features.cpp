#include "gridmerge/select/scene_features.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gridmerge/align/correlation_sweep.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/grid/pieces.hpp"

namespace gridmerge {
namespace {

constexpr int kHoughLevel = 1;
constexpr double kAngleStep = radians(2);
constexpr double kMostPoints = 2000;
constexpr double kDominant = 0.3;  // of the way from the spectrum's mean to its maximum

/// HS(k) = sum over rho of HT(rho, k)^2 (Eq. 2.9), for lines of all directions modulo half a turn.
std::vector<double> hough_spectrum(const PreparedMap& map) {
  const MapLevel& level = map.level(kHoughLevel);
  const std::vector<ThinnedWall> walls = thinned_walls(map, level);
  const auto step = static_cast<std::size_t>(std::ceil(static_cast<double>(walls.size()) / kMostPoints));
  const int angles = static_cast<int>(std::lround(kPi / kAngleStep));
  const int reach = static_cast<int>(std::ceil(map.radius_m() / level.resolution_m)) + 1;
  std::vector<double> spectrum(static_cast<std::size_t>(angles), 0);
  std::vector<float> lines(static_cast<std::size_t>(2 * reach + 1));
  for (int k = 0; k < angles; ++k) {
    const auto c = static_cast<float>(std::cos(k * kAngleStep) / level.resolution_m);
    const auto s = static_cast<float>(std::sin(k * kAngleStep) / level.resolution_m);
    std::fill(lines.begin(), lines.end(), 0.0F);
    for (std::size_t i = 0; i < walls.size(); i += step) {
      // Above 0, so a cast rounds down: to the nearest, with the half.
      const float rho = c * walls[i].at.x_m + s * walls[i].at.y_m + static_cast<float>(reach) + 0.5F;
      lines[static_cast<std::size_t>(std::clamp(static_cast<int>(rho), 0, 2 * reach))] += walls[i].weight;
    }
    for (const float votes : lines) {
      spectrum[static_cast<std::size_t>(k)] += static_cast<double>(votes) * votes;
    }
  }
  return spectrum;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Circular mean over a few neighbours, so that one wall a little askew makes no direction of its own.
std::vector<double> smoothed(const std::vector<double>& values) {
  constexpr int kReach = 2;
  const int count = static_cast<int>(values.size());
  std::vector<double> result(values.size(), 0);
  for (int k = 0; k < count; ++k) {
    for (int d = -kReach; d <= kReach; ++d) {
      result[static_cast<std::size_t>(k)] +=
          values[static_cast<std::size_t>((k + d + count) % count)] / (2 * kReach + 1);
    }
  }
  return result;
}

int dominant_directions(const std::vector<double>& spectrum) {
  const std::vector<double> smooth = smoothed(spectrum);
  const double mean = mean_of(smooth);
  const double most = *std::max_element(smooth.begin(), smooth.end());
  const double bar = mean + kDominant * (most - mean);
  int directions = 0;
  for (std::size_t k = 0; k < smooth.size(); ++k) {
    const double before = smooth[(k + smooth.size() - 1) % smooth.size()];
    const double after = smooth[(k + 1) % smooth.size()];
    directions += smooth[k] >= bar && smooth[k] > before && smooth[k] >= after ? 1 : 0;
  }
  return directions;
}

double share_in_small_pieces(const PreparedMap& map) {
  constexpr float kSmall = 1;  // [m]
  const std::vector<float> widths_m = piece_widths_m(map);
  const auto small = std::count_if(widths_m.begin(), widths_m.end(), [](float width_m) { return width_m < kSmall; });
  return static_cast<double>(small) / static_cast<double>(widths_m.size());
}

double second_peak(const PreparedMap& map) {
  constexpr double kSamePlace = 1.5;  // [m]
  const SweepOptions options{.lattice = {.angle_step_rad = kPi / 2, .finest_level = 3, .max_cells = 200},
                             .peaks_per_angle = 12};
  const SweepResult found = correlation_sweep(map, map, std::nullopt, options, {});
  double first = 0;
  double second = 0;
  for (const ScoredPose& peak : found.peaks) {
    const bool itself = norm(peak.pose.translation()) < kSamePlace && std::abs(peak.pose.theta_rad) < kPi / 4;
    double& highest = itself ? first : second;
    highest = std::max(highest, peak.score);
  }
  return first > 0 ? std::clamp(second / first, 0.0, 1.0) : 0;
}

bool is_ternary(const PreparedMap& map) {
  return std::all_of(map.occupancy().begin(), map.occupancy().end(), [](std::int8_t percent) {
    return percent == kUnknown || percent == kFree || percent == kOccupied;
  });
}

}  // namespace

std::vector<std::pair<std::string, double>> SceneFeatures::named() const {
  std::vector<std::pair<std::string, double>> all;
  for_each_feature(*this, [&](const char* name, auto value) { all.emplace_back(name, static_cast<double>(value)); });
  return all;
}

std::vector<FeatureText> scene_feature_texts() {
  return {{"straightness", "", "concentration of the Hough spectrum: 0 walls of every direction, 1 of one alone"},
          {"directions", "", "dominant directions of walls, modulo half a turn"},
          {"occupied_cells", "cells", "occupied, at the resolution at which maps are compared"},
          {"known_area_m2", "m2", "free or occupied"},
          {"clutter", "", "share of the occupied cells in pieces less than a metre wide: trunks, furniture, specks"},
          {"self_similarity", "", "second peak of the autocorrelation, as a share of the first"},
          {"ternary", "", "1: every cell is free, occupied or unknown; 0: some say how likely"}};
}

SceneFeatures scene_features(const PreparedMap& map) {
  SceneFeatures features;
  features.occupied_cells = static_cast<double>(map.walls().size());
  features.known_area_m2 = map.known_area_m2();
  features.ternary = is_ternary(map);
  if (map.walls().empty()) {
    return features;
  }
  const std::vector<double> spectrum = hough_spectrum(map);
  features.straightness = 1 - mean_of(spectrum) / *std::max_element(spectrum.begin(), spectrum.end());
  features.directions = dominant_directions(spectrum);
  features.clutter = share_in_small_pieces(map);
  features.self_similarity = second_peak(map);
  return features;
}

}  // namespace gridmerge
