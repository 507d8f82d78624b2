#include "gridmerge/align/correlation_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/align/drawn_place.hpp"
#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

/// Posts and short walls in a free field of 4 m x 3 m, or so.
PreparedMap tiny(std::uint64_t seed, int width, int height) {
  OccupancyGrid grid = unknown_grid({.width = width, .height = height, .resolution_m = 0.05, .map_from_grid = {}});
  std::fill(grid.cells.begin(), grid.cells.end(), kFree);
  RandomStream random(seed, "tiny");
  for (int k = 0; k < 8; ++k) {
    const int column = static_cast<int>(random.below(static_cast<std::uint32_t>(width - 12)));
    const int row = static_cast<int>(random.below(static_cast<std::uint32_t>(height - 12)));
    const int length = 3 + static_cast<int>(random.below(9));
    const bool upright = random.below(2) == 0;
    for (int i = 0; i < length; ++i) {
      grid.at({column + (upright ? 0 : i), row + (upright ? i : 0)}) = kOccupied;
    }
  }
  return PreparedMap(grid, 0.05);
}

/// The sweep at one angle, by hand: every translation by whole cells of level 2, sums instead of transforms.
class ByHand {
 public:
  ByHand(const PreparedMap& target, const PreparedMap& source, double angle_rad)
      : level_(target.level(2)), reach_(static_cast<int>(std::ceil(source.radius_m() / level_.resolution_m)) + 1) {
    const FitTable target_table(level_, {});
    const MapLevel& from = source.level(2);
    const FitTable source_table(from, {});
    const Pose2 turn{0, 0, angle_rad};
    // The source, turned about its local origin, on cells whose corner is that origin.
    std::map<std::pair<int, int>, double> walls;
    for (const ThinnedWall& wall : thinned_walls(source, from)) {
      const Point2 at = 1 / level_.resolution_m * (turn * Point2{wall.at.x_m, wall.at.y_m});
      walls[{static_cast<int>(std::floor(at.x_m)), static_cast<int>(std::floor(at.y_m))}] += wall.weight;
    }
    const auto table = [&](int column, int row) {
      const Point2 centre{(column + 0.5) * from.resolution_m, (row + 0.5) * from.resolution_m};
      const Point2 at = 1 / from.resolution_m * (inverse(turn) * centre - from.lower_left);
      const int c = static_cast<int>(std::floor(at.x_m));
      const int r = static_cast<int>(std::floor(at.y_m));
      return from.contains(c, r) ? source_table.value[from.offset(c, r)] / 30.0 : 0;
    };
    const std::vector<ThinnedWall> target_walls = thinned_walls(target, level_);
    for (int v = -reach_ - 1; v <= level_.height + reach_; ++v) {
      for (int u = -reach_ - 1; u <= level_.width + reach_; ++u) {
        double sum = 0;
        for (const auto& [cell, weight] : walls) {
          const int c = cell.first + u;
          const int r = cell.second + v;
          sum += level_.contains(c, r) ? weight * target_table.value[level_.offset(c, r)] / 30.0 : 0;
        }
        for (const ThinnedWall& wall : target_walls) {
          const int c = static_cast<int>((wall.at.x_m - level_.lower_left.x_m) / level_.resolution_m);
          const int r = static_cast<int>((wall.at.y_m - level_.lower_left.y_m) / level_.resolution_m);
          sum += wall.weight * table(c - u, r - v);
        }
        score_[{u, v}] = sum;
      }
    }
  }

  /// The shift of the source's local origin, in cells from the target's lower left corner.
  [[nodiscard]] std::pair<int, int> shift_of(const Pose2& pose) const {
    const Point2 shift = 1 / level_.resolution_m * (pose.translation() - level_.lower_left);
    EXPECT_NEAR(shift.x_m, std::round(shift.x_m), 1e-6);
    EXPECT_NEAR(shift.y_m, std::round(shift.y_m), 1e-6);
    return {static_cast<int>(std::lround(shift.x_m)), static_cast<int>(std::lround(shift.y_m))};
  }
  [[nodiscard]] double score(std::pair<int, int> shift) const {
    const auto found = score_.find(shift);
    return found == score_.end() ? 0 : found->second;
  }
  /// Shifts whose score is above `least` and by a margin above that of all eight neighbours.
  [[nodiscard]] std::vector<std::pair<int, int>> clear_peaks(double least) const {
    std::vector<std::pair<int, int>> peaks;
    for (const auto& [shift, value] : score_) {
      bool peak = value > least;
      for (int dv = -1; dv <= 1 && peak; ++dv) {
        for (int du = -1; du <= 1 && peak; ++du) {
          peak = (du == 0 && dv == 0) || value > score({shift.first + du, shift.second + dv}) + 1e-3;
        }
      }
      if (peak) {
        peaks.push_back(shift);
      }
    }
    return peaks;
  }

 private:
  const MapLevel& level_;
  int reach_;
  std::map<std::pair<int, int>, double> score_;
};

SweepOptions at_most(int peaks_per_angle) {
  SweepOptions options;
  options.peaks_per_angle = peaks_per_angle;
  return options;
}

SweepOptions level_for(int max_cells) {
  SweepOptions options;
  options.max_cells = max_cells;
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

TEST(CorrelationSweep, EqualsSumsByHandAtOneAngle) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    // The source smaller than the target, and larger.
    for (const auto& [width, height] : {std::pair{50, 40}, {110, 80}}) {
      const PreparedMap target = tiny(seed, 81, 59);
      const PreparedMap source = tiny(seed + 100, width, height);
      const double angle = 0.3 + static_cast<double>(seed);
      const SweepResult result = correlation_sweep(target, source, one_angle(angle), at_most(1000000), {});
      const ByHand by_hand(target, source, wrap_angle(angle));
      EXPECT_EQ(result.angles, 1);
      EXPECT_EQ(result.resolution_m, 0.2);
      ASSERT_FALSE(result.peaks.empty());
      std::vector<std::pair<int, int>> found;
      for (const ScoredPose& peak : result.peaks) {
        EXPECT_NEAR(peak.pose.theta_rad, wrap_angle(angle), 1e-12);
        found.push_back(by_hand.shift_of(peak.pose));
        EXPECT_NEAR(peak.score, by_hand.score(found.back()), 1e-3);
      }
      const std::vector<std::pair<int, int>> expected = by_hand.clear_peaks(0.01);
      ASSERT_FALSE(expected.empty());
      for (const std::pair<int, int>& shift : expected) {
        EXPECT_EQ(std::count(found.begin(), found.end(), shift), 1)
            << "a peak of " << by_hand.score(shift) << " at " << shift.first << ", " << shift.second << " is missing";
      }
    }
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
  const PreparedMap target = tiny(1, 81, 59);
  const PreparedMap source = tiny(2, 60, 50);
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
  const PreparedMap large = tiny(5, 100, 90);
  const PreparedMap small = tiny(6, 50, 40);
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
  const PreparedMap target = tiny(7, 100, 70);
  const PreparedMap source = tiny(8, 60, 90);
  const SweepResult one = correlation_sweep(target, source, std::nullopt, {}, {.num_threads = 1});
  for (const int threads : {0, 2, 4}) {
    SCOPED_TRACE(threads);
    expect_same(one, correlation_sweep(target, source, std::nullopt, {}, {.num_threads = threads}));
  }
}

TEST(CorrelationSweep, StopsWhenToldTo) {
  const PreparedMap target = tiny(7, 100, 70);
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
  const PreparedMap target = tiny(9, 200, 200);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(420), {}).resolution_m, 0.2);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(60), {}).resolution_m, 0.4);
  EXPECT_EQ(correlation_sweep(target, target, one_angle(0), level_for(1), {}).resolution_m, 0.4);
}

}  // namespace
}  // namespace gridmerge
