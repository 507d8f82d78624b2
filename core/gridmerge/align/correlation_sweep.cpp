#include "gridmerge/align/correlation_sweep.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>

#include "gridmerge/base/fourier.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// What one thread needs to do one angle.
struct Scratch {
  FourierArray<float> walls;
  FourierArray<float> table;
  FourierArray<std::complex<float>> walls_spectrum;
  FourierArray<std::complex<float>> table_spectrum;

  explicit Scratch(const RealTransform& transform)
      : walls(real_array(transform.real_size())),
        table(real_array(transform.real_size())),
        walls_spectrum(spectrum_array(transform.spectrum_size())),
        table_spectrum(spectrum_array(transform.spectrum_size())) {}
};

/// The level whose transform stays below `max_cells`, or the coarsest.
int choose_level(const PreparedMap& target, const PreparedMap& source, int max_cells) {
  // Finer than level 2 the sweep would cost more than it finds: what follows it works at level 1 and 0.
  int level = 2;
  const auto side = [&](int k) {
    const MapLevel& t = target.level(k);
    return std::max(t.width, t.height) + 2 * source.radius_m() / t.resolution_m;
  };
  while (level + 1 < PreparedMap::kLevels && side(level) > max_cells) {
    ++level;
  }
  return level;
}

std::vector<double> sweep_angles(const std::optional<PoseWindow>& window, double step) {
  std::vector<double> angles;
  if (!window || window->angle_rad >= kPi - step / 2) {
    const int count = static_cast<int>(std::ceil(2 * kPi / step));
    for (int i = 0; i < count; ++i) {
      angles.push_back(wrap_angle(2 * kPi * i / count));
    }
    return angles;
  }
  const int each_way = static_cast<int>(std::ceil(window->angle_rad / step));
  for (int i = -each_way; i <= each_way; ++i) {
    angles.push_back(wrap_angle(window->centre.theta_rad + (each_way == 0 ? 0 : i * window->angle_rad / each_way)));
  }
  return angles;
}

}  // namespace

SweepResult correlation_sweep(const PreparedMap& target, const PreparedMap& source,
                              const std::optional<PoseWindow>& window, const SweepOptions& options,
                              const RunContext& context) {
  // The smaller map is the one to turn: the transform is then smaller. A window lies in the target's frame, and stays.
  if (!window && source.radius_m() > target.radius_m()) {
    SweepResult swapped = correlation_sweep(source, target, window, options, context);
    for (ScoredPose& peak : swapped.peaks) {
      peak.pose = inverse(peak.pose);
    }
    return swapped;
  }
  const int k = choose_level(target, source, options.max_cells);
  const MapLevel& target_level = target.level(k);
  const MapLevel& source_level = source.level(k);
  const double resolution = target_level.resolution_m;
  const FitTable target_table(target_level, options.fit);
  const FitTable source_table(source_level, options.fit);
  const std::vector<ThinnedWall> target_walls = thinned_walls(target, target_level);
  const std::vector<ThinnedWall> source_walls = thinned_walls(source, source_level);

  // The rotated source lies in a square of `reach` cells each way round its local origin; the transform is as wide as
  // target and source side by side, so that no translation wraps round onto another.
  const int reach = static_cast<int>(std::ceil(source.radius_m() / resolution)) + 1;
  const int width = fast_size(target_level.width + 2 * reach);
  const int height = fast_size(target_level.height + 2 * reach);
  const RealTransform transform(width, height);
  const auto at = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  };

  const auto target_walls_spectrum = spectrum_array(transform.spectrum_size());
  const auto target_table_spectrum = spectrum_array(transform.spectrum_size());
  {
    Scratch scratch(transform);
    for (int row = 0; row < target_level.height; ++row) {
      for (int column = 0; column < target_level.width; ++column) {
        scratch.table[at(column, row)] =
            static_cast<float>(target_table.value[target_level.offset(column, row)]) / FitTable::kFull;
      }
    }
    for (const auto& [wall, weight] : target_walls) {
      const int column = static_cast<int>((wall.x_m - target_level.lower_left.x_m) / resolution);
      const int row = static_cast<int>((wall.y_m - target_level.lower_left.y_m) / resolution);
      scratch.walls[at(column, row)] += weight;
    }
    transform.forward(scratch.table.get(), target_table_spectrum.get());
    transform.forward(scratch.walls.get(), target_walls_spectrum.get());
  }

  const std::vector<double> angles = sweep_angles(window, options.angle_step_rad);
  const auto workers = static_cast<std::size_t>(std::max(1, context.num_threads));
  std::vector<std::unique_ptr<Scratch>> scratch_of(workers);
  std::vector<std::vector<ScoredPose>> peaks_of(angles.size());
  std::atomic<bool> stopped = false;

  parallel_for(angles.size(), context.num_threads, [&](std::size_t index, std::size_t worker) {
    if (context.stop.stop_requested()) {
      stopped = true;
      return;
    }
    if (!scratch_of[worker]) {
      scratch_of[worker] = std::make_unique<Scratch>(transform);
    }
    Scratch& scratch = *scratch_of[worker];
    const double angle = angles[index];
    const float c = static_cast<float>(std::cos(angle));
    const float s = static_cast<float>(std::sin(angle));
    const float per_cell = static_cast<float>(1 / resolution);

    // The source turned about its local origin, which is put on the corner between cells reach-1 and reach.
    std::fill_n(scratch.walls.get(), transform.real_size(), 0.0F);
    std::fill_n(scratch.table.get(), transform.real_size(), 0.0F);
    for (const auto& [wall, weight] : source_walls) {
      const float x = (c * wall.x_m - s * wall.y_m) * per_cell + static_cast<float>(reach);
      const float y = (s * wall.x_m + c * wall.y_m) * per_cell + static_cast<float>(reach);
      scratch.walls[at(static_cast<int>(x), static_cast<int>(y))] += weight;
    }
    const float low_x = static_cast<float>(source_level.lower_left.x_m) * per_cell;
    const float low_y = static_cast<float>(source_level.lower_left.y_m) * per_cell;
    for (int row = 0; row < 2 * reach; ++row) {
      const float y = static_cast<float>(row - reach) + 0.5F;
      for (int column = 0; column < 2 * reach; ++column) {
        const float x = static_cast<float>(column - reach) + 0.5F;
        const float from_x = c * x + s * y - low_x;
        const float from_y = -s * x + c * y - low_y;
        const int from_column = static_cast<int>(from_x);
        const int from_row = static_cast<int>(from_y);
        if (from_x >= 0 && from_y >= 0 && from_column < source_level.width && from_row < source_level.height) {
          scratch.table[at(column, row)] =
              static_cast<float>(source_table.value[source_level.offset(from_column, from_row)]) / FitTable::kFull;
        }
      }
    }
    transform.forward(scratch.walls.get(), scratch.walls_spectrum.get());
    transform.forward(scratch.table.get(), scratch.table_spectrum.get());
    for (std::size_t i = 0; i < transform.spectrum_size(); ++i) {
      scratch.walls_spectrum[i] = std::conj(scratch.walls_spectrum[i]) * target_table_spectrum[i] +
                                  std::conj(scratch.table_spectrum[i]) * target_walls_spectrum[i];
    }
    float* score = scratch.table.get();
    transform.backward(scratch.walls_spectrum.get(), score);

    // Cell (u, v) of the result: the source moved by (u, v) cells, cyclically; from -2 reach to the target's size.
    std::vector<ScoredPose>& peaks = peaks_of[index];
    const float unit = 1.0F / static_cast<float>(transform.real_size());
    const auto worse = [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; };
    float bar = 0;
    const auto consider = [&](int column, int row) {
      const int left = column == 0 ? width - 1 : column - 1;
      const int right = column == width - 1 ? 0 : column + 1;
      const int below = row == 0 ? height - 1 : row - 1;
      const int above = row == height - 1 ? 0 : row + 1;
      const float v = score[at(column, row)];
      if (v < score[at(left, row)] || v < score[at(right, row)] || v < score[at(column, below)] ||
          v < score[at(column, above)] || v < score[at(left, below)] || v < score[at(right, below)] ||
          v < score[at(left, above)] || v < score[at(right, above)]) {
        return;
      }
      const int shift_x = column < target_level.width ? column : column - width;
      const int shift_y = row < target_level.height ? row : row - height;
      const Pose2 pose{target_level.lower_left.x_m + (shift_x + reach) * resolution,
                       target_level.lower_left.y_m + (shift_y + reach) * resolution, angle};
      if (window && norm(pose.translation() - window->centre.translation()) > window->radius_m + resolution) {
        return;
      }
      peaks.push_back({pose, static_cast<double>(v * unit)});
      std::push_heap(peaks.begin(), peaks.end(), worse);
      if (peaks.size() > static_cast<std::size_t>(options.peaks_per_angle)) {
        std::pop_heap(peaks.begin(), peaks.end(), worse);
        peaks.pop_back();
        bar = static_cast<float>(peaks.front().score) / unit;
      }
    };
    for (int row = 0; row < height; ++row) {
      const float* line = &score[at(0, row)];
      for (int column = 0; column < width; ++column) {
        if (line[column] > bar) {
          consider(column, row);
        }
      }
    }
  });

  SweepResult result{
      .peaks = {}, .resolution_m = resolution, .angles = static_cast<int>(angles.size()), .stopped = stopped};
  for (const std::vector<ScoredPose>& peaks : peaks_of) {
    result.peaks.insert(result.peaks.end(), peaks.begin(), peaks.end());
  }
  std::stable_sort(result.peaks.begin(), result.peaks.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
  return result;
}

}  // namespace gridmerge
