#include "methods/genetic/paper_genetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "methods/genetic/paper_operations.hpp"

namespace gridmerge {
namespace {

using paper::Individual;

void expect_same_pose(const Pose2& actual, const Pose2& expected) {
  EXPECT_NEAR(actual.x_m, expected.x_m, 1e-9);
  EXPECT_NEAR(actual.y_m, expected.y_m, 1e-9);
  EXPECT_NEAR(wrap_angle(actual.theta_rad - expected.theta_rad), 0, 1e-9);
}

/// Rooms of unequal sizes with doors, walls one cell thick: 14.4 m x 9.6 m at 0.08 m.
OccupancyGrid maze(const Pose2& map_from_grid) {
  OccupancyGrid grid =
      unknown_grid({.width = 180, .height = 120, .resolution_m = 0.08, .map_from_grid = map_from_grid});
  std::fill(grid.cells.begin(), grid.cells.end(), kFree);
  RandomStream random(7, "maze");
  for (int k = 0; k < 60; ++k) {
    const bool upright = random.below(2) == 0;
    const int length = 10 + static_cast<int>(random.below(30));
    const int column = static_cast<int>(random.below(upright ? 180 : 140));
    const int row = static_cast<int>(random.below(upright ? 80 : 120));
    for (int i = 0; i < length; ++i) {
      grid.at({column + (upright ? 0 : i), row + (upright ? i : 0)}) = kOccupied;
    }
  }
  return grid;
}

/// The left two thirds and the right two thirds of one maze, each in a frame of its own.
struct Halves {
  OccupancyGrid left = maze({0.5, -0.3, 0.2});
  OccupancyGrid right = maze({-1, 0.4, -0.4});
  PreparedMap target = cut(left, 0, 120);
  PreparedMap source = cut(right, 60, 180);
  Pose2 truth = left.geometry.map_from_grid * inverse(right.geometry.map_from_grid);

  [[nodiscard]] AlignRequest request(std::optional<PosePrior> prior = {}, const Population* carried = nullptr) const {
    return {.target = target, .source = source, .prior = prior, .carried = carried};
  }
  [[nodiscard]] bool found_by(const Proposal& proposal) const {
    if (proposal.candidates.empty()) {
      return false;
    }
    const PoseDifference error =
        difference_at(source.centre_in_map(), proposal.candidates.front().target_from_source, truth);
    return error.distance_m < 0.2 && error.angle_rad < radians(2);
  }

 private:
  static PreparedMap cut(OccupancyGrid& grid, int low_column, int high_column) {
    for (int row = 0; row < grid.geometry.height; ++row) {
      for (int column = 0; column < grid.geometry.width; ++column) {
        if (column < low_column || column >= high_column) {
          grid.at({column, row}) = kUnknown;
        }
      }
    }
    return PreparedMap(grid, grid.geometry.resolution_m);
  }
};

PaperGeneticOptions small_options() {
  PaperGeneticOptions options;
  options.population = 60;
  options.window_m = 2;
  options.window_deg = 40;
  options.iterations_per_epoch = 8;
  options.mutation_cells = 5;
  return options;
}

RunContext run(std::uint64_t seed, int num_threads = 1, const StopToken& stop = {}, TraceSink* trace = nullptr) {
  return {.seed = seed, .num_threads = num_threads, .stop = stop, .trace = trace};
}

StopToken iterations(int budget) { return StopToken().with_iterations(budget); }

struct Recorder : TraceSink {
  std::vector<IterationRecord> records;
  void on_iteration(const IterationRecord& record) override { records.push_back(record); }
};

void expect_equal(const Proposal& a, const Proposal& b) {
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].target_from_source, b.candidates[i].target_from_source);
    EXPECT_EQ(a.candidates[i].method_score, b.candidates[i].method_score);
  }
  EXPECT_EQ(a.carry.target_from_source, b.carry.target_from_source);
  EXPECT_EQ(a.iterations, b.iterations);
}

TEST(PaperOperations, InitialPosePutsBothRobotsWhereTheCommonFrameHasThem) {
  const Pose2 target_local{1, 2, 0.3};
  const Pose2 target_global{-4, 5, 1.1};
  const Pose2 source_local{3, -2, -0.7};
  const Pose2 source_global{6, 0, 2.9};
  const Pose2 p = paper::initial_pose(target_local, target_global, source_local, source_global);
  // The source's robot as seen from the target's: once through the common frame, once through the maps.
  expect_same_pose(inverse(target_local) * p * source_local, inverse(target_global) * source_global);
}

TEST(PaperOperations, InitialPoseOfRobotsOnOneSpotOverlaysTheirLocalPoses) {
  const Pose2 global{7, 8, 1};
  const Pose2 p = paper::initial_pose({2, 0, 0}, global, {0, 3, 0.5}, global);
  expect_same_pose(p * Pose2{0, 3, 0.5}, {2, 0, 0});
}

TEST(PaperOperations, CrossoverOneTakesPositionOfTheFirstAndHeadingOfTheSecond) {
  EXPECT_EQ(paper::crossover_1({1, 2, 3}, {4, 5, -1}), (Pose2{1, 2, -1}));
}

TEST(PaperOperations, CrossoverTwoLiesBetweenItsParents) {
  expect_same_pose(paper::crossover_2({1, 2, 0.4}, {3, 6, 0.8}, 0.25), {2.5, 5, 0.7});
  expect_same_pose(paper::crossover_2({1, 2, 0.4}, {3, 6, 0.8}, 1), {1, 2, 0.4});
}

TEST(PaperOperations, CrossoverTwoTurnsAlongTheShorterArc) {
  expect_same_pose(paper::crossover_2({0, 0, radians(170)}, {0, 0, radians(-170)}, 0.5), {0, 0, kPi});
  expect_same_pose(paper::crossover_2({0, 0, radians(-100)}, {0, 0, radians(160)}, 0.75), {0, 0, radians(-125)});
}

TEST(PaperOperations, SuperiorAreThoseWithAtLeastTheMeanFitness) {
  const std::vector<Individual> four{{{}, 100}, {{}, 50}, {{}, 49}, {{}, 1}};  // mean 50
  EXPECT_EQ(paper::superior_count(four), 2U);
  const std::vector<Individual> alike(7, {{}, 33});
  EXPECT_EQ(paper::superior_count(alike), 7U);
  const std::vector<Individual> one_ahead{{{}, 9}, {{}, 0}, {{}, 0}};
  EXPECT_EQ(paper::superior_count(one_ahead), 1U);
}

TEST(PaperOperations, MutationAttemptsRiseSteeplyWithFitness) {
  EXPECT_EQ(paper::mutation_attempts(1000, 0, 1000, 100), 100);
  EXPECT_EQ(paper::mutation_attempts(900, 0, 1000, 100), 34);  // 100 * 0.9^10 = 34.87
  EXPECT_EQ(paper::mutation_attempts(600, 0, 1000, 100), 1);   // 0.6
  EXPECT_EQ(paper::mutation_attempts(0, 0, 1000, 100), 1);
  EXPECT_EQ(paper::mutation_attempts(5, 5, 5, 100), 100);
}

TEST(PaperOperations, RandomPosesFillTheWindowAndStayInIt) {
  const paper::Window window{.start = {3, -1, 3}, .pivot = {2, 5}, .radius_m = 4, .angle_rad = 0.5};
  RandomStream random(1, "window");
  int outer_half = 0;
  for (int i = 0; i < 2000; ++i) {
    const PoseDifference off = difference_at(window.pivot, paper::random_pose(window, random), window.start);
    ASSERT_LE(off.distance_m, 4 + 1e-9);
    ASSERT_LE(off.angle_rad, 0.5 + 1e-9);
    outer_half += off.distance_m > 4 / std::numbers::sqrt2 ? 1 : 0;
  }
  EXPECT_NEAR(outer_half, 1000, 100);  // half of the disc's area
}

TEST(PaperGenetic, SameSeedGivesTheSameAnswerAtAnyNumberOfThreads) {
  const Halves halves;
  const PaperGeneticMerger merger(small_options());
  const Proposal once = merger.propose(halves.request(), run(5, 1));
  const Proposal again = merger.propose(halves.request(), run(5, 1));
  const Proposal threaded = merger.propose(halves.request(), run(5, 4));
  expect_equal(once, again);
  expect_equal(once, threaded);
  const Proposal other = merger.propose(halves.request(), run(6, 1));
  EXPECT_NE(once.carry.target_from_source, other.carry.target_from_source);
}

TEST(PaperGenetic, FindsTheTruthInASmallWindowForMostSeeds) {
  const Halves halves;
  PaperGeneticOptions options = small_options();
  options.population = 150;
  options.iterations_per_epoch = 30;
  const PaperGeneticMerger merger(options);
  const PosePrior near{halves.truth * Pose2{0.7, -0.5, radians(12)}, 1.5, radians(25)};
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    found += halves.found_by(merger.propose(halves.request(near), run(seed))) ? 1 : 0;
  }
  EXPECT_GE(found, 8) << "of 10 seeds";
}

TEST(PaperGenetic, CandidatesComeBestFirstAndAreDistinct) {
  const Halves halves;
  const Proposal proposal = PaperGeneticMerger(small_options()).propose(halves.request(), run(2));
  ASSERT_GT(proposal.candidates.size(), 1U);
  EXPECT_LE(proposal.candidates.size(), 10U);
  EXPECT_EQ(proposal.candidates.front().target_from_source, proposal.carry.target_from_source.front());
  const Point2 centre = halves.source.centre_in_map();
  for (std::size_t i = 1; i < proposal.candidates.size(); ++i) {
    EXPECT_LE(proposal.candidates[i].method_score, proposal.candidates[i - 1].method_score);
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(centre, proposal.candidates[i].target_from_source, proposal.candidates[k].target_from_source);
      EXPECT_TRUE(apart.distance_m > 0.4 || apart.angle_rad > radians(4));
    }
  }
}

TEST(PaperGenetic, BestFitnessNeverFalls) {
  const Halves halves;
  for (const char* policy : {"continue", "restart"}) {
    for (const bool by_fitness : {false, true}) {
      PaperGeneticOptions options = small_options();
      options.epochs = 3;
      options.epoch_policy = policy;
      options.mutate_by_fitness = by_fitness;
      Recorder recorder;
      const Proposal proposal = PaperGeneticMerger(options).propose(halves.request(), run(3, 1, {}, &recorder));
      ASSERT_EQ(recorder.records.size(), 24U);
      for (std::size_t i = 0; i < recorder.records.size(); ++i) {
        const IterationRecord& record = recorder.records[i];
        EXPECT_EQ(record.iteration, static_cast<int>(i));
        EXPECT_EQ(record.iterations, 24);
        EXPECT_EQ(record.population.size(), 60U);
        EXPECT_EQ(record.population.front(), record.best_target_from_source);
        EXPECT_GE(record.best_score, record.mean_score);
        if (i > 0) {
          EXPECT_GE(record.best_score, recorder.records[i - 1].best_score) << policy << ", iteration " << i;
        }
      }
      EXPECT_EQ(recorder.records.back().best_score, proposal.candidates.front().method_score);
    }
  }
}

TEST(PaperGenetic, WatchingChangesNothing) {
  const Halves halves;
  const PaperGeneticMerger merger(small_options());
  Recorder recorder;
  expect_equal(merger.propose(halves.request(), run(4)), merger.propose(halves.request(), run(4, 1, {}, &recorder)));
}

TEST(PaperGenetic, KeepsToItsBudgetOfIterations) {
  const Halves halves;
  const PaperGeneticMerger merger(small_options());
  for (const int budget : {0, 3}) {
    const Proposal proposal = merger.propose(halves.request(), run(1, 1, iterations(budget)));
    EXPECT_EQ(proposal.iterations, budget);
    EXPECT_FALSE(proposal.candidates.empty());
  }
}

TEST(PaperGenetic, StopsWhenToldToAndSaysSo) {
  const Halves halves;
  PaperGeneticOptions options = small_options();
  options.iterations_per_epoch = 1000000;
  const PaperGeneticMerger merger(options);
  const Proposal late = merger.propose(halves.request(), run(1, 1, StopToken::after(std::chrono::milliseconds(60))));
  EXPECT_TRUE(late.stopped);
  EXPECT_FALSE(late.candidates.empty());

  const StopToken cancelled;
  cancelled.cancel();
  const Proposal none = merger.propose(halves.request(), run(1, 1, cancelled));
  EXPECT_TRUE(none.stopped);
  EXPECT_EQ(none.iterations, 0);
}

TEST(PaperGenetic, CarriedPopulationContinuesWhereItWasLeft) {
  const Halves halves;
  const PaperGeneticMerger merger(small_options());
  const Proposal first = merger.propose(halves.request(), run(8));
  const Proposal untouched = merger.propose(halves.request({}, &first.carry), run(9, 1, iterations(0)));
  EXPECT_EQ(untouched.carry.target_from_source, first.carry.target_from_source);
  const Proposal second = merger.propose(halves.request({}, &first.carry), run(9));
  EXPECT_GE(second.candidates.front().method_score, first.candidates.front().method_score);
}

TEST(PaperGenetic, RestartDrawsThePopulationAnewRoundTheLastEstimate) {
  const Halves halves;
  PaperGeneticOptions options = small_options();
  options.epoch_policy = "restart";
  options.window_m = 0.5;
  options.window_deg = 5;
  const Pose2 estimate{3, 4, 1};
  const Population carried{{estimate, {50, 50, 0}}};
  const Proposal proposal = PaperGeneticMerger(options).propose(halves.request({}, &carried), run(1, 1, iterations(0)));
  ASSERT_EQ(proposal.carry.target_from_source.size(), 60U);
  bool kept = false;
  for (const Pose2& pose : proposal.carry.target_from_source) {
    const PoseDifference off = difference_at({}, pose, estimate);
    EXPECT_LE(off.distance_m, 0.5 + 1e-9);
    EXPECT_LE(off.angle_rad, radians(5) + 1e-9);
    kept = kept || pose == estimate;
  }
  EXPECT_TRUE(kept);
}

TEST(PaperGenetic, StartsWhereItsOptionSays) {
  const Halves halves;
  PaperGeneticOptions options = small_options();
  options.window_m = 0.5;
  options.window_deg = 5;
  options.target_local = {1, 2, 30};
  options.source_global = {5, -4, 90};
  const PosePrior prior{{-3, 2, 2}, 0.2, radians(1)};
  const auto population = [&](const char* start, const std::optional<PosePrior>& given) {
    options.start = start;
    return PaperGeneticMerger(options)
        .propose(halves.request(given), run(1, 1, iterations(0)))
        .carry.target_from_source;
  };
  const auto expect_round = [](const std::vector<Pose2>& poses, const Pose2& centre, Point2 pivot, double radius_m,
                               double angle_deg) {
    for (const Pose2& pose : poses) {
      const PoseDifference off = difference_at(pivot, pose, centre);
      ASSERT_LE(off.distance_m, radius_m + 1e-9);
      ASSERT_LE(off.angle_rad, radians(angle_deg) + 1e-9);
    }
  };
  const Pose2 from_global_poses = paper::initial_pose({1, 2, radians(30)}, {}, {}, {5, -4, radians(90)});
  expect_round(population("same_spot", prior), {}, {}, 0.5, 5);
  expect_round(population("prior", std::nullopt), {}, {}, 0.5, 5);
  expect_round(population("global_poses", prior), from_global_poses, {}, 0.5, 5);
  expect_round(population("prior", prior), prior.target_from_source, halves.source.centre_in_map(), 0.2, 1);
  expect_round(population("prior", PosePrior{prior.target_from_source, {}, {}}), prior.target_from_source, {}, 0.5, 5);
}

TEST(PaperGenetic, WindowMayBeAShareOfTheTargetsSide) {
  const Halves halves;
  PaperGeneticOptions options = small_options();
  options.window_m = 0;
  options.window_percent = 50;
  options.population = 1000;
  const Proposal proposal = PaperGeneticMerger(options).propose(halves.request(), run(1, 1, iterations(0)));
  const MapLevel& known = halves.target.level(0);
  const double radius_m = 0.5 * 0.5 * std::max(known.width, known.height) * known.resolution_m;
  double farthest_m = 0;
  for (const Pose2& pose : proposal.carry.target_from_source) {
    farthest_m = std::max(farthest_m, norm(pose.translation()));
  }
  EXPECT_LE(farthest_m, radius_m);
  EXPECT_GT(farthest_m, 0.95 * radius_m);
}

TEST(PaperGenetic, RefusesOptionsOutOfRange) {
  PaperGeneticOptions options;
  options.population = 1;
  options.epoch_policy = "pause";
  EXPECT_THROW(PaperGeneticMerger{options}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
