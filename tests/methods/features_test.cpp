#include "methods/features/features.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "methods/features/keypoints.hpp"
#include "methods/features/paper_features.hpp"
#include "methods/features/rigid_ransac.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

RunContext run(std::uint64_t seed, const StopToken& stop = {}, TraceSink* trace = nullptr) {
  return {.seed = seed, .num_threads = 1, .stop = stop, .trace = trace};
}

KeypointMatch matched(const Pose2& target_from_source, Point2 source) {
  return {.target = target_from_source * source, .source = source, .turn_rad = target_from_source.theta_rad};
}

/// Points all over a place of 20 m, brought together by a pose.
std::vector<KeypointMatch> right_matches(const Pose2& pose, int count, RandomStream& random) {
  std::vector<KeypointMatch> matches;
  for (int i = 0; i < count; ++i) {
    matches.push_back(matched(pose, {random.uniform(-10, 10), random.uniform(-10, 10)}));
  }
  return matches;
}

std::vector<KeypointMatch> wrong_matches(int count, RandomStream& random) {
  std::vector<KeypointMatch> matches;
  for (int i = 0; i < count; ++i) {
    matches.push_back({.target = {random.uniform(-10, 10), random.uniform(-10, 10)},
                       .source = {random.uniform(-10, 10), random.uniform(-10, 10)},
                       .turn_rad = random.uniform(-kPi, kPi)});
  }
  return matches;
}

std::vector<KeypointMatch> both(std::vector<KeypointMatch> a, const std::vector<KeypointMatch>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void expect_near(const Pose2& found, const Pose2& truth, double distance_m, double angle_deg) {
  const PoseDifference off = difference_at({}, found, truth);
  EXPECT_LT(off.distance_m, distance_m);
  EXPECT_LT(degrees(off.angle_rad), angle_deg);
}

TEST(RigidFit, IsExactForExactMatches) {
  RandomStream random(1, "points");
  for (const Pose2& truth : {Pose2{}, Pose2{3, -2, 1}, Pose2{-1, 0.5, kPi}, Pose2{0, 4, -3}}) {
    for (const int count : {2, 3, 20}) {
      const std::optional<Pose2> fitted = rigid_fit(right_matches(truth, count, random));
      ASSERT_TRUE(fitted);
      expect_near(*fitted, truth, 1e-9, 1e-6);
    }
  }
}

TEST(RigidFit, NeverScalesAndNeverMirrors) {
  // The source is drawn twice as large: the best rigid pose leaves it so.
  const std::optional<Pose2> scaled =
      rigid_fit({{.target = {1, 0}, .source = {2, 0}}, {.target = {-1, 0}, .source = {-2, 0}}});
  ASSERT_TRUE(scaled);
  expect_near(*scaled, {}, 1e-9, 1e-6);
  // A mirrored triangle: some pose, but none that brings its corners together.
  const std::vector<KeypointMatch> mirrored = {{.target = {0, 0}, .source = {0, 0}},
                                               {.target = {3, 0}, .source = {3, 0}},
                                               {.target = {0, -2}, .source = {0, 2}}};
  const std::optional<Pose2> pose = rigid_fit(mirrored);
  ASSERT_TRUE(pose);
  EXPECT_LT(inliers_of(mirrored, *pose, {.inlier_m = 0.3}).size(), 3U);
}

TEST(RigidFit, SaysNothingOfPointsOnOneSpot) {
  EXPECT_FALSE(rigid_fit({{.target = {1, 1}, .source = {2, 0}}, {.target = {1, 1}, .source = {2, 0}}}));
}

TEST(RigidRansac, FindsThePoseAmongWrongMatchesForEverySeed) {
  const Pose2 truth{2, -1, 0.7};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomStream random(seed, "matches");
    const auto matches = both(right_matches(truth, 30, random), wrong_matches(120, random));
    const std::optional<RansacPose> found = rigid_ransac(matches, {}, {}, random);
    ASSERT_TRUE(found) << seed;
    expect_near(found->pose, truth, 0.1, 1);
    EXPECT_GE(found->inliers.size(), 30U);
  }
}

TEST(RigidRansac, KeepsToTheWindow) {
  const Pose2 truth{2, -1, 0.7};
  RandomStream random(1, "matches");
  const auto matches = right_matches(truth, 30, random);
  const PoseWindow elsewhere{.centre = {-3, 0, 0}, .radius_m = 1, .angle_rad = 0.3};
  EXPECT_FALSE(rigid_ransac(matches, {}, elsewhere, random));
  const PoseWindow there{.centre = {2.2, -1, 0.6}, .radius_m = 1, .angle_rad = 0.3};
  EXPECT_TRUE(rigid_ransac(matches, {}, there, random));
}

TEST(RigidRansac, FindsNothingInTooFewMatches) {
  RandomStream random(1, "matches");
  EXPECT_FALSE(rigid_ransac({}, {}, {}, random));
  EXPECT_FALSE(rigid_ransac(right_matches({}, 1, random), {}, {}, random));
}

TEST(RigidRansac, HeedsTheTurnOfTheMatchesWhereAsked) {
  const Pose2 truth{1, 1, 0.5};
  RandomStream random(1, "matches");
  std::vector<KeypointMatch> matches = right_matches(truth, 20, random);
  for (KeypointMatch& match : matches) {
    match.turn_rad = wrap_angle(match.turn_rad + kPi);
  }
  EXPECT_TRUE(rigid_ransac(matches, {}, {}, random));
  EXPECT_FALSE(rigid_ransac(matches, {.turn_rad = radians(25)}, {}, random));
}

TEST(SequentialRansac, FindsOnePoseAfterTheOther) {
  const Pose2 first{2, -1, 0.7};
  const Pose2 second{-3, 2, -2};
  RandomStream random(1, "matches");
  const auto matches =
      both(both(right_matches(first, 40, random), right_matches(second, 25, random)), wrong_matches(30, random));
  const SequentialPoses found = sequential_ransac(matches, {}, 2, flat().request(), run(1));
  ASSERT_THAT(found.poses, SizeIs(2));
  EXPECT_EQ(found.rounds, 2);
  expect_near(found.poses[0].pose, first, 0.1, 1);
  expect_near(found.poses[1].pose, second, 0.1, 1);
}

TEST(Keypoints, OfAMapMatchThemselves) {
  for (const std::string detector : {"akaze", "orb"}) {
    for (const MapImage image : {MapImage::kBytes, MapImage::kShading}) {
      const KeypointMatches found =
          match_keypoints(flat().target, flat().target, {.detector = detector, .image = image, .ratio = 0.9});
      EXPECT_THAT(found.target_keypoints, SizeIs(found.source_keypoints.size()));
      const auto agree = inliers_of(found.matches, {}, {.inlier_m = 0.05, .turn_rad = radians(1)});
      EXPECT_GE(agree.size(), 10U) << detector;
      EXPECT_GE(2 * agree.size(), found.matches.size()) << detector;
    }
  }
}

TEST(Keypoints, LieOnTheMapWhateverItsLevel) {
  const PreparedMap& map = flat().target;
  for (const int level : {0, 1}) {
    const KeypointMatches found = match_keypoints(map, map, {.level = level});
    EXPECT_THAT(found.target_keypoints, Not(IsEmpty()));
    for (const Point2& point : found.target_keypoints) {
      EXPECT_LT(norm(point), map.radius_m() + 3);
    }
  }
}

TEST(Keypoints, AreNoneOnASpeck) {
  const PreparedMap speck(text_map({"#"}, 0.05), 0.05);
  for (const std::string detector : {"akaze", "orb"}) {
    EXPECT_THAT(match_keypoints(speck, flat().target, {.detector = detector}).matches, IsEmpty()) << detector;
  }
}

TEST(Features, FindsTheTruthAnywhereForNearlyEverySeed) {
  FeaturesOptions options;
  options.detector = "akaze";
  options.hypotheses = 12;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    found += flat().found_by(FeaturesMerger(options).propose(flat().request(), run(seed))) ? 1 : 0;
  }
  EXPECT_GE(found, 4) << "of 5 seeds";
}

TEST(Features, ProposesDistinctPosesOnly) {
  const Proposal proposal = FeaturesMerger({}).propose(flat().request(), run(1));
  EXPECT_FALSE(proposal.surveyed);
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[j].target_from_source);
      EXPECT_TRUE(apart.distance_m > 0.59 || degrees(apart.angle_rad) > 3.9);
    }
  }
}

TEST(PaperFeatures, ProposesOnePoseOrNone) {
  const Proposal proposal = PaperFeaturesMerger({}).propose(flat().request(), run(1));
  EXPECT_THAT(proposal.candidates, SizeIs(1));
  EXPECT_TRUE(flat().found_by(proposal));
  PaperFeaturesOptions sure;
  sure.confidence = 1000;
  EXPECT_THAT(PaperFeaturesMerger(sure).propose(flat().request(), run(1)).candidates, IsEmpty());
}

TEST(Features, ShowsKeypointsAndInliers) {
  struct Viewer : TraceSink {
    std::vector<View> views;
    [[nodiscard]] bool wants_views() const override { return true; }
    void on_view(const View& view) override { views.push_back(view); }
  };
  Viewer viewer;
  FeaturesOptions options;
  options.detector = "akaze";
  options.hypotheses = 2;
  (void)FeaturesMerger(options).propose(flat().request(), run(1, {}, &viewer));
  std::set<std::string> names;
  for (const View& view : viewer.views) {
    EXPECT_TRUE(names.insert(view.name).second) << view.name;
    ASSERT_TRUE(std::holds_alternative<MapView>(view.content));
    EXPECT_THAT(std::get<MapView>(view.content).shapes, Not(IsEmpty()));
  }
  EXPECT_EQ(names, (std::set<std::string>{"inliers", "keypoints_source", "keypoints_target"}));
}

TEST(Features, RefusesOptionsOutOfRange) {
  FeaturesOptions options;
  options.detector = "surf";
  EXPECT_THROW(FeaturesMerger{options}, std::invalid_argument);
  PaperFeaturesOptions published;
  published.min_matches = 1;
  EXPECT_THROW(PaperFeaturesMerger{published}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
