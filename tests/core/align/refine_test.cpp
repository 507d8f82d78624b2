#include "gridmerge/align/refine.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/align/drawn_place.hpp"
#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

/// Two views of one drawn place, prepared, with the truth between them.
struct DrawnPair {
  PreparedMap target;
  PreparedMap source;
  Pose2 truth;

  DrawnPair(Place place, const PlacedView& target_view, const PlacedView& source_view)
      : target(drawn(place, target_view), 0.05),
        source(drawn(place, source_view), 0.05),
        truth(target_from_source(target_view, source_view)) {}

  /// The truth, moved at the source's centre and turned about it.
  [[nodiscard]] Pose2 off_by(Point2 shift, double turn_rad) const {
    const Point2 at = truth * source.centre_in_map();
    return Pose2{at.x_m + shift.x_m, at.y_m + shift.y_m, 0} * Pose2{0, 0, turn_rad} * Pose2{-at.x_m, -at.y_m, 0} *
           truth;
  }
  [[nodiscard]] PoseDifference error(const Pose2& pose) const {
    return difference_at(source.centre_in_map(), pose, truth);
  }
};

DrawnPair flat_pair() {
  return {Place::kFlat,
          {.place_from_map = {0.3, -0.4, 0.2}, .to_x_m = 9},
          {.place_from_map = {2, 5, -1.1}, .origin_yaw_rad = 0.5, .from_x_m = 3}};
}

void expect_symmetric_and_positive(const PoseCovariance& covariance) {
  EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-9 * (1 + covariance.norm()));
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<PoseCovariance>(covariance).eigenvalues().minCoeff(), 0);
}

TEST(Refine, RecoversAKnownOffsetToAFractionOfACell) {
  const DrawnPair pair = flat_pair();
  for (int i = 0; i < 16; ++i) {
    const double way = i * kPi / 8;
    const Pose2 start = pair.off_by({0.1 * std::cos(way), 0.1 * std::sin(way)}, radians(i % 2 == 0 ? 1 : -1));
    const PoseEstimate refined = refine(pair.target, pair.source, start, {});
    EXPECT_LT(pair.error(refined.pose).distance_m, 0.015) << "way " << i;
    EXPECT_LT(degrees(pair.error(refined.pose).angle_rad), 0.1) << "way " << i;
    ASSERT_TRUE(refined.covariance);
    expect_symmetric_and_positive(*refined.covariance);
    EXPECT_LT(std::sqrt((*refined.covariance)(2, 2)), radians(0.5));
  }
}

TEST(Refine, RecoversAnOffsetOfAFewCells) {
  const DrawnPair pair = flat_pair();
  const PoseEstimate refined = refine(pair.target, pair.source, pair.off_by({-0.2, 0.15}, radians(-2.5)), {});
  EXPECT_LT(pair.error(refined.pose).distance_m, 0.025);
  EXPECT_LT(degrees(pair.error(refined.pose).angle_rad), 0.2);
}

TEST(Refine, FindsTheInverseWhenTheMapsAreSwapped) {
  const DrawnPair pair = flat_pair();
  const Pose2 start = pair.off_by({0.07, -0.06}, radians(1));
  const PoseEstimate forth = refine(pair.target, pair.source, start, {});
  const PoseEstimate back = refine(pair.source, pair.target, inverse(start), {});
  const PoseDifference apart = difference_at(pair.source.centre_in_map(), forth.pose, inverse(back.pose));
  EXPECT_LT(apart.distance_m, 0.005);
  EXPECT_LT(degrees(apart.angle_rad), 0.05);
  const PoseCovariance turned = *inverse(back).covariance;
  EXPECT_LT((turned - *forth.covariance).norm(), 0.2 * forth.covariance->norm());
}

TEST(Refine, KnowsThatABareCorridorDoesNotFixThePoseAlongIt) {
  const Pose2 place_from_target{0, 1, -0.5};
  const DrawnPair pair{Place::kCorridor,
                       {.place_from_map = place_from_target, .from_x_m = 0, .to_x_m = 14},
                       {.place_from_map = {3, 0, 0.8}, .from_x_m = 6, .to_x_m = 20}};
  const PoseEstimate refined = refine(pair.target, pair.source, pair.off_by({0.03, 0.04}, radians(0.5)), {});
  ASSERT_TRUE(refined.covariance);
  expect_symmetric_and_positive(*refined.covariance);
  // At the source's centre: at the target's origin, the heading's error would be mixed in.
  const Point2 at = refined.pose * pair.source.centre_in_map();
  const PoseEstimate at_centre =
      compose({{-at.x_m, -at.y_m, 0}, PoseCovariance::Zero()},
              compose(refined,
                      {{pair.source.centre_in_map().x_m, pair.source.centre_in_map().y_m, 0}, PoseCovariance::Zero()}));
  const double along_rad = inverse(place_from_target).theta_rad;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(at_centre.covariance->topLeftCorner<2, 2>());
  const Eigen::Vector2d weak = axes.eigenvectors().col(1);
  EXPECT_GT(std::sqrt(axes.eigenvalues()(1)), 0.5);
  EXPECT_LT(degrees(std::abs(std::remainder(std::atan2(weak(1), weak(0)) - along_rad, kPi))), 5);
  EXPECT_LT(std::sqrt(axes.eigenvalues()(0)), 0.03);
  EXPECT_LT(std::sqrt((*at_centre.covariance)(2, 2)), radians(1));
  // Across and in heading the answer is right all the same.
  const Point2 off = at - pair.truth * pair.source.centre_in_map();
  EXPECT_LT(std::abs(-std::sin(along_rad) * off.x_m + std::cos(along_rad) * off.y_m), 0.02);
  EXPECT_LT(degrees(pair.error(refined.pose).angle_rad), 0.2);
}

TEST(Refine, KnowsThatOneStraightWallFixesTheHeadingButNotThePlaceAlongIt) {
  std::vector<OccupancyGrid> walls;
  for (const double yaw : {0.0, 1.0}) {
    OccupancyGrid grid = unknown_grid({.width = 200, .height = 3, .resolution_m = 0.05, .map_from_grid = {0, 0, yaw}});
    for (int column = 0; column < 200; ++column) {
      grid.at({column, 1}) = kOccupied;
    }
    walls.push_back(grid);
  }
  const PreparedMap target(walls[0], 0.05);
  const PreparedMap source(walls[1], 0.05);
  const PoseEstimate refined = refine(target, source, Pose2{4, 0.05, -1}, {});
  ASSERT_TRUE(refined.covariance);
  EXPECT_NEAR((refined.pose * source.centre_in_map()).y_m, target.centre_in_map().y_m, 0.02);
  EXPECT_NEAR(degrees(refined.pose.theta_rad + 1), 0, 0.3);
  EXPECT_GT(std::sqrt((*refined.covariance)(0, 0)), 0.5);
}

TEST(Refine, GivesTheStartBackWhereNothingMatches) {
  const DrawnPair pair = flat_pair();
  for (const Pose2& apart : {Pose2{100, 0, 1}, Pose2{-1e6, 1e6, -2}}) {
    const PoseEstimate refined = refine(pair.target, pair.source, apart, {});
    EXPECT_EQ(refined.pose, apart);
    EXPECT_FALSE(refined.covariance);
  }
}

TEST(Refine, GivesTheStartBackForTooFewWalls) {
  const PreparedMap post(text_map({"#"}, 0.05), 0.05);
  const PreparedMap bare(text_map({"."}, 0.05), 0.05);
  const Pose2 start{0.1, 0.2, 0.3};
  for (const auto& [target, source] : {std::pair{&post, &post}, {&post, &bare}, {&bare, &bare}}) {
    const PoseEstimate refined = refine(*target, *source, start, {});
    EXPECT_EQ(refined.pose, start);
    EXPECT_FALSE(refined.covariance);
  }
}

TEST(Refine, StaysTheSameWhereverTheMapFramesLie) {
  const PlacedView target_view{.place_from_map = {0.3, -0.4, 0.2}, .to_x_m = 9};
  const PlacedView source_view{.place_from_map = {2, 5, -1.1}, .from_x_m = 3};
  const DrawnPair near{Place::kFlat, target_view, source_view};
  OccupancyGrid far_target = drawn(Place::kFlat, target_view);
  OccupancyGrid far_source = drawn(Place::kFlat, source_view);
  const Pose2 move_target{1e5, -2e5, 0};
  const Pose2 move_source{-3e5, 1e5, 0};
  far_target.geometry.map_from_grid = move_target * far_target.geometry.map_from_grid;
  far_source.geometry.map_from_grid = move_source * far_source.geometry.map_from_grid;
  const Pose2 start = near.off_by({0.08, 0.05}, radians(1));
  const Pose2 far_start = move_target * start * inverse(move_source);
  const PoseEstimate here = refine(near.target, near.source, start, {});
  const PoseEstimate there = refine(PreparedMap(far_target, 0.05), PreparedMap(far_source, 0.05), far_start, {});
  const Pose2 back = inverse(move_target) * there.pose * move_source;
  EXPECT_LT(difference_at(near.source.centre_in_map(), back, here.pose).distance_m, 1e-6);
  ASSERT_TRUE(there.covariance);
  EXPECT_TRUE(there.covariance->allFinite());
}

TEST(Refine, UsesFewerPointsWhereToldTo) {
  const DrawnPair pair = flat_pair();
  const PoseEstimate refined = refine(pair.target, pair.source, pair.off_by({0.08, 0.05}, 0.01), {.max_points = 100});
  EXPECT_LT(pair.error(refined.pose).distance_m, 0.03);
  ASSERT_TRUE(refined.covariance);
}

/// Of `seeds` noisy scenes: how often the truth lies within three standard deviations (99.7 % of a Gaussian's mass).
TEST(Refine, ErrorsOfNoisyScenesAreCoveredByTheCovariance) {
  constexpr int kSeeds = 16;
  constexpr double kThreeSigma = 14.16;  // chi-square of three degrees of freedom
  int covered = 0;
  int honest = 0;  // and not by claiming to know next to nothing
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const worlds::MapPair pair = worlds::make_scene(known_pair("flat", seed));
    const PreparedMap target(pair.target, 0.05);
    const PreparedMap source(pair.source, 0.05);
    const Pose2 start = pair.target_from_source * Pose2{0.05, -0.04, 0.01};
    const PoseEstimate refined = refine(target, source, start, {});
    ASSERT_TRUE(refined.covariance);
    const Eigen::Vector3d off(refined.pose.x_m - pair.target_from_source.x_m,
                              refined.pose.y_m - pair.target_from_source.y_m,
                              wrap_angle(refined.pose.theta_rad - pair.target_from_source.theta_rad));
    const double distance2 = off.dot(refined.covariance->llt().solve(off));
    covered += distance2 < kThreeSigma ? 1 : 0;
    honest += std::sqrt((*refined.covariance)(2, 2)) < radians(2) ? 1 : 0;
    RecordProperty("seed_" + std::to_string(seed), std::to_string(distance2));
  }
  EXPECT_GE(covered, 14) << "of " << kSeeds;
  EXPECT_EQ(honest, kSeeds);
}

/// Two robots on two sides of a wall see its two faces; what pulls these together stretches the overlap.
TEST(Refine, IsNotPulledOffByTheOtherFacesOfWalls) {
  for (const char* name : {"office", "maze"}) {
    int covered = 0;
    for (int seed = 1; seed <= 4; ++seed) {
      const worlds::MapPair pair = worlds::make_scene(known_pair(name, seed));
      const PreparedMap target(pair.target, 0.05);
      const PreparedMap source(pair.source, 0.05);
      const PoseEstimate refined = refine(target, source, pair.target_from_source * Pose2{0.05, -0.04, 0.01}, {});
      EXPECT_LT(pose_error(pair, refined.pose).distance_m, 0.025) << name << " " << seed;
      ASSERT_TRUE(refined.covariance);
      const Eigen::Vector3d off(refined.pose.x_m - pair.target_from_source.x_m,
                                refined.pose.y_m - pair.target_from_source.y_m,
                                wrap_angle(refined.pose.theta_rad - pair.target_from_source.theta_rad));
      const double distance2 = off.dot(refined.covariance->llt().solve(off));
      RecordProperty(std::string(name) + "_" + std::to_string(seed), std::to_string(distance2));
      covered += distance2 < 14.16 ? 1 : 0;  // three standard deviations, chi-square of three degrees of freedom
    }
    EXPECT_GE(covered, 3) << name;
  }
}

}  // namespace
}  // namespace gridmerge
