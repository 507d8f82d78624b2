#include "methods/hough_spectrum/axis_spectra.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::hough {
namespace {

constexpr int kFacings = 2;      ///< along the axis and against it
constexpr int kLatticeBins = 2;  ///< bins of offset to a step of the lattice

/// Rows of a transform must start where FFTW's aligned loads may: every eighth number.
int aligned_size(double at_least) { return 8 * fast_size(static_cast<int>(std::ceil(at_least / 8)) + 1); }

/// 1 for a wall right across the axis, 0 from `spread_rad` on.
float share_of(double off_rad, double spread_rad) {
  const double off = off_rad / spread_rad;
  return static_cast<float>(std::max(0.0, 1 - off * off));
}

}  // namespace

Point2 Agreement::translation(double x_steps, double y_steps) const {
  const double x = x_steps * step_m;
  const double y = y_steps * step_m;
  return {std::cos(axis_rad) * x - std::sin(axis_rad) * y, std::sin(axis_rad) * x + std::cos(axis_rad) * y};
}

AxisMatcher::AxisMatcher(double target_reach_m, double source_reach_m, const AxisOptions& options)
    : options_(options),
      reach_m_(target_reach_m + source_reach_m),
      stretches_(static_cast<int>(std::ceil(2 * std::max(target_reach_m, source_reach_m) / options.stretch_m)) + 3),
      bins_(aligned_size(2 * reach_m_ / options.offset_step_m + 4)),
      spectrum_stride_((static_cast<std::size_t>(bins_) / 2 + 1 + 3) / 4 * 4),
      transform_(bins_),
      filter_(transform_.spectrum_size()) {
  for (std::size_t f = 0; f < filter_.size(); ++f) {
    const double per_m = static_cast<double>(f) / (bins_ * options.offset_step_m);
    const auto low_pass = [&](double sigma_m) { return std::exp(-2 * std::pow(kPi * per_m * sigma_m, 2)); };
    const double band = low_pass(options.blur_m) * (f == 0 ? 0 : 1 - low_pass(options.background_m));
    filter_[f] = static_cast<float>(band / bins_);
  }
}

std::vector<float> AxisMatcher::binned(std::span<const OrientedWall> walls, double axis_rad) const {
  const auto bins = static_cast<std::size_t>(bins_);
  std::vector<float> votes(static_cast<std::size_t>(kFacings * stretches_) * bins, 0.0F);
  const float c = static_cast<float>(std::cos(axis_rad));
  const float s = static_cast<float>(std::sin(axis_rad));
  const float per_bin = static_cast<float>(1 / options_.offset_step_m);
  const float per_stretch = static_cast<float>(1 / options_.stretch_m);
  const auto vote = [&](const OrientedWall& wall, int facing, float weight) {
    const float offset = (c * wall.at.x_m + s * wall.at.y_m) * per_bin + static_cast<float>(bins_ / 2);
    const float along = (c * wall.at.y_m - s * wall.at.x_m) * per_stretch + static_cast<float>(stretches_) / 2 - 0.5F;
    const auto bin = static_cast<std::size_t>(offset);
    const auto stretch = static_cast<std::size_t>(along);
    const float next_bin = offset - static_cast<float>(bin);
    const float next_stretch = along - static_cast<float>(stretch);
    float* row = &votes[(static_cast<std::size_t>(facing * stretches_) + stretch) * bins + bin];
    row[0] += weight * (1 - next_stretch) * (1 - next_bin);
    row[1] += weight * (1 - next_stretch) * next_bin;
    row[bins] += weight * next_stretch * (1 - next_bin);
    row[bins + 1] += weight * next_stretch * next_bin;
  };
  for (const OrientedWall& wall : walls) {
    if (wall.facing == Facing::kUnclear) {
      continue;
    }
    const double off = std::abs(wrap_angle(static_cast<double>(wall.normal_rad) - axis_rad));
    float along = share_of(off, options_.spread_rad);
    float against = share_of(kPi - off, options_.spread_rad);
    if (wall.facing == Facing::kEither) {
      along = against = std::max(along, against);
    }
    if (along > 0) {
      vote(wall, 0, along * wall.weight);
    }
    if (against > 0) {
      vote(wall, 1, against * wall.weight);
    }
  }
  return votes;
}

std::vector<float> AxisMatcher::axis_spectrum(std::span<const OrientedWall> walls, double axis_rad) const {
  const std::vector<float> votes = binned(walls, axis_rad);
  const auto bins = static_cast<std::size_t>(bins_);
  std::vector<float> sum(bins, 0.0F);
  for (std::size_t i = 0; i < votes.size(); ++i) {
    sum[i % bins] += votes[i];
  }
  return sum;
}

AxisMatcher::Spectrum AxisMatcher::transformed(std::span<const OrientedWall> walls, double axis_rad) const {
  const std::vector<float> votes = binned(walls, axis_rad);
  const auto bins = static_cast<std::size_t>(bins_);
  const std::size_t rows = static_cast<std::size_t>(kFacings * stretches_);
  Spectrum spectrum = spectrum_array(rows * spectrum_stride_);
  const FourierArray<float> row = real_array(bins);
  for (std::size_t r = 0; r < rows; ++r) {
    // The root makes a product of two walls as long as their shorter one, not as their lengths multiplied.
    std::transform(votes.begin() + static_cast<std::ptrdiff_t>(r * bins),
                   votes.begin() + static_cast<std::ptrdiff_t>((r + 1) * bins), row.get(),
                   [](float v) { return std::sqrt(v); });
    transform_.forward(row.get(), &spectrum[r * spectrum_stride_]);
  }
  return spectrum;
}

std::vector<float> AxisMatcher::correlated(const Spectrum& target, const Spectrum& source) const {
  const auto bins = static_cast<std::size_t>(bins_);
  const std::size_t frequencies = transform_.spectrum_size();
  std::vector<float> result(static_cast<std::size_t>(2 * stretches_ + 1) * bins, 0.0F);
  const Spectrum sum = spectrum_array(spectrum_stride_);
  const FourierArray<float> row = real_array(bins);
  for (int shift = -stretches_ + 1; shift < stretches_; ++shift) {
    std::fill_n(sum.get(), frequencies, std::complex<float>{});
    for (int facing = 0; facing < kFacings; ++facing) {
      for (int i = std::max(0, -shift); i < std::min(stretches_, stretches_ - shift); ++i) {
        const std::complex<float>* s = &source[static_cast<std::size_t>(facing * stretches_ + i) * spectrum_stride_];
        const std::complex<float>* t =
            &target[static_cast<std::size_t>(facing * stretches_ + i + shift) * spectrum_stride_];
        for (std::size_t f = 0; f < frequencies; ++f) {
          const float re = t[f].real() * s[f].real() + t[f].imag() * s[f].imag();
          const float im = t[f].imag() * s[f].real() - t[f].real() * s[f].imag();
          sum[f] = {sum[f].real() + re, sum[f].imag() + im};
        }
      }
    }
    for (std::size_t f = 0; f < frequencies; ++f) {
      sum[f] *= filter_[f];
    }
    transform_.backward(sum.get(), row.get());
    std::copy_n(row.get(), bins, result.begin() + static_cast<std::ptrdiff_t>((shift + stretches_) * bins_));
  }
  return result;
}

MapSpectra AxisMatcher::spectra(std::span<const OrientedWall> walls, double axis_rad) const {
  return {transformed(walls, axis_rad), transformed(walls, axis_rad + kPi / 2)};
}

Agreement AxisMatcher::agreement(const MapSpectra& target, const MapSpectra& source, double target_axis_rad) const {
  // By row: a shift of whole stretches; by column: a shift of offset bins, cyclically.
  const std::vector<float> across_x = correlated(target.x, source.x);
  const std::vector<float> across_y = correlated(target.y, source.y);

  Agreement result{
      .axis_rad = target_axis_rad, .side = 0, .step_m = kLatticeBins * options_.offset_step_m, .value = {}};
  result.side = static_cast<int>(reach_m_ / result.step_m);
  const int columns = result.columns();
  result.value.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(columns));
  const auto bins = static_cast<std::size_t>(bins_);
  const auto offset_bin = [&](int steps) { return static_cast<std::size_t>((steps * kLatticeBins + bins_) % bins_); };
  struct Between {
    std::size_t row;
    float next;
  };
  const auto stretch_row = [&](int steps) {
    const double stretches =
        std::clamp(steps * result.step_m / options_.stretch_m + stretches_, 0.0, 2.0 * stretches_ - 1e-6);
    const auto row = static_cast<std::size_t>(stretches);
    return Between{row * bins, static_cast<float>(stretches - static_cast<double>(row))};
  };
  std::vector<std::size_t> bin_of(static_cast<std::size_t>(columns));
  std::vector<Between> row_of(static_cast<std::size_t>(columns));
  for (int x = -result.side; x <= result.side; ++x) {
    bin_of[static_cast<std::size_t>(x + result.side)] = offset_bin(x);
    row_of[static_cast<std::size_t>(x + result.side)] = stretch_row(-x);  // y's stretches run along -x
  }
  for (int y = -result.side; y <= result.side; ++y) {
    const Between along = stretch_row(y);
    const float* here = &across_x[along.row];
    const float* next = here + bins;
    const float* fine_y = &across_y[offset_bin(y)];
    float* value = &result.value[static_cast<std::size_t>(y + result.side) * static_cast<std::size_t>(columns)];
    for (std::size_t i = 0; i < bin_of.size(); ++i) {
      const std::size_t bin = bin_of[i];
      const Between& across = row_of[i];
      value[i] = here[bin] + along.next * (next[bin] - here[bin]) + fine_y[across.row] +
                 across.next * (fine_y[across.row + bins] - fine_y[across.row]);
    }
  }
  return result;
}

std::vector<Translation> best_translations(const Agreement& agreement, std::size_t at_most,
                                           const std::optional<PoseWindow>& window) {
  const int columns = agreement.columns();
  const auto value = [&](int column, int row) {
    return agreement
        .value[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  };
  const auto worse = [](const Translation& a, const Translation& b) { return a.value > b.value; };
  std::vector<Translation> best;
  float bar = 0;
  for (int row = 1; row + 1 < columns; ++row) {
    for (int column = 1; column + 1 < columns; ++column) {
      const float v = value(column, row);
      if (v <= bar || v < value(column - 1, row) || v < value(column + 1, row) || v < value(column, row - 1) ||
          v < value(column, row + 1) || v < value(column - 1, row - 1) || v < value(column + 1, row - 1) ||
          v < value(column - 1, row + 1) || v < value(column + 1, row + 1)) {
        continue;
      }
      const Point2 at = agreement.translation(column - agreement.side, row - agreement.side);
      if (window && norm(at - window->centre.translation()) > window->radius_m) {
        continue;
      }
      best.push_back({at, v});
      std::push_heap(best.begin(), best.end(), worse);
      if (best.size() > at_most) {
        std::pop_heap(best.begin(), best.end(), worse);
        best.pop_back();
        bar = static_cast<float>(best.front().value);
      }
    }
  }
  std::sort_heap(best.begin(), best.end(), worse);
  return best;
}

}  // namespace gridmerge::hough
