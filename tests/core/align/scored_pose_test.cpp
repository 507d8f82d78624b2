#include "gridmerge/align/scored_pose.hpp"

#include <gmock/gmock.h>

#include "core/align/drawn_place.hpp"

namespace gridmerge {
namespace {

TEST(DistinctPoses, KeepsTheBestOfEveryNeighbourhoodBestFirst) {
  const std::vector<ScoredPose> poses = {
      {{0, 0, 0}, 1}, {{0.1, 0, 0}, 3}, {{5, 0, 0}, 2}, {{0.1, 0, 1}, 0.5}, {{5.05, 0, 0}, 2}};
  const std::vector<ScoredPose> kept = distinct_poses(poses, {0.5, radians(10)}, 10);
  ASSERT_EQ(kept.size(), 3U);
  EXPECT_EQ(kept[0].pose, (Pose2{0.1, 0, 0}));
  EXPECT_EQ(kept[1].pose, (Pose2{5, 0, 0}));  // of two as good, the first
  EXPECT_EQ(kept[2].pose, (Pose2{0.1, 0, 1}));
}

TEST(DistinctPoses, ComparesAnglesAcrossTheTurn) {
  const std::vector<ScoredPose> poses = {{{0, 0, kPi - 0.01}, 2}, {{0, 0, -kPi + 0.01}, 1}};
  EXPECT_EQ(distinct_poses(poses, {1, radians(5)}, 10).size(), 1U);
}

TEST(DistinctPoses, GivesNoMoreThanAskedFor) {
  const std::vector<ScoredPose> poses = {{{0, 0, 0}, 1}, {{2, 0, 0}, 3}, {{5, 0, 0}, 2}};
  EXPECT_EQ(distinct_poses(poses, {1, 1}, 2).size(), 2U);
  EXPECT_TRUE(distinct_poses(poses, {1, 1}, 0).empty());
}

struct Climb : testing::Test {
  const PlacedView there{.place_from_map = {}};
  const PlacedView here{.place_from_map = {1, 0.5, 0.3}};
  const PreparedMap target{drawn(Place::kFlat, there), 0.05};
  const PreparedMap source{drawn(Place::kFlat, here), 0.05};
  const Pose2 truth = to_local(target_from_source(there, here), target, source);
  const WallFit fitness{target, source, 1, {}, 4000};
  const Pose2 start{truth.x_m + 0.2, truth.y_m - 0.15, truth.theta_rad + radians(2)};
};

TEST_F(Climb, ReachesTheTopNearby) {
  const ScoredPose top = climb(fitness, start, {0.1, radians(1)}, {0.01, radians(0.1)}, std::nullopt);
  const PoseDifference off = difference_at({}, top.pose, truth);
  EXPECT_LT(off.distance_m, 0.1);
  EXPECT_LT(degrees(off.angle_rad), 1);
  EXPECT_EQ(top.score, fitness(top.pose));
  EXPECT_GT(top.score, fitness(start));
}

TEST_F(Climb, NeverLeavesTheWindow) {
  const PoseWindow window{.centre = start, .radius_m = 0.1, .angle_rad = radians(0.5)};
  const ScoredPose top = climb(fitness, start, {0.1, radians(1)}, {0.01, radians(0.1)}, window);
  EXPECT_TRUE(inside(top.pose, window));
  EXPECT_GE(top.score, fitness(start));
}

}  // namespace
}  // namespace gridmerge
