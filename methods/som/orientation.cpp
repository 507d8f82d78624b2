#include "methods/som/orientation.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/base/fourier.hpp"

namespace gridmerge::som {
namespace {

constexpr double kSharpnessStep_rad = kPi / kSharpnessSteps;
/// A turn with at least this share of the best one's score has its flanks tried.
constexpr double kGoodTurn = 0.3;

std::size_t wrapped(int index, int count) { return static_cast<std::size_t>(((index % count) + count) % count); }

/// Shares a weight between the two bins next to a place on a circle.
void add_between(std::vector<float>& bins, double at, float weight) {
  const double low = std::floor(at);
  const auto share = static_cast<float>(at - low);
  const int count = static_cast<int>(bins.size());
  bins[wrapped(static_cast<int>(low), count)] += (1 - share) * weight;
  bins[wrapped(static_cast<int>(low) + 1, count)] += share * weight;
}

std::vector<float> blurred(const std::vector<float>& bins, double sigma) {
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  const int count = static_cast<int>(bins.size());
  std::vector<float> kernel;
  float sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma))));
    sum += kernel.back();
  }
  std::vector<float> result(bins.size(), 0);
  for (int i = 0; i < count; ++i) {
    for (int k = -reach; k <= reach; ++k) {
      result[static_cast<std::size_t>(i)] +=
          kernel[static_cast<std::size_t>(k + reach)] / sum * bins[wrapped(i + k, count)];
    }
  }
  return result;
}

/// Less its mean, and scaled to length 1: a correlation of two such is 1 at the best.
void normalise(std::vector<float>& values) {
  float mean = 0;
  for (const float v : values) {
    mean += v / static_cast<float>(values.size());
  }
  float length2 = 0;
  for (float& v : values) {
    v -= mean;
    length2 += v * v;
  }
  if (length2 > 0) {
    for (float& v : values) {
      v /= std::sqrt(length2);
    }
  }
}

/// The top of the parabola through three neighbours, from the middle one, in [-1/2, 1/2].
double parabola_top(double left, double middle, double right) {
  const double bend = left - 2 * middle + right;
  return bend < 0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0;
}

double top_near(const std::vector<float>& values, int index) {
  const int count = static_cast<int>(values.size());
  return parabola_top(static_cast<double>(values[wrapped(index - 1, count)]),
                      static_cast<double>(values[wrapped(index, count)]),
                      static_cast<double>(values[wrapped(index + 1, count)]));
}

/// Moved uphill on the sharpness' correlation, if there is a top within reach.
double tuned(const std::vector<float>& sharpness, double angle_rad, double reach_rad) {
  const int count = static_cast<int>(sharpness.size());
  const int middle = static_cast<int>(std::lround(angle_rad / kSharpnessStep_rad));
  const int reach = static_cast<int>(reach_rad / kSharpnessStep_rad);
  int best = middle;
  for (int i = middle - reach; i <= middle + reach; ++i) {
    if (sharpness[wrapped(i, count)] > sharpness[wrapped(best, count)]) {
      best = i;
    }
  }
  const bool is_top = sharpness[wrapped(best, count)] >= sharpness[wrapped(best - 1, count)] &&
                      sharpness[wrapped(best, count)] >= sharpness[wrapped(best + 1, count)] &&
                      sharpness[wrapped(best, count)] > 0;
  return is_top ? (best + top_near(sharpness, best)) * kSharpnessStep_rad : angle_rad;
}

void sort_best_first(std::vector<Rotation>& turns) {
  std::stable_sort(turns.begin(), turns.end(), [](const Rotation& a, const Rotation& b) { return a.score > b.score; });
}

bool is_near(const Rotation& one, double angle_rad, double reach_rad) {
  return std::abs(wrap_angle(one.angle_rad - angle_rad)) <= reach_rad;
}

/// The local maxima over all turns, in order of angle.
std::vector<Rotation> tops(const RotationSpectrum& spectrum, double tuning_rad) {
  const std::vector<float>& c = spectrum.normals;
  std::vector<Rotation> found;
  for (int i = 0; i < kHistogramBins; ++i) {
    const float value = c[static_cast<std::size_t>(i)];
    if (value >= c[wrapped(i - 1, kHistogramBins)] && value > c[wrapped(i + 1, kHistogramBins)]) {
      const double angle = tuned(spectrum.sharpness, radians(i + top_near(c, i)), tuning_rad);
      found.push_back({wrap_angle(angle), static_cast<double>(value)});
    }
  }
  return found;
}

/// Maps bent by drift agree here at one angle, there at another.
void add_flanks(std::vector<Rotation>& turns, double flank_rad) {
  const std::size_t count = turns.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (turns[k].score < kGoodTurn * turns[0].score) {
      continue;
    }
    for (const double side_rad : {-flank_rad, flank_rad}) {
      const double angle = wrap_angle(turns[k].angle_rad + side_rad);
      if (std::none_of(turns.begin(), turns.end(),
                       [&](const Rotation& other) { return is_near(other, angle, 0.5 * flank_rad); })) {
        turns.push_back({angle, 0.5 * turns[k].score});
      }
    }
  }
}

}  // namespace

NormalHistogram normal_histogram(std::span<const ClusterPoint> clusters, double blur_deg) {
  NormalHistogram histogram(kHistogramBins, 0);
  for (const ClusterPoint& one : clusters) {
    if (one.normal.x_m == 0 && one.normal.y_m == 0) {
      continue;
    }
    const double facing_deg =
        degrees(std::atan2(static_cast<double>(one.normal.y_m), static_cast<double>(one.normal.x_m)));
    add_between(histogram, facing_deg, one.sided ? one.weight : 0.5F * one.weight);
    if (!one.sided) {
      add_between(histogram, facing_deg + 180, 0.5F * one.weight);
    }
  }
  return blurred(histogram, blur_deg);
}

Sharpness projection_sharpness(std::span<const ClusterPoint> clusters, double bin_m) {
  Sharpness sharpness(kSharpnessSteps, 0);
  float radius = 0;
  for (const ClusterPoint& one : clusters) {
    radius = std::max(radius, std::hypot(one.at.x_m, one.at.y_m));
  }
  const auto per_bin = static_cast<float>(1 / bin_m);
  const float middle = std::ceil(radius * per_bin) + 1;
  std::vector<float> projection(static_cast<std::size_t>(2 * middle) + 2);
  for (int k = 0; k < kSharpnessSteps; ++k) {
    std::fill(projection.begin(), projection.end(), 0.0F);
    const auto c = static_cast<float>(std::cos(k * kSharpnessStep_rad)) * per_bin;
    const auto s = static_cast<float>(std::sin(k * kSharpnessStep_rad)) * per_bin;
    for (const ClusterPoint& one : clusters) {
      const float at = c * one.at.x_m + s * one.at.y_m + middle;
      const auto low = static_cast<std::size_t>(at);
      const float share = at - static_cast<float>(low);
      projection[low] += (1 - share) * one.weight;
      projection[low + 1] += share * one.weight;
    }
    for (const float sum : projection) {
      sharpness[static_cast<std::size_t>(k)] += sum * sum;
    }
  }
  normalise(sharpness);
  return sharpness;
}

RotationSpectrum rotation_spectrum(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source,
                                   double blur_deg, double bin_m) {
  NormalHistogram target_normals = normal_histogram(target, blur_deg);
  NormalHistogram source_normals = normal_histogram(source, blur_deg);
  normalise(target_normals);
  normalise(source_normals);
  return {.normals = circular_correlation(source_normals, target_normals),
          .sharpness = circular_correlation(projection_sharpness(source, bin_m), projection_sharpness(target, bin_m))};
}

std::vector<Rotation> rotations(const RotationSpectrum& spectrum, const RotationOptions& options,
                                const std::optional<PoseWindow>& window) {
  std::vector<Rotation> turns = tops(spectrum, options.tuning_rad);
  const bool fenced = window && window->angle_rad < kPi;
  const auto shut_out = [&](const Rotation& one) {
    return fenced && !is_near(one, window->centre.theta_rad, window->angle_rad);
  };
  std::erase_if(turns, shut_out);
  sort_best_first(turns);
  turns.resize(std::min(turns.size(), options.at_most));
  if (options.flank_rad > 0) {
    add_flanks(turns, options.flank_rad);
    std::erase_if(turns, shut_out);
    sort_best_first(turns);
  }
  if (fenced) {
    turns.push_back({window->centre.theta_rad, 0});
  }
  return turns;
}

}  // namespace gridmerge::som
