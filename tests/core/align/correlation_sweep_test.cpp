#include "gridmerge/align/correlation_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/align/drawn_place.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

SweepOptions at_most(int peaks_per_angle) {
  SweepOptions options;
  options.peaks_per_angle = peaks_per_angle;
  return options;
}

SweepOptions level_for(int max_cells) {
  SweepOptions options;
  options.lattice.max_cells = max_cells;
  return options;
}

/// A window of every place, but one angle.
PoseWindow one_angle(double angle_rad) { return {.centre = {0, 0, angle_rad}, .radius_m = 1000, .angle_rad = 0}; }

void expect_same(const SweepResult& a, const SweepResult& b) {
  ASSERT_EQ(a.peaks.size(), b.peaks.size());
  for (std::size_t i = 0; i < a.peaks.size(); ++i) {
    EXPECT_EQ(a.peaks[i].pose, b.peaks[i].pose);
    EXPECT_EQ(a.peaks[i].score, b.peaks[i].score);
  }
}

TEST(CorrelationSweep, FindsMapsThatTouchOnlyAtTheirCorners) {
  // The far corner of one map is the near corner of the other: at the very end of what the transform holds.
  const auto corner_map = [](bool upper_right) {
    OccupancyGrid grid = unknown_grid({.width = 120, .height = 120, .resolution_m = 0.05, .map_from_grid = {}});
    grid.at({upper_right ? 0 : 119, upper_right ? 0 : 119}) = kFree;  // the centre is to lie off the corner
    for (int i = 0; i < 30; ++i) {
      const int at = upper_right ? 119 - i : i;
      grid.at({at, upper_right ? 119 : 0}) = kOccupied;
      grid.at({upper_right ? 119 : 0, at}) = kOccupied;
    }
    return PreparedMap(grid, 0.05);
  };
  const PreparedMap target = corner_map(true);
  const PreparedMap source = corner_map(false);
  const SweepResult result = correlation_sweep(target, source, one_angle(kPi), {}, {});
  ASSERT_FALSE(result.peaks.empty());
  // Turned by half a turn, the source's corner lies on the target's.
  const Pose2 truth = to_local({6, 6, kPi}, target, source);
  EXPECT_LT(norm(result.peaks.front().pose.translation() - truth.translation()), 0.3);
}

TEST(CorrelationSweep, FindsTheTruthAmongAllPoses) {
  for (int seed = 1; seed <= 3; ++seed) {
    const worlds::MapPair pair = worlds::make_scene(known_pair("flat", seed));
    const PreparedMap target(pair.target, 0.05);
    const PreparedMap source(pair.source, 0.05);
    const SweepResult result = correlation_sweep(target, source, std::nullopt, {}, {});
    EXPECT_EQ(result.angles, 180);
    ASSERT_FALSE(result.peaks.empty());
    EXPECT_LE(result.peaks.size(), 180U * 12U);
    const Pose2 best = from_local(result.peaks.front().pose, target, source);
    const PoseDifference error = pose_error(pair, best);
    EXPECT_LT(error.distance_m, 0.4) << "seed " << seed;
    EXPECT_LT(degrees(error.angle_rad), 3) << "seed " << seed;
  }
}

TEST(CorrelationSweep, PeaksComeBestFirstAndNeverBelowNothing) {
  const PreparedMap target = posts_and_walls(1, 81, 59);
  const PreparedMap source = posts_and_walls(2, 60, 50);
  const SweepResult result = correlation_sweep(target, source, std::nullopt, at_most(5), {});
  ASSERT_FALSE(result.peaks.empty());
  std::map<double, int> of_angle;
  for (std::size_t i = 0; i < result.peaks.size(); ++i) {
    EXPECT_GT(result.peaks[i].score, 0);
    EXPECT_LE(result.peaks[i].score, result.peaks[i == 0 ? 0 : i - 1].score);
    EXPECT_LE(++of_angle[result.peaks[i].pose.theta_rad], 5);
  }
  // Of each angle the best are kept: the greatest of all are the same, however few are asked for.
  const SweepResult one_each = correlation_sweep(target, source, std::nullopt, at_most(1), {});
  EXPECT_EQ(one_each.peaks.front().score, result.peaks.front().score);
  EXPECT_EQ(one_each.peaks.size(), of_angle.size());
}

TEST(CorrelationSweep, ScoresAreTheSmoothFitnessUpToItsResolution) {
  const PreparedMap target(drawn(Place::kFlat, {.place_from_map = {1, 0, 0.4}, .to_x_m = 9}), 0.05);
  const PreparedMap source(drawn(Place::kFlat, {.place_from_map = {0, 3, -2}, .from_x_m = 2}), 0.05);
  const SweepResult result = correlation_sweep(target, source, std::nullopt, {}, {});
  const WallFit fit(target, source, 2, {}, 1000000);
  const ScoredPose& best = result.peaks.front();
  EXPECT_NEAR(best.score, fit(best.pose), 0.15 * best.score);
}

TEST(CorrelationSweep, KeepsToItsWindow) {
  const worlds::MapPair pair = worlds::make_scene(known_pair("flat"));
  const PreparedMap target(pair.target, 0.05);
  const PreparedMap source(pair.source, 0.05);
  const Pose2 truth = to_local(pair.target_from_source, target, source);
  const PoseWindow round_the_truth{
      .centre = {truth.x_m + 0.5, truth.y_m - 0.3, wrap_angle(truth.theta_rad + 0.1)}, .radius_m = 1, .angle_rad = 0.2};
  const PoseWindow elsewhere{
      .centre = {truth.x_m + 6, truth.y_m, wrap_angle(truth.theta_rad + 2)}, .radius_m = 1.5, .angle_rad = 0.3};
  for (const PoseWindow& window : {round_the_truth, elsewhere}) {
    for (const auto& [t, s] : {std::pair{&target, &source}, {&source, &target}}) {
      PoseWindow w = window;
      w.centre = t == &target ? window.centre : inverse(window.centre);
      const SweepResult result = correlation_sweep(*t, *s, w, {}, {});
      ASSERT_FALSE(result.peaks.empty());
      for (const ScoredPose& peak : result.peaks) {
        const PoseDifference off = difference_at({}, peak.pose, w.centre);
        EXPECT_LE(off.distance_m, w.radius_m + result.resolution_m + 1e-9);
        EXPECT_LE(off.angle_rad, w.angle_rad + 1e-9);
      }
      const double step = result.angles > 1 ? 2 * w.angle_rad / (result.angles - 1) : 0;
      EXPECT_LE(step, radians(2) + 1e-9);
    }
  }
  const SweepResult near = correlation_sweep(target, source, round_the_truth, {}, {});
  const PoseDifference error = difference_at({}, near.peaks.front().pose, truth);
  EXPECT_LT(error.distance_m, 0.4);
  EXPECT_LT(degrees(error.angle_rad), 3);
}

TEST(CorrelationSweep, SeesTheSamePeaksWhicheverMapIsTheTarget) {
  const PreparedMap large = posts_and_walls(5, 100, 90);
  const PreparedMap small = posts_and_walls(6, 50, 40);
  const SweepResult forth = correlation_sweep(large, small, std::nullopt, {}, {});
  const SweepResult back = correlation_sweep(small, large, std::nullopt, {}, {});
  ASSERT_EQ(forth.peaks.size(), back.peaks.size());
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_NEAR(forth.peaks[i].score, back.peaks[i].score, 1e-3);
    const PoseDifference off = difference_at({}, forth.peaks[i].pose, inverse(back.peaks[i].pose));
    EXPECT_LT(off.distance_m, 1e-9);
    EXPECT_LT(off.angle_rad, 1e-9);
  }
}

TEST(CorrelationSweep, IsTheSameAtAnyNumberOfThreads) {
  const PreparedMap target = posts_and_walls(7, 100, 70);
  const PreparedMap source = posts_and_walls(8, 60, 90);
  const SweepResult one = correlation_sweep(target, source, std::nullopt, {}, {.num_threads = 1});
  for (const int threads : {0, 2, 4}) {
    SCOPED_TRACE(threads);
    expect_same(one, correlation_sweep(target, source, std::nullopt, {}, {.num_threads = threads}));
  }
}

TEST(CorrelationSweep, StopsWhenToldTo) {
  const PreparedMap target = posts_and_walls(7, 100, 70);
  const StopToken cancelled;
  cancelled.cancel();
  const SweepResult result = correlation_sweep(target, target, std::nullopt, {}, {.stop = cancelled});
  EXPECT_TRUE(result.stopped);
  EXPECT_TRUE(result.peaks.empty());
  EXPECT_FALSE(correlation_sweep(target, target, std::nullopt, {}, {}).stopped);
}

TEST(CorrelationSweep, WorksOnASingleWallCell) {
  const PreparedMap post(
      {.geometry = {.width = 1, .height = 1, .resolution_m = 0.05, .map_from_grid = {}}, .cells = {kOccupied}}, 0.05);
  const SweepResult result = correlation_sweep(post, post, std::nullopt, {}, {});
  ASSERT_FALSE(result.peaks.empty());
  EXPECT_GT(result.peaks.front().score, 0.4);  // specks of half a cell, each on the other
  EXPECT_LT(norm(result.peaks.front().pose.translation()), 0.5);
}

TEST(CorrelationSweep, TakesACoarserLevelForLargerMaps) {
  const PreparedMap target = posts_and_walls(9, 200, 200);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(420), {}).resolution_m, 0.2);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(70), {}).resolution_m, 0.4);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(1), {}).resolution_m, 0.8);
}

}  // namespace
}  // namespace gridmerge
