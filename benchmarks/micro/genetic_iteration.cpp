/// One iteration of the genetic method's paper profile, against the number of occupied cells of the source.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "methods/genetic/hit_fitness.hpp"
#include "methods/genetic/paper_genetic.hpp"
#include "micro/maze.hpp"
#include "micro/yardstick.hpp"

namespace gridmerge::micro {
namespace {

/// What a benchmark's arguments ask for: occupied cells of the source; width and height of the target's maze [m].
struct Setting {
  explicit Setting(const benchmark::State& state)
      : maze(draw_maze(static_cast<double>(state.range(1)), static_cast<double>(state.range(2)))),
        part(seen_from_middle(maze, static_cast<int>(state.range(0)))),
        target(maze, maze.geometry.resolution_m),
        source(part, part.geometry.resolution_m),
        fitness(target, source),
        truth(maze_from_part(maze, part)) {}

  [[nodiscard]] bool right() const {
    const auto cells = static_cast<std::int64_t>(source.walls().size());
    return fitness(truth) == cells * kOccupied && fitness(truth * Pose2{1, 0, 0.3}) < cells * kOccupied;
  }
  [[nodiscard]] std::size_t cells() const { return fitness.cell_count(); }

  OccupancyGrid maze;
  OccupancyGrid part;
  PreparedMap target;
  PreparedMap source;
  HitFitness fitness;
  Pose2 truth;
};

/// Processor time, so that a machine shared with others measures the same. All that is measured runs on one thread.
double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// When each iteration ended.
struct Stopwatch : TraceSink {
  std::vector<double> ends_s;
  void on_iteration(const IterationRecord& /*record*/) override { ends_s.push_back(cpu_s()); }
  /// Of all iterations but the first.
  [[nodiscard]] double mean_s() const {
    return (ends_s.back() - ends_s.front()) / static_cast<double>(ends_s.size() - 1);
  }
};

void report(benchmark::State& state, const Setting& setting, double ns_per_cell_and_pose) {
  const std::size_t table_bytes = setting.target.level(0).state.size();
  const double random_ns = random_byte_ns(table_bytes, setting.cells());
  const double stream_ns = stream_cell_ns(setting.cells());
  state.counters["ns_cell_pose"] = ns_per_cell_and_pose;
  state.counters["random_byte_ns"] = random_ns;
  state.counters["stream_ns"] = stream_ns;
  state.counters["times_limit"] = ns_per_cell_and_pose / (random_ns + stream_ns);
  state.counters["table_KiB"] = static_cast<double>(table_bytes) / 1024;
}

/// Population 300, best mutated 100 times: 399 poses. The window is the thesis's 10 %.
void genetic_iteration(benchmark::State& state) {
  const Setting setting(state);
  if (!setting.right()) {
    state.SkipWithError("wrong fitness at a known pose");
    return;
  }
  PaperGeneticOptions options;
  options.window_m = 4.1;
  options.window_deg = 18;
  const PaperGeneticMerger merger(options);
  const int poses = options.population - 1 + options.best_mutations;
  const AlignRequest request{
      .target = setting.target, .source = setting.source, .prior = PosePrior{setting.truth, {}, {}}};
  std::vector<double> times_s;
  RunContext context;
  for ([[maybe_unused]] auto _ : state) {
    Stopwatch stopwatch;
    context.trace = &stopwatch;
    const Proposal proposal = merger.propose(request, context);
    const Candidate& best = proposal.candidates.front();
    if (std::abs(best.method_score * kOccupied - static_cast<double>(setting.fitness(best.target_from_source))) > 0.5) {
      state.SkipWithError("the score is not the fitness of its pose");
      return;
    }
    times_s.push_back(stopwatch.mean_s());
    state.SetIterationTime(times_s.back());
    ++context.seed;
  }
  report(state, setting, 1e9 * median(times_s) / (static_cast<double>(setting.cells()) * poses));
}

/// The fitness alone, at poses all over the map.
void hit_fitness(benchmark::State& state) {
  const Setting setting(state);
  if (!setting.right()) {
    state.SkipWithError("wrong fitness at a known pose");
    return;
  }
  RandomStream random(1, "poses");
  std::vector<Pose2> poses(399);
  for (Pose2& pose : poses) {
    const Pose2 local{random.uniform(-8, 8), random.uniform(-4, 4), random.uniform(-kPi, kPi)};
    pose = from_local(local, setting.target, setting.source);
  }
  std::vector<double> times_s;
  for ([[maybe_unused]] auto _ : state) {
    const double start_s = cpu_s();
    for (const Pose2& pose : poses) {
      benchmark::DoNotOptimize(setting.fitness(pose));
    }
    times_s.push_back(cpu_s() - start_s);
    state.SetIterationTime(times_s.back());
  }
  report(state, setting, 1e9 * median(times_s) / static_cast<double>(setting.cells() * poses.size()));
}

/// 34 m x 17 m is the thesis's maze; 81 m x 81 m fills its 2048 x 2048 cells.
void sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"cells", "width_m", "height_m"})->Iterations(25)->UseManualTime()->Unit(benchmark::kMillisecond);
  for (const int cells : {500, 1000, 2163, 4000, 8000, 16000}) {
    benchmark->Args({cells, 34, 17});
  }
  for (const int cells : {2163, 16000}) {
    benchmark->Args({cells, 81, 81});
  }
}

BENCHMARK(genetic_iteration)->Apply(sizes);
BENCHMARK(hit_fitness)->Apply(sizes);

}  // namespace
}  // namespace gridmerge::micro
