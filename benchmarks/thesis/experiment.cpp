#include "thesis/experiment.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "map_server/map_files.hpp"
#include "methods/genetic/paper_genetic.hpp"

namespace gridmerge::thesis {
namespace {

/// Where the cells of a map lie as HectorSLAM places them: the robot starts at the centre of the middle cell and looks
/// along x.
Pose2 start_from_grid(const GridGeometry& geometry) {
  return {-(geometry.width / 2 + 0.5) * geometry.resolution_m, -(geometry.height / 2 + 0.5) * geometry.resolution_m, 0};
}

PreparedMap prepare_in_start_frame(OccupancyGrid grid, int threads) {
  grid.geometry.map_from_grid = start_from_grid(grid.geometry);
  return PreparedMap(grid, grid.geometry.resolution_m, {}, threads);
}

Pose2 start_from_map(const OccupancyGrid& grid) {
  return start_from_grid(grid.geometry) * inverse(grid.geometry.map_from_grid);
}

/// The best fitness after each iteration.
struct FitnessCurve : TraceSink {
  std::vector<double> best;
  void on_iteration(const IterationRecord& record) override { best.push_back(record.best_score); }
  /// From 1: after that many iterations half of the final fitness was reached.
  [[nodiscard]] int half_way() const {
    const auto at = std::find_if(best.begin(), best.end(), [&](double value) { return value >= 0.5 * best.back(); });
    return static_cast<int>(at - best.begin()) + 1;
  }
};

template <typename T>
T median(std::vector<T> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

Setup set_up(const ManifestPair& pair, int threads) {
  const OccupancyGrid target = read_map(pair.target_yaml);
  const OccupancyGrid source = read_map(pair.source_yaml);
  return {.target = prepare_in_start_frame(target, threads),
          .source = prepare_in_start_frame(source, threads),
          .half_side_m = 0.5 * std::max(target.geometry.width, target.geometry.height) * target.geometry.resolution_m,
          .truth = start_from_map(target) * pair.truth->target_from_source * inverse(start_from_map(source))};
}

SearchWindow window_of(const std::string& scenario, int percent, double half_side_m) {
  const double share = percent / 100.0;
  const bool forest = scenario.starts_with("forest");
  return {share * half_side_m, radians(180) * (forest ? std::max(share, 0.3) : share)};
}

WindowResult run_window(const ManifestPair& pair, const Setup& setup, int percent, const ExperimentOptions& options) {
  WindowResult result;
  result.window = window_of(pair.scenario, percent, setup.half_side_m);
  result.truth_inside = norm(setup.truth.translation()) <= result.window.radius_m &&
                        std::abs(setup.truth.theta_rad) <= result.window.angle_rad;

  PaperGeneticOptions method;
  method.start = "same_spot";
  method.window_m = result.window.radius_m;
  method.window_deg = degrees(result.window.angle_rad);
  method.iterations_per_epoch = options.iterations;
  const PaperGeneticMerger merger(method);
  const AlignRequest request{.target = setup.target, .source = setup.source, .prior = {}};
  RunContext context;
  context.num_threads = options.threads;

  std::vector<double> iteration_s;
  std::vector<int> half_way;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    context.seed = static_cast<std::uint64_t>(seed);
    FitnessCurve curve;
    context.trace = &curve;
    const auto start = std::chrono::steady_clock::now();
    const Proposal proposal = merger.propose(request, context);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    iteration_s.push_back(time.count() / options.iterations);
    if (proposal.candidates.empty()) {
      result.fitness.push_back(0);
      continue;
    }
    const Candidate& best = proposal.candidates.front();
    const PoseDifference error = difference_at(setup.source.centre_in_map(), best.target_from_source, setup.truth);
    const double tolerances =
        std::max(error.distance_m / pair.truth->tolerance_m, error.angle_rad / pair.truth->tolerance_rad);
    result.exact += tolerances <= 1 ? 1 : 0;
    if (tolerances <= options.tolerance_factor) {
      ++result.converged;
      half_way.push_back(curve.half_way());
    }
    result.fitness.push_back(best.method_score);
  }
  std::sort(result.fitness.begin(), result.fitness.end());
  if (!half_way.empty()) {
    result.half_way = median(half_way);
  }
  result.iteration_s = median(iteration_s);
  return result;
}

std::optional<PublishedResult> published(const std::string& scenario, int percent) {
  struct Row {
    const char* scenario;
    int percent;
    PublishedResult result;
  };
  static constexpr Row kRows[] = {
      {"maze_center", 10, {7, 7, 9, 1879, 0.92}}, {"maze_center", 30, {1, 7, 7, 551, 0.93}},
      {"maze_center", 100, {0, 7, 0, 766, 0.95}}, {"maze_opposite", 45, {0, 7, 0, 617, 1.26}},
      {"forest_near", 5, {7, 7, 8, 4078, 2.72}},  {"forest_near", 15, {3, 7, 42, 1642, 2.69}},
      {"forest_near", 30, {0, 2, 0, 880, 2.63}},
  };
  for (const Row& row : kRows) {
    if (row.percent == percent && scenario.starts_with(row.scenario)) {
      return row.result;
    }
  }
  return std::nullopt;
}

}  // namespace gridmerge::thesis
