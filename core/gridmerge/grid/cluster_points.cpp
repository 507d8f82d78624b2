#include "gridmerge/grid/cluster_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gridmerge/base/parallel.hpp"
#include "gridmerge/grid/wall_cells.hpp"

namespace gridmerge {
namespace {

/// Walls per loop item: large enough that handing them out costs nothing.
constexpr std::size_t kBlock = 2048;

float dot(Point2f a, Point2f b) { return a.x_m * b.x_m + a.y_m * b.y_m; }

bool has_direction(Point2f v) { return v.x_m != 0 || v.y_m != 0; }

Point2f unit_or_zero(float x, float y) {
  const float length = std::hypot(x, y);
  return length > 0 ? Point2f{x / length, y / length} : Point2f{};
}

/// What is learnt of the walls: a place and the direction they face.
struct Neuron {
  Point2f at;
  Point2f normal;
  bool sided = false;
};

/// 0: both face one way; 1: across; 2: away from each other. 1/2 where one has no direction.
template <typename A, typename B>
float facing_difference(const A& a, const B& b) {
  if (!has_direction(a.normal) || !has_direction(b.normal)) {
    return 0.5F;
  }
  const float cosine = dot(a.normal, b.normal);
  return a.sided && b.sided ? 1 - cosine : 1 - std::abs(cosine);
}

float distance2(Point2f a, Point2f b) {
  const float dx = a.x_m - b.x_m;
  const float dy = a.y_m - b.y_m;
  return dx * dx + dy * dy;
}

/// Neurons by the square they lie in, so that the near ones are found without looking at all.
class NeuronGrid {
 public:
  /// @param side  of a square, at the least: a few neurons far apart get larger ones
  NeuronGrid(const std::vector<Neuron>& neurons, Point2f low, Point2f high, float side)
      : low_(low), side_(std::max({side, (high.x_m - low.x_m) / kMostSquares, (high.y_m - low.y_m) / kMostSquares})) {
    columns_ = cell_of(high.x_m, low_.x_m) + 1;
    rows_ = cell_of(high.y_m, low_.y_m) + 1;
    first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Neuron& neuron : neurons) {
      ++first_[square_of(neuron.at) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) {
      first_[i] += first_[i - 1];
    }
    members_.resize(neurons.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < neurons.size(); ++i) {
      members_[next[square_of(neurons[i].at)]++] = static_cast<std::uint32_t>(i);
    }
  }

  /// Calls `visit(neuron)` for all in the squares at most `ring` squares from a place's own.
  template <typename Visit>
  void near(Point2f at, int ring, Visit&& visit) const {
    const int column = std::clamp(cell_of(at.x_m, low_.x_m), 0, columns_ - 1);
    const int row = std::clamp(cell_of(at.y_m, low_.y_m), 0, rows_ - 1);
    const int left = std::max(0, column - ring);
    const int right = std::min(columns_ - 1, column + ring);
    for (int r = std::max(0, row - ring); r <= std::min(rows_ - 1, row + ring); ++r) {
      const std::size_t line = static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_);
      const std::uint32_t end = first_[line + static_cast<std::size_t>(right) + 1];
      for (std::uint32_t k = first_[line + static_cast<std::size_t>(left)]; k < end; ++k) {
        visit(members_[k]);
      }
    }
  }
  [[nodiscard]] int widest_ring() const { return std::max(columns_, rows_); }

 private:
  static constexpr float kMostSquares = 2000;  ///< along one side

  [[nodiscard]] int cell_of(float x, float low) const { return static_cast<int>((x - low) / side_); }
  [[nodiscard]] std::size_t square_of(Point2f at) const {
    const int column = std::clamp(cell_of(at.x_m, low_.x_m), 0, columns_ - 1);
    const int row = std::clamp(cell_of(at.y_m, low_.y_m), 0, rows_ - 1);
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  Point2f low_;
  float side_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each square's members; one more at the end
  std::vector<std::uint32_t> members_;
};

/// Where the samples are, and how far apart the neurons shall be.
struct Ground {
  Point2f low;
  Point2f high;
  float spacing = 0;
};

Ground ground_of(std::span<const WallSample> samples) {
  constexpr float kFar = std::numeric_limits<float>::max();
  Ground ground{.low = {kFar, kFar}, .high = {-kFar, -kFar}};
  for (const WallSample& one : samples) {
    ground.low = {std::min(ground.low.x_m, one.at.x_m), std::min(ground.low.y_m, one.at.y_m)};
    ground.high = {std::max(ground.high.x_m, one.at.x_m), std::max(ground.high.y_m, one.at.y_m)};
  }
  return ground;
}

/// The segment of the first segmentation that a sample falls into: a square, and the quarter its wall faces. Ordered
/// row by row.
using Segment = std::uint64_t;

Segment segment_of(const WallSample& sample, const Ground& ground) {
  Segment facing = 4;
  if (has_direction(sample.normal)) {
    // Quarters centred on the axes; a wall without a side has a direction only up to its sign.
    const bool upright = std::abs(sample.normal.y_m) > std::abs(sample.normal.x_m);
    const bool negative = sample.sided && (upright ? sample.normal.y_m < 0 : sample.normal.x_m < 0);
    facing = (upright ? 1U : 0U) + (negative ? 2U : 0U);
  }
  const auto row = static_cast<Segment>((sample.at.y_m - ground.low.y_m) / ground.spacing);
  const auto column = static_cast<Segment>((sample.at.x_m - ground.low.x_m) / ground.spacing);
  return row << 34 | column << 3 | facing;
}

/// Segments the samples: for each, the number of its segment in row-major order.
struct Segmentation {
  std::vector<std::uint32_t> owner;
  std::size_t count = 0;
};

Segmentation segmented(std::span<const WallSample> samples, const Ground& ground) {
  std::vector<Segment> of_sample;
  of_sample.reserve(samples.size());
  for (const WallSample& one : samples) {
    of_sample.push_back(segment_of(one, ground));
  }
  std::vector<Segment> all = of_sample;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  Segmentation segmentation{.owner = {}, .count = all.size()};
  segmentation.owner.reserve(samples.size());
  for (const Segment one : of_sample) {
    segmentation.owner.push_back(
        static_cast<std::uint32_t>(std::lower_bound(all.begin(), all.end(), one) - all.begin()));
  }
  return segmentation;
}

/// Sums over the samples that a neuron has won.
struct Won {
  float weight = 0;
  float x = 0;
  float y = 0;
  float normal_x = 0;
  float normal_y = 0;
  float sided = 0;  ///< of the weight, how much faces one way

  void add(const Won& other, float share) {
    weight += share * other.weight;
    x += share * other.x;
    y += share * other.y;
    // What has no side may be turned round to agree.
    const float sign = other.normal_x * normal_x + other.normal_y * normal_y < 0 && other.sided == 0 ? -share : share;
    normal_x += sign * other.normal_x;
    normal_y += sign * other.normal_y;
    sided += share * other.sided;
  }
};

std::vector<Won> won_by(std::span<const WallSample> samples, std::span<const std::uint32_t> owner, std::size_t count) {
  std::vector<Won> won(count);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const WallSample& one = samples[i];
    won[owner[i]].add({.weight = one.weight,
                       .x = one.weight * one.at.x_m,
                       .y = one.weight * one.at.y_m,
                       .normal_x = one.weight * one.normal.x_m,
                       .normal_y = one.weight * one.normal.y_m,
                       .sided = one.sided ? one.weight : 0},
                      1);
  }
  return won;
}

Neuron neuron_of(const Won& won) {
  return {.at = {won.x / won.weight, won.y / won.weight},
          .normal = unit_or_zero(won.normal_x, won.normal_y),
          .sided = won.sided > 0.5F * won.weight};
}

/// The batch rule of Kohonen (Self-Organizing Maps, 1995): each neuron goes to the mean of what it and its neighbours
/// have won, a neighbour's share falling with its distance. With no radius it is left with its own.
std::vector<Neuron> moved(const std::vector<Neuron>& neurons, const std::vector<Won>& won, const NeuronGrid& grid,
                          float radius, int num_threads) {
  std::vector<Neuron> next = neurons;
  parallel_for((neurons.size() + kBlock - 1) / kBlock, num_threads, [&](std::size_t block, std::size_t) {
    for (std::size_t i = block * kBlock; i < std::min(neurons.size(), (block + 1) * kBlock); ++i) {
      Won sum = won[i];
      if (radius > 0) {
        grid.near(neurons[i].at, 1, [&](std::uint32_t k) {
          const float d2 = distance2(neurons[i].at, neurons[k].at);
          const float alike = 1 - facing_difference(neurons[i], neurons[k]);
          if (k != i && alike > 0 && d2 < 9 * radius * radius) {
            sum.add(won[k], alike * std::exp(-0.5F * d2 / (radius * radius)));
          }
        });
      }
      if (sum.weight > 0) {
        next[i] = neuron_of(sum);
      }
    }
  });
  return next;
}

/// For each sample the best matching unit: the nearest neuron, where facing another way counts as being far.
void find_winners(std::span<const WallSample> samples, const std::vector<Neuron>& neurons, const NeuronGrid& grid,
                  float spacing, int num_threads, std::vector<std::uint32_t>& owner) {
  parallel_for((samples.size() + kBlock - 1) / kBlock, num_threads, [&](std::size_t block, std::size_t) {
    for (std::size_t i = block * kBlock; i < std::min(samples.size(), (block + 1) * kBlock); ++i) {
      float least = std::numeric_limits<float>::max();
      for (int ring = 1; least == std::numeric_limits<float>::max() && ring <= grid.widest_ring(); ring *= 2) {
        grid.near(samples[i].at, ring, [&](std::uint32_t k) {
          const float d2 =
              distance2(samples[i].at, neurons[k].at) + spacing * spacing * facing_difference(samples[i], neurons[k]);
          if (d2 < least) {
            least = d2;
            owner[i] = k;
          }
        });
      }
    }
  });
}

/// The direction across an elongated set of walls.
struct Scatter {
  float xx = 0;
  float xy = 0;
  float yy = 0;

  [[nodiscard]] Point2f across(Point2f otherwise) const {
    const float mean = 0.5F * (xx + yy);
    const float half_gap = std::hypot(0.5F * (xx - yy), xy);
    if (half_gap <= 0.7F * mean) {
      return otherwise;
    }
    const float along = 0.5F * std::atan2(2 * xy, xx - yy);
    const Point2f normal{-std::sin(along), std::cos(along)};
    return dot(normal, otherwise) < 0 ? Point2f{-normal.x_m, -normal.y_m} : normal;
  }
};

}  // namespace

void ClusterOptions::describe(OptionList& list) {
  list.add("spacing_m", spacing_m, 0.02, 100,
           {"m", "How far apart cluster points lie along a wall, where `at_most` allows it.",
            "Smaller keeps more detail; time grows with the number of points, for pairs of them with its square."})
      .add("at_most", at_most, 8, 10000000,
           {"points", "Most cluster points of a map; the spacing widens until they suffice.",
            "It bounds the time on very large maps."})
      .add("epochs", epochs, 1, 1000,
           {"", "Passes of learning over the walls; the neighbourhood shrinks from one to the next.",
            "More even out the points a little, at a cost linear in it."});
}

std::vector<WallSample> wall_samples(const PreparedMap& map) {
  struct Sum {
    float n = 0;
    float x = 0;
    float y = 0;
    Point2f free;
    Point2f surface;
    void add(const WallPoint& wall) {
      n += 1;
      x += wall.at.x_m;
      y += wall.at.y_m;
      free = {free.x_m + wall.free_normal.x_m, free.y_m + wall.free_normal.y_m};
      const float sign = dot(wall.surface_normal, surface) < 0 ? -1.0F : 1.0F;
      surface = {surface.x_m + sign * wall.surface_normal.x_m, surface.y_m + sign * wall.surface_normal.y_m};
    }
  };
  if (map.walls().empty()) {
    return {};
  }
  const MapLevel& level = map.level(1);
  const float across = static_cast<float>(level.resolution_m / map.resolution_m());
  std::vector<WallSample> samples;
  const std::vector<Sum> sums = summed_by_cell<Sum>(map, level);
  samples.reserve(sums.size());
  for (const Sum& sum : sums) {
    const bool sided = std::hypot(sum.free.x_m, sum.free.y_m) > 0.4F * sum.n;
    samples.push_back(
        {.at = {sum.x / sum.n, sum.y / sum.n},
         .normal = sided ? unit_or_zero(sum.free.x_m, sum.free.y_m) : unit_or_zero(sum.surface.x_m, sum.surface.y_m),
         .sided = sided,
         .weight = std::min(1.0F, sum.n / across) * static_cast<float>(level.resolution_m)});
  }
  return samples;
}

ClusterPoints cluster_points(const PreparedMap& map, const ClusterOptions& options, int num_threads,
                             const StopToken& stop) {
  require_valid(options, "cluster_points");
  const std::vector<WallSample> samples = wall_samples(map);
  if (samples.empty()) {
    return {.points = {}, .spacing_m = options.spacing_m};
  }
  Ground ground = ground_of(samples);
  ground.spacing = static_cast<float>(options.spacing_m);
  Segmentation segmentation = segmented(samples, ground);
  while (segmentation.count > static_cast<std::size_t>(options.at_most)) {
    // Along walls, the count falls with the spacing; in a forest, with its square.
    const double too_many = static_cast<double>(segmentation.count) / options.at_most;
    ground.spacing *= static_cast<float>(std::max(1.05, std::pow(too_many, 0.6)));
    segmentation = segmented(samples, ground);
  }
  std::vector<std::uint32_t>& owner = segmentation.owner;
  std::vector<Neuron> neurons;
  for (const Won& won : won_by(samples, owner, segmentation.count)) {
    neurons.push_back(neuron_of(won));
  }
  for (int epoch = 0; epoch < options.epochs && !stop.stop_requested(); ++epoch) {
    // The last epochs without a neighbourhood: it rounds corners off and draws the ends of walls in.
    const int shrinking = std::max(1, options.epochs - 2);
    const float radius =
        ground.spacing * 0.5F * static_cast<float>(std::max(0, shrinking - epoch)) / static_cast<float>(shrinking);
    const NeuronGrid grid(neurons, ground.low, ground.high, ground.spacing);
    find_winners(samples, neurons, grid, ground.spacing, num_threads, owner);
    neurons = moved(neurons, won_by(samples, owner, neurons.size()), grid, radius, num_threads);
  }
  ClusterPoints clusters = summarised(samples, owner, neurons.size());
  clusters.spacing_m = static_cast<double>(ground.spacing);
  return clusters;
}

ClusterPoints summarised(std::span<const WallSample> samples, std::span<const std::uint32_t> owner,
                         std::size_t groups) {
  const std::vector<Won> won = won_by(samples, owner, groups);
  std::vector<Neuron> neurons(groups);
  for (std::size_t k = 0; k < groups; ++k) {
    if (won[k].weight > 0) {
      neurons[k] = neuron_of(won[k]);
    }
  }
  std::vector<Scatter> scatter(groups);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const WallSample& one = samples[i];
    const float x = one.at.x_m - neurons[owner[i]].at.x_m;
    const float y = one.at.y_m - neurons[owner[i]].at.y_m;
    Scatter& s = scatter[owner[i]];
    s.xx += one.weight * x * x;
    s.xy += one.weight * x * y;
    s.yy += one.weight * y * y;
  }
  ClusterPoints clusters;
  for (std::size_t k = 0; k < groups; ++k) {
    if (won[k].weight > 0) {
      neurons[k].normal = scatter[k].across(neurons[k].normal);
      clusters.points.push_back({neurons[k].at, neurons[k].normal, neurons[k].sided, won[k].weight});
    }
  }
  double sum = 0;
  double sum_across2 = 0;
  double weight = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Neuron& neuron = neurons[owner[i]];
    const Point2f off{samples[i].at.x_m - neuron.at.x_m, samples[i].at.y_m - neuron.at.y_m};
    const auto distance = static_cast<double>(std::hypot(off.x_m, off.y_m));
    const auto across = static_cast<double>(dot(off, neuron.normal));
    const auto w = static_cast<double>(samples[i].weight);
    weight += w;
    sum += w * distance;
    sum_across2 += w * across * across;
    clusters.max_error_m = std::max(clusters.max_error_m, distance);
  }
  if (weight > 0) {
    clusters.mean_error_m = sum / weight;
    clusters.rms_across_m = std::sqrt(sum_across2 / weight);
  }
  return clusters;
}

}  // namespace gridmerge
