#include "gridmerge/grid/cluster_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr double kResolution_m = 0.05;

/// A free room of so many cells, with a wall round it one cell thick, in unknown ground.
OccupancyGrid room(int width, int height) {
  OccupancyGrid grid = unknown_grid(
      {.width = width + 2, .height = height + 2, .resolution_m = kResolution_m, .map_from_grid = {4, -7, 0.3}});
  for (int row = 0; row < height + 2; ++row) {
    for (int column = 0; column < width + 2; ++column) {
      const bool rim = row == 0 || column == 0 || row == height + 1 || column == width + 1;
      grid.cells[grid.geometry.offset({column, row})] = rim ? 100 : 0;
    }
  }
  return grid;
}

PreparedMap prepared(const OccupancyGrid& grid) { return PreparedMap(grid, grid.geometry.resolution_m); }

const PreparedMap& flat() {
  static const PreparedMap map = prepared(worlds::make_scene(known_pair("flat")).target);
  return map;
}

double total_weight(const ClusterPoints& clusters) {
  return std::accumulate(clusters.points.begin(), clusters.points.end(), 0.0,
                         [](double sum, const ClusterPoint& one) { return sum + static_cast<double>(one.weight); });
}

/// From a wall to the nearest cluster point.
double distance_to_nearest(const ClusterPoints& clusters, Point2f at) {
  double least = std::numeric_limits<double>::max();
  for (const ClusterPoint& one : clusters.points) {
    least = std::min(least, static_cast<double>(std::hypot(one.at.x_m - at.x_m, one.at.y_m - at.y_m)));
  }
  return least;
}

void expect_same(const ClusterPoints& a, const ClusterPoints& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    EXPECT_EQ(a.points[i].at.x_m, b.points[i].at.x_m);
    EXPECT_EQ(a.points[i].at.y_m, b.points[i].at.y_m);
    EXPECT_EQ(a.points[i].normal.x_m, b.points[i].normal.x_m);
    EXPECT_EQ(a.points[i].normal.y_m, b.points[i].normal.y_m);
    EXPECT_EQ(a.points[i].sided, b.points[i].sided);
    EXPECT_EQ(a.points[i].weight, b.points[i].weight);
  }
  EXPECT_EQ(a.mean_error_m, b.mean_error_m);
  EXPECT_EQ(a.max_error_m, b.max_error_m);
}

TEST(ClusterPoints, FaceTheFreeSpaceOfARoom) {
  const PreparedMap map = prepared(room(120, 80));
  const ClusterPoints clusters = cluster_points(map, {});
  ASSERT_GT(clusters.points.size(), 30U);
  for (const ClusterPoint& one : clusters.points) {
    EXPECT_TRUE(one.sided);
    EXPECT_NEAR(std::hypot(one.normal.x_m, one.normal.y_m), 1, 1e-5);
    // The room lies round the local origin, so all walls face inwards.
    EXPECT_LT(one.normal.x_m * one.at.x_m + one.normal.y_m * one.at.y_m, 0) << one.at.x_m << " " << one.at.y_m;
  }
}

TEST(ClusterPoints, StandForAllMetresOfWall) {
  const ClusterPoints clusters = cluster_points(prepared(room(120, 80)), {});
  EXPECT_NEAR(total_weight(clusters), 2 * (120 + 80) * kResolution_m, 1);
}

TEST(ClusterPoints, LieOnTheWallsAndAsFarApartAsAsked) {
  const PreparedMap map = prepared(room(200, 150));
  for (const double spacing_m : {0.2, 0.4, 0.8}) {
    const ClusterPoints clusters = cluster_points(map, {.spacing_m = spacing_m});
    EXPECT_EQ(clusters.spacing_m, static_cast<double>(static_cast<float>(spacing_m)));
    const double around_m = 2 * (200 + 150) * kResolution_m;
    EXPECT_NEAR(static_cast<double>(clusters.points.size()), around_m / spacing_m, 0.2 * around_m / spacing_m);
    EXPECT_LT(clusters.rms_across_m, 0.04);
    EXPECT_LT(clusters.mean_error_m, 0.35 * spacing_m);
    EXPECT_GT(clusters.mean_error_m, 0.15 * spacing_m);
    EXPECT_LT(clusters.max_error_m, 1.5 * spacing_m);
  }
}

TEST(ClusterPoints, TellTheTwoFacesOfAWallApart) {
  // Two rooms with a wall of three cells between them.
  OccupancyGrid grid = room(103, 60);
  for (int row = 1; row < 61; ++row) {
    for (int column = 51; column <= 53; ++column) {
      grid.cells[grid.geometry.offset({column, row})] = 100;
    }
  }
  const ClusterPoints clusters = cluster_points(prepared(grid), {});
  double west_m = 0;
  double east_m = 0;
  for (const ClusterPoint& one : clusters.points) {
    if (std::abs(one.at.x_m) < 0.2F && std::abs(one.at.y_m) < 1.2F && one.sided) {
      (one.normal.x_m < 0 ? west_m : east_m) += static_cast<double>(one.weight);
      EXPECT_GT(std::abs(one.normal.x_m), 0.9F);
    }
  }
  EXPECT_GT(west_m, 1.5);
  EXPECT_NEAR(west_m, east_m, 1);
}

TEST(ClusterPoints, AreNeverMoreThanAsked) {
  for (const int at_most : {8, 50, 200, 100000}) {
    const ClusterPoints clusters = cluster_points(flat(), {.spacing_m = 0.1, .at_most = at_most});
    EXPECT_LE(clusters.points.size(), static_cast<std::size_t>(at_most));
    EXPECT_THAT(clusters.points, testing::Not(IsEmpty()));
  }
}

TEST(ClusterPoints, AreMoreExactTheMoreThereAre) {
  double last_m = std::numeric_limits<double>::max();
  for (const int at_most : {30, 100, 300, 1000}) {
    const ClusterPoints clusters = cluster_points(flat(), {.spacing_m = 0.05, .at_most = at_most});
    EXPECT_LT(clusters.mean_error_m, last_m) << at_most;
    last_m = clusters.mean_error_m;
  }
}

TEST(ClusterPoints, LeaveNoWallFartherOffThanTheySay) {
  const ClusterPoints clusters = cluster_points(flat(), {});
  // A sample is a cell of level 1: its walls lie within a cell of it.
  const double slack_m = flat().level(1).resolution_m;
  for (const WallPoint& wall : flat().walls()) {
    EXPECT_LE(distance_to_nearest(clusters, wall.at), clusters.max_error_m + slack_m);
  }
}

TEST(ClusterPoints, LearningBringsThemNearerThanCuttingInSquares) {
  const ClusterPoints cut = cluster_points(flat(), {.spacing_m = 0.8, .epochs = 1});
  const ClusterPoints learnt = cluster_points(flat(), {.spacing_m = 0.8, .epochs = 8});
  EXPECT_LT(learnt.mean_error_m, cut.mean_error_m);
}

TEST(ClusterPoints, AreTheSameAtAnyNumberOfThreads) {
  const ClusterPoints one = cluster_points(flat(), {}, 1);
  expect_same(one, cluster_points(flat(), {}, 4));
  expect_same(one, cluster_points(flat(), {}, 0));
}

TEST(ClusterPoints, StoppedEarlyStillStandForEveryWall) {
  const StopToken cancelled;
  cancelled.cancel();
  const ClusterPoints stopped = cluster_points(flat(), {}, 1, cancelled);
  EXPECT_NEAR(total_weight(stopped), total_weight(cluster_points(flat(), {})), 0.01);
}

TEST(ClusterPoints, OfASpeckAreOne) {
  EXPECT_THAT(cluster_points(prepared(text_map({"#"}, 0.05)), {}).points, SizeIs(1));
}

TEST(ClusterPoints, OfAMapWithoutWallsAreNone) {
  EXPECT_THAT(cluster_points(prepared(text_map({"...", "..."}, 0.05)), {}).points, IsEmpty());
  EXPECT_THAT(cluster_points(prepared(text_map({"???", "???"}, 0.05)), {}).points, IsEmpty());
}

TEST(ClusterPoints, OfSpecksFarApartAreOneEach) {
  OccupancyGrid grid = unknown_grid({.width = 3000, .height = 2, .resolution_m = 0.05, .map_from_grid = {}});
  grid.cells[0] = 100;
  grid.cells[2999] = 100;
  EXPECT_THAT(cluster_points(prepared(grid), {.spacing_m = 0.02}).points, SizeIs(2));
}

TEST(ClusterPoints, RefuseOptionsOutOfRange) {
  EXPECT_THROW((void)cluster_points(flat(), {.spacing_m = 0}), std::invalid_argument);
  EXPECT_THROW((void)cluster_points(flat(), {.at_most = 0}), std::invalid_argument);
  EXPECT_THROW((void)cluster_points(flat(), {.epochs = 0}), std::invalid_argument);
}

TEST(WallSamples, CountAWallOnceHoweverThick) {
  const OccupancyGrid thin = room(100, 100);
  OccupancyGrid thick = thin;
  for (int column = 1; column < 101; ++column) {
    thick.cells[thick.geometry.offset({column, 1})] = 100;
  }
  const auto metres = [](const OccupancyGrid& grid) {
    double sum = 0;
    for (const WallSample& one : wall_samples(prepared(grid))) {
      sum += static_cast<double>(one.weight);
    }
    return sum;
  };
  EXPECT_NEAR(metres(thick), metres(thin), 0.2);
}

TEST(Summarised, LeavesGroupsWithoutWallsOut) {
  const std::vector<WallSample> samples{{.at = {0, 0}, .normal = {0, 1}, .sided = true, .weight = 1},
                                        {.at = {1, 0}, .normal = {0, 1}, .sided = true, .weight = 3},
                                        {.at = {5, 5}, .normal = {}, .sided = false, .weight = 2}};
  const std::vector<std::uint32_t> owner{1, 1, 3};
  const ClusterPoints clusters = summarised(samples, owner, 5);
  ASSERT_THAT(clusters.points, SizeIs(2));
  EXPECT_FLOAT_EQ(clusters.points[0].at.x_m, 0.75F);
  EXPECT_FLOAT_EQ(clusters.points[0].at.y_m, 0);
  EXPECT_NEAR(clusters.points[0].normal.y_m, 1, 1e-6);
  EXPECT_TRUE(clusters.points[0].sided);
  EXPECT_FLOAT_EQ(clusters.points[0].weight, 4);
  EXPECT_FALSE(clusters.points[1].sided);
  // By weight: (0.75 * 1 + 0.25 * 3 + 0) / 6.
  EXPECT_NEAR(clusters.mean_error_m, 0.25, 1e-6);
  EXPECT_NEAR(clusters.max_error_m, 0.75, 1e-6);
  EXPECT_NEAR(clusters.rms_across_m, 0, 1e-6);
}

}  // namespace
}  // namespace gridmerge
