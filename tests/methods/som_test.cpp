#include "methods/som/som.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "methods/som/orientation.hpp"
#include "methods/som/paper_som.hpp"
#include "methods/som/posts.hpp"
#include "methods/som/self_organising_map.hpp"
#include "methods/som/translation.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {

namespace {

using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// A piece of wall that faces so many degrees.
ClusterPoint piece(float x_m, float y_m, double facing_deg, float weight = 1) {
  return {
      .at = {x_m, y_m},
      .normal = {static_cast<float>(std::cos(radians(facing_deg))), static_cast<float>(std::sin(radians(facing_deg)))},
      .sided = true,
      .weight = weight};
}

std::vector<ClusterPoint> moved(const std::vector<ClusterPoint>& clusters, const Pose2& by) {
  std::vector<ClusterPoint> result;
  const Pose2 turn{0, 0, by.theta_rad};
  for (const ClusterPoint& one : clusters) {
    const Point2 at = by * Point2{static_cast<double>(one.at.x_m), static_cast<double>(one.at.y_m)};
    const Point2 normal = turn * Point2{static_cast<double>(one.normal.x_m), static_cast<double>(one.normal.y_m)};
    ClusterPoint other = one;
    other.at = {static_cast<float>(at.x_m), static_cast<float>(at.y_m)};
    other.normal = {static_cast<float>(normal.x_m), static_cast<float>(normal.y_m)};
    result.push_back(other);
  }
  return result;
}

/// An L-shaped room of 6 by 4 metres, a piece every half metre: no turn of it looks like another.
std::vector<ClusterPoint> l_shaped_room() {
  std::vector<ClusterPoint> clusters;
  const auto wall = [&](float x, float y, float dx, float dy, int pieces, double facing_deg) {
    for (int i = 0; i < pieces; ++i) {
      const float along = 0.5F * static_cast<float>(i) + 0.25F;
      clusters.push_back(piece(x + along * dx, y + along * dy, facing_deg));
    }
  };
  wall(0, 0, 1, 0, 12, 90);
  wall(6, 0, 0, 1, 4, 180);
  wall(2, 2, 1, 0, 8, -90);
  wall(2, 2, 0, 1, 4, 180);
  wall(0, 4, 1, 0, 4, -90);
  wall(0, 0, 0, 1, 8, 0);
  return clusters;
}

// --- the on-line map ---

TEST(SelfOrganisingMap, SpreadsItsNeuronsAlongAWall) {
  std::vector<Point2f> points;
  for (int i = 0; i < 200; ++i) {
    points.push_back({0.05F * static_cast<float>(i), 2});
  }
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RandomStream random(seed, "test");
    const std::vector<Point2f> chain = som::trained_chain(points, 10, {}, random);
    ASSERT_THAT(chain, SizeIs(10));
    for (std::size_t i = 0; i < chain.size(); ++i) {
      EXPECT_NEAR(chain[i].y_m, 2, 1e-4);
      EXPECT_NEAR(chain[i].x_m, 0.5 + static_cast<double>(i), 0.5) << "seed " << seed << ", neuron " << i;
    }
  }
}

TEST(SelfOrganisingMap, OfOneNeuronLearnsTheMiddle) {
  const std::vector<Point2f> points{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  RandomStream random(1, "test");
  const std::vector<Point2f> chain = som::trained_chain(points, 1, {.epochs = 100}, random);
  ASSERT_THAT(chain, SizeIs(1));
  EXPECT_NEAR(chain[0].x_m, 0.5, 0.25);
  EXPECT_NEAR(chain[0].y_m, 0.5, 0.25);
}

TEST(SelfOrganisingMap, HasTheNearestNeuronWin) {
  const std::vector<Point2f> neurons{{0, 0}, {5, 0}, {5, 5}};
  EXPECT_EQ(som::best_matching_unit(neurons, {4, 1}), 1U);
  EXPECT_EQ(som::best_matching_unit(neurons, {4, 4}), 2U);
  EXPECT_EQ(som::best_matching_unit(neurons, {-9, 1}), 0U);
}

// --- orientation ---

TEST(NormalHistogram, CountsMetresOfWallByWhereTheyFace) {
  const std::vector<ClusterPoint> clusters{piece(0, 0, 90, 3), piece(1, 0, 90, 2), piece(0, 1, -90, 1)};
  const som::NormalHistogram histogram = som::normal_histogram(clusters, 1);
  EXPECT_NEAR(std::accumulate(histogram.begin(), histogram.end(), 0.0F), 6, 1e-3);
  EXPECT_EQ(std::max_element(histogram.begin(), histogram.end()) - histogram.begin(), 90);
  EXPECT_NEAR(histogram[90] / histogram[270], 5, 1e-3);
}

TEST(NormalHistogram, SharesAWallWithoutASideBetweenBoth) {
  ClusterPoint one = piece(0, 0, 30);
  one.sided = false;
  const som::NormalHistogram histogram = som::normal_histogram(std::vector<ClusterPoint>{one}, 1);
  EXPECT_NEAR(histogram[30], histogram[210], 1e-5);
  EXPECT_GT(histogram[30], 0.1F);
}

TEST(ProjectionSharpness, IsGreatestAcrossAWall) {
  std::vector<ClusterPoint> wall;
  for (int i = 0; i < 40; ++i) {
    const double along = 0.25 * (i - 20);
    wall.push_back(piece(static_cast<float>(along * std::cos(radians(30))),
                         static_cast<float>(along * std::sin(radians(30))), 120));
  }
  const som::Sharpness sharpness = som::projection_sharpness(wall, 0.1);
  EXPECT_EQ(std::max_element(sharpness.begin(), sharpness.end()) - sharpness.begin(), 240);  // 120 degrees
}

TEST(Rotations, HoldTheTruthFirstWhereNoOtherTurnLooksLikeIt) {
  const std::vector<ClusterPoint> source = l_shaped_room();
  for (const double turn_deg : {0.0, 17.3, 90.0, 133.7, -60.2, 180.0}) {
    const std::vector<ClusterPoint> target = moved(source, {3, -2, radians(turn_deg)});
    const som::RotationSpectrum spectrum = som::rotation_spectrum(target, source, 2, 0.1);
    const std::vector<som::Rotation> turns = som::rotations(spectrum, {.tuning_rad = radians(3)}, {});
    ASSERT_THAT(turns, Not(IsEmpty()));
    // Walls of 6, 6, 4 and 4 metres face the four directions: half a turn leaves them as they are.
    const double nearest = std::min_element(turns.begin(), turns.end(), [&](const auto& a, const auto& b) {
                             return std::abs(wrap_angle(a.angle_rad - radians(turn_deg))) <
                                    std::abs(wrap_angle(b.angle_rad - radians(turn_deg)));
                           })->angle_rad;
    EXPECT_NEAR(degrees(wrap_angle(nearest - radians(turn_deg))), 0, 0.5) << turn_deg;
  }
}

TEST(Rotations, TellHalfATurnBySides) {
  // A long wall seen from one side only: without sides, half a turn would do as well.
  std::vector<ClusterPoint> source;
  for (int i = 0; i < 20; ++i) {
    source.push_back(piece(0.5F * static_cast<float>(i), 0, 90));
  }
  const std::vector<ClusterPoint> target = moved(source, {0, 0, radians(40)});
  const std::vector<som::Rotation> turns =
      som::rotations(som::rotation_spectrum(target, source, 2, 0.1), {.tuning_rad = 0}, {});
  ASSERT_THAT(turns, Not(IsEmpty()));
  EXPECT_NEAR(degrees(turns.front().angle_rad), 40, 0.2);
  for (const som::Rotation& one : turns) {
    EXPECT_TRUE(one.score > 0.9 || std::abs(degrees(wrap_angle(one.angle_rad - radians(220)))) > 10 || one.score < 0.1);
  }
}

TEST(Rotations, KeepToTheWindow) {
  const std::vector<ClusterPoint> room = l_shaped_room();
  const som::RotationSpectrum spectrum = som::rotation_spectrum(room, room, 2, 0.1);
  const PoseWindow window{.centre = {0, 0, radians(100)}, .radius_m = 1, .angle_rad = radians(15)};
  const std::vector<som::Rotation> turns =
      som::rotations(spectrum, {.tuning_rad = radians(3), .flank_rad = radians(4)}, window);
  ASSERT_THAT(turns, Not(IsEmpty()));
  for (const som::Rotation& one : turns) {
    EXPECT_LE(std::abs(wrap_angle(one.angle_rad - radians(100))), radians(15) + 1e-9);
  }
}

TEST(Rotations, TryTheFlanksOfAGoodTurnToo) {
  const std::vector<ClusterPoint> room = l_shaped_room();
  const som::RotationSpectrum spectrum = som::rotation_spectrum(room, room, 2, 0.1);
  const auto has = [](const std::vector<som::Rotation>& turns, double deg) {
    return std::any_of(turns.begin(), turns.end(), [&](const som::Rotation& one) {
      return std::abs(degrees(wrap_angle(one.angle_rad - radians(deg)))) < 0.6;
    });
  };
  const auto bare = som::rotations(spectrum, {.tuning_rad = 0}, {});
  const auto flanked = som::rotations(spectrum, {.tuning_rad = 0, .flank_rad = radians(4)}, {});
  EXPECT_TRUE(has(bare, 0) && !has(bare, 4) && !has(bare, -4));
  EXPECT_TRUE(has(flanked, 0) && has(flanked, 4) && has(flanked, -4));
}

// --- translation ---

TEST(TranslationVotes, PeakWhereTheWallsCoincide) {
  const std::vector<ClusterPoint> source = l_shaped_room();
  const Pose2 truth{7.3, -2.1, radians(25)};
  const std::vector<ClusterPoint> target = moved(source, truth);
  const som::VoteSurface surface = som::translation_votes(target, source, truth.theta_rad, radians(10), 0.25);
  const std::vector<ScoredPose> peaks = som::vote_peaks(surface, {}, 5);
  ASSERT_THAT(peaks, Not(IsEmpty()));
  EXPECT_NEAR(peaks.front().pose.x_m, truth.x_m, 0.25);
  EXPECT_NEAR(peaks.front().pose.y_m, truth.y_m, 0.25);
  EXPECT_EQ(peaks.front().pose.theta_rad, truth.theta_rad);
  EXPECT_TRUE(std::is_sorted(peaks.begin(), peaks.end(),
                             [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; }));
}

TEST(TranslationVotes, AreOnlyForWallsThatFaceTheSameWay) {
  const std::vector<ClusterPoint> target{piece(0, 0, 90)};
  const auto votes = [&](double facing_deg) {
    const std::vector<ClusterPoint> source{piece(1, 1, facing_deg)};
    const som::VoteSurface surface = som::translation_votes(target, source, 0, radians(20), 0.25);
    return std::accumulate(surface.votes.begin(), surface.votes.end(), 0.0F);
  };
  EXPECT_NEAR(votes(90), 1, 1e-5);
  EXPECT_NEAR(votes(105), 1, 1e-5);
  EXPECT_EQ(votes(180), 0);
  EXPECT_EQ(votes(-90), 0);
}

TEST(TranslationVotes, PeaksKeepToTheWindow) {
  const std::vector<ClusterPoint> room = l_shaped_room();
  const som::VoteSurface surface = som::translation_votes(room, room, 0, radians(10), 0.25);
  const PoseWindow window{.centre = {2, 1, 0}, .radius_m = 1.5, .angle_rad = radians(10)};
  for (const ScoredPose& one : som::vote_peaks(surface, window, 1000)) {
    EXPECT_TRUE(inside(one.pose, window));
  }
}

TEST(ClusterMatcher, MatchesEveryClusterAtTheTruth) {
  const std::vector<ClusterPoint> source = l_shaped_room();
  const Pose2 truth{1, 2, 0.5};
  const std::vector<ClusterPoint> target = moved(source, truth);
  const som::ClusterMatcher matcher(target, 0.6, radians(20), 1);
  const som::ClusterMatch match = matcher(source, truth);
  ASSERT_THAT(match.pairs, SizeIs(source.size()));
  for (const auto& [k, i] : match.pairs) {
    EXPECT_EQ(k, i);
  }
  EXPECT_NEAR(match.distance_sum_m, 0, 1e-3);  // J
  const som::ClusterMatch off = matcher(source, Pose2{0.1, 0, 0} * truth);
  EXPECT_NEAR(off.distance_sum_m, 0.1 * static_cast<double>(source.size()), 1e-3);
}

TEST(ClusterMatcher, MatchesNothingFarAway) {
  const std::vector<ClusterPoint> room = l_shaped_room();
  const som::ClusterMatcher matcher(room, 0.6, radians(20), 0.1);
  for (const Pose2& far : {Pose2{100, 0, 0}, Pose2{-1e9, 1e9, 0}, Pose2{0, -40, 1}}) {
    EXPECT_THAT(matcher(room, far).pairs, IsEmpty());
    EXPECT_EQ(matcher.step(room, far), far);
  }
}

TEST(ClusterMatcher, StepsBringAPoseToTheTruth) {
  const std::vector<ClusterPoint> source = l_shaped_room();
  const Pose2 truth{1, 2, 0.5};
  const std::vector<ClusterPoint> target = moved(source, truth);
  const som::ClusterMatcher matcher(target, 0.8, radians(20), 0.1);
  Pose2 pose{1.25, 1.85, 0.5 + radians(4)};
  for (int step = 0; step < 10; ++step) {
    pose = matcher.step(source, pose);
  }
  EXPECT_NEAR(pose.x_m, truth.x_m, 0.02);
  EXPECT_NEAR(pose.y_m, truth.y_m, 0.02);
  EXPECT_NEAR(degrees(wrap_angle(pose.theta_rad - truth.theta_rad)), 0, 0.3);
}

// --- posts ---

TEST(Posts, AreTheWallsThatStandByThemselves) {
  OccupancyGrid grid = unknown_grid({.width = 200, .height = 100, .resolution_m = 0.05, .map_from_grid = {}});
  std::fill(grid.cells.begin(), grid.cells.end(), std::int8_t{0});
  const auto block = [&](int column, int row, int width, int height) {
    for (int y = row; y < row + height; ++y) {
      for (int x = column; x < column + width; ++x) {
        grid.cells[grid.geometry.offset({x, y})] = 100;
      }
    }
  };
  block(20, 20, 4, 4);
  block(80, 60, 6, 6);
  block(150, 30, 4, 4);
  block(10, 90, 180, 2);  // a wall of 9 m
  const som::Posts posts = som::posts_of(PreparedMap(grid, 0.05), 1);
  ASSERT_THAT(posts.points, SizeIs(3));
  for (const ClusterPoint& one : posts.points) {
    EXPECT_EQ(one.normal.x_m, 0);
    EXPECT_EQ(one.normal.y_m, 0);
  }
  EXPECT_GE(posts.points[0].weight, posts.points[1].weight);  // the heaviest first
  const Point2f middle = posts.points[0].at;
  EXPECT_NEAR(std::hypot(posts.points[1].at.x_m - middle.x_m, posts.points[1].at.y_m - middle.y_m),
              0.05 * std::hypot(61, 41), 0.05);
  EXPECT_GT(posts.share, 0.05);
  EXPECT_LT(posts.share, 0.4);
}

TEST(Posts, OfAMapWithoutWallsAreNone) {
  const som::Posts posts = som::posts_of(PreparedMap(text_map({"..", ".."}, 0.05), 0.05), 1);
  EXPECT_THAT(posts.points, IsEmpty());
  EXPECT_EQ(posts.share, 0);
}

TEST(EvenTurns, GoAllRoundOrStayInTheWindow) {
  const std::vector<double> all = som::even_turns(radians(2), {});
  EXPECT_GE(all.size(), 180U);
  const PoseWindow window{.centre = {0, 0, radians(170)}, .radius_m = 1, .angle_rad = radians(15)};
  const std::vector<double> some = som::even_turns(radians(2), window);
  EXPECT_THAT(some, SizeIs(15));
  for (const double angle : some) {
    EXPECT_TRUE(inside({0, 0, angle}, window)) << degrees(angle);
  }
}

TEST(TranslationVotes, OfPostsAreForPosts) {
  std::vector<ClusterPoint> source;
  for (const auto& [x, y] : {std::pair{0.0F, 0.0F}, {3.0F, 1.0F}, {1.0F, 4.0F}, {-2.0F, 2.5F}}) {
    source.push_back({.at = {x, y}, .normal = {}, .sided = false, .weight = 1});
  }
  const Pose2 truth{2, -1, 0.7};
  const std::vector<ClusterPoint> target = moved(source, truth);
  const std::vector<ScoredPose> peaks =
      som::vote_peaks(som::translation_votes(target, source, truth.theta_rad, radians(20), 0.25), {}, 1);
  ASSERT_THAT(peaks, SizeIs(1));
  EXPECT_NEAR(peaks.front().pose.x_m, truth.x_m, 0.25);
  EXPECT_NEAR(peaks.front().pose.y_m, truth.y_m, 0.25);
  const som::ClusterMatcher matcher(target, 1, radians(20), 0.1);
  Pose2 pose{2.2, -1.1, 0.65};
  for (int step = 0; step < 10; ++step) {
    pose = matcher.step(source, pose);
  }
  EXPECT_NEAR(norm(pose.translation() - truth.translation()), 0, 0.02);
  EXPECT_NEAR(pose.theta_rad, truth.theta_rad, 0.01);
}

// --- the whole ---

bool right(const worlds::MapPair& pair, const Pose2& pose, double distance_m = 0.2, double angle_deg = 0.7) {
  const PoseDifference error = pose_error(pair, pose);
  return error.distance_m < distance_m && degrees(error.angle_rad) < angle_deg;
}

TEST(WallFitOnClusterPoints, IsBestAtTheTruth) {
  const ClusterPoints target = cluster_points(flat().target, {});
  const ClusterPoints source = cluster_points(flat().source, {});
  const WallFit fit(flat().target, flat().source, 1, {}, as_walls(target), as_walls(source));
  const Pose2 truth = to_local(flat().pair.target_from_source, flat().target, flat().source);
  const double at_truth = fit(truth);
  for (const Pose2& off : {Pose2{0.5, 0, 0}, Pose2{0, -0.5, 0}, Pose2{0, 0, radians(8)}, Pose2{3, 2, 1}}) {
    EXPECT_LT(fit(truth * off), 0.8 * at_truth);
  }
}

class SomOnKnownPairs : public testing::TestWithParam<KnownPair> {};

TEST_P(SomOnKnownPairs, IsRightWhereTheMapsSayItAndNeverMergesWhereTheyDoNot) {
  const KnownPair& known = GetParam();
  const bool bent = known.options.drift_m > 0;
  const worlds::MapPair pair = worlds::make_scene(known_pair(known.name));
  const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = {}}, SomMerger({}), {},
                                    {.seed = 1, .num_threads = 2});
  const std::string told = testing::PrintToString(alignment.reasons);
  if (!known.overlaps || known.ambiguous) {
    EXPECT_NE(alignment.outcome, Outcome::kMerged) << told;
    return;
  }
  EXPECT_EQ(alignment.outcome, Outcome::kMerged) << told;
  ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
  EXPECT_TRUE(right(pair, alignment.hypotheses.front().target_from_source.pose, bent ? 1 : 0.2, bent ? 3 : 0.7))
      << told;
}

std::string pair_name(const testing::TestParamInfo<KnownPair>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, SomOnKnownPairs, testing::ValuesIn(known_pairs()), pair_name);

TEST(Som, ProposesDistinctPoses) {
  const SomOptions options;
  const Proposal proposal = SomMerger(options).propose(flat().request(), {});
  ASSERT_GT(proposal.candidates.size(), 4U);
  EXPECT_LE(proposal.candidates.size(), static_cast<std::size_t>(options.candidates));
  EXPECT_TRUE(right(flat().pair, proposal.candidates.front().target_from_source, 0.3, 2));
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[k].target_from_source);
      EXPECT_TRUE(apart.distance_m >= options.distinct_m - 1e-6 ||
                  apart.angle_rad >= radians(options.distinct_deg) - 1e-6);
    }
  }
}

TEST(Som, FindsTheTruthOnFewClusters) {
  SomOptions options;
  options.clusters.at_most = 150;
  const Proposal proposal = SomMerger(options).propose(flat().request(), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_TRUE(right(flat().pair, proposal.candidates.front().target_from_source, 0.4, 2));
}

TEST(Som, DoesNotClaimToHaveLookedEverywhere) {
  // It looks at the turns that the normals allow, not at all.
  EXPECT_FALSE(SomMerger({}).propose(flat().request(), {}).surveyed);
  EXPECT_FALSE(PaperSomMerger({}).propose(flat().request(), {}).surveyed);
}

TEST(Som, PaperFindsTheTruthInAWindowForMostSeeds) {
  const Pose2 centre = flat().pair.target_from_source;
  const PosePrior prior{.target_from_source = centre, .radius_m = 2, .angle_rad = radians(20)};
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Proposal proposal = PaperSomMerger({}).propose(flat().request(prior), {.seed = seed});
    found += std::any_of(proposal.candidates.begin(), proposal.candidates.end(),
                         [](const Candidate& one) { return right(flat().pair, one.target_from_source, 0.4, 2); })
                 ? 1
                 : 0;
  }
  EXPECT_GE(found, 4) << "of 5 seeds";
}

TEST(Som, PaperScoresByTheAcceptanceIndex) {
  const Proposal proposal = PaperSomMerger({}).propose(flat().request(), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  for (const Candidate& one : proposal.candidates) {
    EXPECT_GE(one.method_score, 0);
    EXPECT_LE(one.method_score, 1);
  }
}

template <typename Method>
class SomViews : public testing::Test {};
using Profiles = testing::Types<SomMerger, PaperSomMerger>;
TYPED_TEST_SUITE(SomViews, Profiles);

TYPED_TEST(SomViews, ShowNeuronsNormalsTurnsAndMatches) {
  struct Watcher : TraceSink {
    std::vector<View> views;
    [[nodiscard]] bool wants_views() const override { return true; }
    void on_view(const View& view) override { views.push_back(view); }
  };
  Watcher watcher;
  RunContext context;
  context.trace = &watcher;
  (void)TypeParam({}).propose(flat().request(), context);
  std::set<std::string> names;
  for (const View& view : watcher.views) {
    EXPECT_TRUE(names.insert(view.name).second) << view.name << " is there twice";
    EXPECT_THAT(view.title, Not(IsEmpty()));
    if (const auto* surface = std::get_if<SurfaceView>(&view.content)) {
      EXPECT_EQ(surface->values.size(), static_cast<std::size_t>(surface->width * surface->height));
    } else if (const auto* curves = std::get_if<CurvesView>(&view.content)) {
      for (const Curve& curve : curves->curves) {
        EXPECT_EQ(curve.x.size(), curve.y.size());
      }
    } else {
      for (const Shape& shape : std::get<MapView>(view.content).shapes) {
        EXPECT_THAT(shape.points, Not(IsEmpty())) << view.name << "/" << shape.label;
      }
    }
  }
  for (const char* name : {"som_neurons_target", "som_neurons_source", "som_normals", "som_turns", "som_matches"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
}

TEST(Som, RefusesOptionsOutOfRange) {
  SomOptions options;
  options.turns = 0;
  EXPECT_THROW(SomMerger{options}, std::invalid_argument);
  options = {};
  options.clusters.spacing_m = 0;
  EXPECT_THROW(SomMerger{options}, std::invalid_argument);
  PaperSomOptions paper;
  paper.learning.first_rate = 0;
  EXPECT_THROW(PaperSomMerger{paper}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
