#include "gridmerge/align/lattice_scores.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "gridmerge/base/fourier.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

using Complex = std::complex<float>;

/// The half of a real image's spectrum that is stored: columns 0 .. n/2, all rows.
struct HalfSpectrum {
  int columns;
  int rows;

  [[nodiscard]] std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

/// Of a square image, the spectrum of the image turned by a quarter: turned(x, y) = image(y, -x).
void quarter_turned(const HalfSpectrum& half, const Complex* from, Complex* to) {
  // In blocks: one of the two is walked across its rows.
  constexpr int kBlock = 16;
  for (int row0 = 0; row0 < half.rows; row0 += kBlock) {
    for (int column0 = 0; column0 < half.columns; column0 += kBlock) {
      for (int row = row0; row < std::min(row0 + kBlock, half.rows); ++row) {
        for (int column = column0; column < std::min(column0 + kBlock, half.columns); ++column) {
          // Wanted: the spectrum at (row, -column); beyond the stored half it is the conjugate of the opposite.
          to[half.offset(column, row)] = row < half.columns
                                             ? from[half.offset(row, column == 0 ? 0 : half.rows - column)]
                                             : std::conj(from[half.offset(half.rows - row, column)]);
        }
      }
    }
  }
}

/// Two spectra: whose walls are read in whose rewards.
struct SpectrumPair {
  const Complex* __restrict first;
  const Complex* __restrict second;
};

/// Sum of the two cross-correlations, as a spectrum: of the fixed ones with the conjugates of the moving ones, or with
/// these as they are where `sign` is -1.
void correlated(SpectrumPair fixed, SpectrumPair moving, float scale, float sign, std::size_t count,
                Complex* __restrict product) {
  // In plain numbers, which a compiler can do several of at a time; std::complex would look for infinities.
  const auto* a = reinterpret_cast<const float*>(fixed.first);
  const auto* b = reinterpret_cast<const float*>(fixed.second);
  const auto* w = reinterpret_cast<const float*>(moving.first);
  const auto* r = reinterpret_cast<const float*>(moving.second);
  auto* to = reinterpret_cast<float*>(product);
  const float minus = -sign * scale;
  for (std::size_t i = 0; i < 2 * count; i += 2) {
    const float wr = w[i] * scale;
    const float wi = w[i + 1] * minus;
    const float rr = r[i] * scale;
    const float ri = r[i + 1] * minus;
    to[i] = wr * a[i] - wi * a[i + 1] + rr * b[i] - ri * b[i + 1];
    to[i + 1] = wr * a[i + 1] + wi * a[i] + rr * b[i + 1] + ri * b[i];
  }
}

/// What one thread needs.
struct Scratch {
  FourierArray<float> image;
  FourierArray<Complex> walls;
  FourierArray<Complex> reward;
  FourierArray<Complex> turned_walls;
  FourierArray<Complex> turned_reward;
  FourierArray<Complex> product;

  explicit Scratch(const RealTransform& transform)
      : image(real_array(transform.real_size())),
        walls(spectrum_array(transform.spectrum_size())),
        reward(spectrum_array(transform.spectrum_size())),
        turned_walls(spectrum_array(transform.spectrum_size())),
        turned_reward(spectrum_array(transform.spectrum_size())),
        product(spectrum_array(transform.spectrum_size())) {}
};

double norm_of(const float* image, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += static_cast<double>(image[i]) * static_cast<double>(image[i]);
  }
  return std::sqrt(sum);
}

}  // namespace

std::vector<LatticePeak> surface_peaks(const ScoreSurface& surface, int at_most,
                                       const std::function<bool(const LatticePose&)>& accept) {
  std::vector<LatticePeak> peaks;
  const auto lower = [](const LatticePeak& a, const LatticePeak& b) { return a.score > b.score; };
  const int size = surface.size;
  const float* score = surface.score.data();
  float bar = 0;
  for (int row = 0; row < size; ++row) {
    const float* line = &score[surface.offset(0, row)];
    const float* below = &score[surface.offset(0, row == 0 ? size - 1 : row - 1)];
    const float* above = &score[surface.offset(0, row == size - 1 ? 0 : row + 1)];
    for (int column = 0; column < size; ++column) {
      const float v = line[column];
      if (v <= bar) {
        continue;
      }
      const int left = column == 0 ? size - 1 : column - 1;
      const int right = column == size - 1 ? 0 : column + 1;
      if (v < line[left] || v < line[right] || v < below[column] || v < above[column] || v < below[left] ||
          v < below[right] || v < above[left] || v < above[right]) {
        continue;
      }
      const LatticePose at = surface.at(column, row);
      if (!accept(at)) {
        continue;
      }
      peaks.push_back({at, v});
      std::push_heap(peaks.begin(), peaks.end(), lower);
      if (peaks.size() > static_cast<std::size_t>(at_most)) {
        std::pop_heap(peaks.begin(), peaks.end(), lower);
        peaks.pop_back();
        bar = peaks.front().score;
      }
    }
  }
  return peaks;
}

LatticeScores score_lattice(const PoseLattice& lattice, const RunContext& context,
                            const std::function<void(const ScoreSurface&, std::size_t)>& visit, Torus torus) {
  const MapLevel& fixed = lattice.fixed_level();
  const int reach = lattice.reach();
  // As wide as both maps side by side, so that no translation wraps round onto another; for a shared torus, as wide as
  // either map with half of the other. Square, so that a quarter turn of an image is a quarter turn of its spectrum.
  const int widest = std::max(fixed.width, fixed.height);
  const int size =
      fast_square_size(torus == Torus::kWhole ? widest + 2 * reach + 1 : std::max(widest + reach, 2 * reach) + 1);
  const RealTransform transform(size, size);
  const HalfSpectrum half{.columns = size / 2 + 1, .rows = size};
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) + static_cast<std::size_t>(column);
  };

  const auto fixed_reward = spectrum_array(transform.spectrum_size());
  const auto fixed_walls = spectrum_array(transform.spectrum_size());
  double fixed_reward_norm = 0;
  double fixed_walls_norm = 0;
  {
    const auto image = real_array(transform.real_size());
    for (int row = 0; row < fixed.height; ++row) {
      const std::int8_t* values = &lattice.fixed_table().value[fixed.offset(0, row)];
      std::copy(values, values + fixed.width, &image[at(0, row)]);
    }
    fixed_reward_norm = norm_of(image.get(), transform.real_size());
    transform.forward(image.get(), fixed_reward.get());
    std::fill_n(image.get(), transform.real_size(), 0.0F);
    for (const CellWeight& wall : lattice.fixed_walls()) {
      image[at(wall.column, wall.row)] += static_cast<float>(wall.weight);
    }
    fixed_walls_norm = norm_of(image.get(), transform.real_size());
    transform.forward(image.get(), fixed_walls.get());
  }

  const auto groups = static_cast<std::size_t>(lattice.groups());
  const auto workers = static_cast<std::size_t>(std::max(1, context.num_threads));
  std::vector<std::unique_ptr<Scratch>> scratch_of(workers);
  std::vector<double> rounding_of(groups, 0.0);
  std::atomic<int> left_out = 0;
  const double unit = 3 * 7 * std::ldexp(1.0, -24) * 2 * std::log2(static_cast<double>(size));

  parallel_for(groups, context.num_threads, [&](std::size_t group, std::size_t worker) {
    if (context.stop.stop_requested()) {
      ++left_out;
      return;
    }
    if (!scratch_of[worker]) {
      scratch_of[worker] = std::make_unique<Scratch>(transform);
    }
    Scratch& scratch = *scratch_of[worker];
    float* image = scratch.image.get();

    // The moving map round the torus's corner: cell (0, 0) is its local origin.
    const TurnedMap moving = lattice.turned(static_cast<int>(group));
    const auto wrapped = [&](int cell) { return cell < 0 ? cell + size : cell; };
    std::fill_n(image, transform.real_size(), 0.0F);
    for (const CellWeight& wall : moving.walls) {
      image[at(wrapped(wall.column), wrapped(wall.row))] += static_cast<float>(wall.weight);
    }
    const double walls_norm = norm_of(image, transform.real_size());
    transform.forward(image, scratch.walls.get());
    std::fill_n(image, transform.real_size(), 0.0F);
    const int side = 2 * reach + 1;
    for (int row = -reach; row <= reach; ++row) {
      const std::int8_t* values =
          &moving.reward[static_cast<std::size_t>(row + reach) * static_cast<std::size_t>(side)];
      std::copy(values + reach, values + side, &image[at(0, wrapped(row))]);
      std::copy(values, values + reach, &image[at(size - reach, wrapped(row))]);
    }
    const double reward_norm = norm_of(image, transform.real_size());
    transform.forward(image, scratch.reward.get());
    rounding_of[group] = unit * (walls_norm * fixed_reward_norm + reward_norm * fixed_walls_norm);
    if (lattice.turns() == 4) {
      quarter_turned(half, scratch.walls.get(), scratch.turned_walls.get());
      quarter_turned(half, scratch.reward.get(), scratch.turned_reward.get());
    }

    const float scale = 1 / static_cast<float>(transform.real_size());
    for (int quarters = 0; quarters < lattice.turns(); ++quarters) {
      if (context.stop.stop_requested()) {
        ++left_out;
        return;
      }
      const Complex* walls = quarters % 2 == 0 ? scratch.walls.get() : scratch.turned_walls.get();
      const Complex* reward = quarters % 2 == 0 ? scratch.reward.get() : scratch.turned_reward.get();
      // Turned by a half, a real image's spectrum becomes its conjugate.
      const float sign = quarters < 2 ? 1.0F : -1.0F;
      correlated({fixed_reward.get(), fixed_walls.get()}, {walls, reward}, scale, sign, transform.spectrum_size(),
                 scratch.product.get());
      transform.backward(scratch.product.get(), image);
      visit({.angle = static_cast<int>(group) * lattice.turns() + quarters,
             .size = size,
             .width = fixed.width,
             .height = fixed.height,
             .reach = reach,
             .rounding = rounding_of[group],
             .score = {image, transform.real_size()}},
            worker);
    }
  });

  LatticeScores scores;
  scores.poses = static_cast<double>(lattice.angles()) * (fixed.width + 2 * reach) * (fixed.height + 2 * reach);
  scores.rounding = *std::max_element(rounding_of.begin(), rounding_of.end());
  scores.stopped = left_out > 0;
  return scores;
}

}  // namespace gridmerge
