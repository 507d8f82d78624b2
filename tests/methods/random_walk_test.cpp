#include "methods/random_walk/random_walk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "methods/random_walk/adaptive_steps.hpp"
#include "methods/random_walk/manhattan.hpp"
#include "methods/random_walk/map_distance.hpp"
#include "methods/random_walk/paper_random_walk.hpp"
#include "methods/random_walk/random_pose.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr double kCell_m = 0.1;

/// A room that no turn and no shift puts on itself.
OccupancyGrid room() {
  return text_map(
      {
          "####################",
          "#..................#",
          "#..................#",
          "#.......######.....#",
          "#............#.....#",
          "#............#.....#",
          "#..................#",
          "#...###............#",
          "#...###............#",
          "#..................#",
          "####################",
      },
      kCell_m);
}

PreparedMap prepared(const OccupancyGrid& grid) { return {grid, grid.geometry.resolution_m}; }

/// A fence about the truth, which is moved and turned at the source's centre.
PosePrior fence(double x_m, double y_m, double turn_deg) {
  return {.target_from_source = flat().truth_off_by(x_m, y_m, turn_deg), .radius_m = 3, .angle_rad = radians(20)};
}

RunContext run(std::uint64_t seed, const StopToken& stop = {}, TraceSink* trace = nullptr) {
  return {.seed = seed, .num_threads = 1, .stop = stop, .trace = trace};
}

/// Enough for a flat.
RandomWalkOptions quick() {
  RandomWalkOptions options;
  options.starts_per_wall = 50;
  options.window_starts = 2000;
  options.walks = 96;
  return options;
}

/// Eq. 2.7 word for word: for every point the nearest cell of the value, by trying all.
double brute_mean_distance(const MapLevel& from, const MapLevel& to, CellState value, const Pose2& to_from) {
  double sum = 0;
  int count = 0;
  for (int row = 0; row < from.height; ++row) {
    for (int column = 0; column < from.width; ++column) {
      if (from.state[from.offset(column, row)] != value) {
        continue;
      }
      const Point2 at = to_from * Point2{from.lower_left.x_m + (column + 0.5) * from.resolution_m,
                                         from.lower_left.y_m + (row + 0.5) * from.resolution_m};
      const int c = static_cast<int>(std::floor((at.x_m - to.lower_left.x_m) / to.resolution_m));
      const int r = static_cast<int>(std::floor((at.y_m - to.lower_left.y_m) / to.resolution_m));
      int nearest = to.width + to.height;
      bool any = false;
      for (int y = 0; y < to.height; ++y) {
        for (int x = 0; x < to.width; ++x) {
          if (to.state[to.offset(x, y)] == value) {
            const int d = std::abs(x - c) + std::abs(y - r);
            nearest = any ? std::min(nearest, d) : d;
            any = true;
          }
        }
      }
      sum += nearest;
      ++count;
    }
  }
  return count == 0 ? 0 : sum / count;
}

TEST(ManhattanDistances, CountStepsToTheNearestCell) {
  const PreparedMap map = prepared(text_map({"....#", ".....", "#...."}, kCell_m));
  const MapLevel& level = map.level(0);
  const std::vector<int> distance = manhattan_distances(level, CellState::kWall);
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      int nearest = 1000;
      for (int y = 0; y < level.height; ++y) {
        for (int x = 0; x < level.width; ++x) {
          if (level.state[level.offset(x, y)] == CellState::kWall) {
            nearest = std::min(nearest, std::abs(x - column) + std::abs(y - row));
          }
        }
      }
      ASSERT_EQ(distance[level.offset(column, row)], nearest) << column << ", " << row;
    }
  }
}

TEST(ManhattanDistances, AreAsFarAsCanBeWhereNoCellHasTheState) {
  const PreparedMap map = prepared(text_map({"...", "..."}, kCell_m));
  const MapLevel& level = map.level(0);
  EXPECT_THAT(manhattan_distances(level, CellState::kWall), testing::Each(level.width + level.height));
}

TEST(MapDistance, IsPsiOfTheThesisWordForWord) {
  const PreparedMap target = prepared(room());
  const PreparedMap source = prepared(text_map({"#####", "#....", "#..#.", "#...."}, kCell_m));
  const MapDistance distance(target, source);
  for (const Pose2& pose :
       {Pose2{0.013, 0.027, 0.01}, Pose2{0.31, -0.17, 0.4}, Pose2{-1.22, 0.4, 2.5}, Pose2{4.03, 6.02, -1}}) {
    const MapLevel& t = target.level(0);
    const MapLevel& s = source.level(0);
    double psi = 0;
    for (const CellState value : {CellState::kWall, CellState::kOpen}) {
      psi += brute_mean_distance(s, t, value, pose) + brute_mean_distance(t, s, value, inverse(pose));
    }
    EXPECT_NEAR(distance(pose).psi_cells, psi, 1e-9) << testing::PrintToString(pose);
  }
}

TEST(MapDistance, IsZeroWhereAMapLiesOnItself) {
  const PreparedMap map = prepared(room());
  const Dissimilarity here = MapDistance(map, map)({});
  EXPECT_EQ(here.psi_cells, 0);
  EXPECT_EQ(here.disagree, 0);
  EXPECT_EQ(here.agree, static_cast<std::ptrdiff_t>(map.known_cells()));
  const Dissimilarity beside = MapDistance(map, map)({0.2, 0, 0});
  EXPECT_GT(beside.psi_cells, 0);
  EXPECT_GT(beside.disagree, 0);
  EXPECT_LT(here.delta(1), beside.delta(1));
}

TEST(MapDistance, CountsNoCellsWhereTheMapsAreApart) {
  const PreparedMap map = prepared(room());
  const Dissimilarity apart = MapDistance(map, map)({50, 0, 0});
  EXPECT_EQ(apart.agree, 0);
  EXPECT_EQ(apart.disagree, 0);
  EXPECT_NEAR(apart.psi_cells, 4 * 500, 4 * 20);  // 500 cells less the map's width, for two values both ways
}

TEST(LockedDistance, IsLeastWhereAMapLiesOnItself) {
  const PreparedMap map = prepared(room());
  const LockedDistance delta(map, map, 0, {}, 100000);
  const double here = delta({});
  EXPECT_LT(here, 0);
  for (const Pose2& pose :
       {Pose2{0.2, 0, 0}, Pose2{0, -0.3, 0}, Pose2{0, 0, 0.2}, Pose2{0, 0, kPi}, Pose2{1, 0.5, 1}}) {
    EXPECT_GT(delta(pose), here) << testing::PrintToString(pose);
  }
}

TEST(LockedDistance, IsZeroWithoutOverlap) {
  const PreparedMap map = prepared(room());
  EXPECT_EQ(LockedDistance(map, map, 0, {}, 100000)({100, 0, 0}), 0);
}

TEST(LockedDistance, IsTheSameForSwappedMapsUnderTheInversePose) {
  const LockedDistance forth(flat().target, flat().source, 1, {}, 100000);
  const LockedDistance back(flat().source, flat().target, 1, {}, 100000);
  for (const Pose2& pose : {Pose2{}, Pose2{0.7, -0.2, 0.3}, Pose2{-2, 1, 2}}) {
    EXPECT_NEAR(forth(pose), back(inverse(pose)), 1e-3);
  }
}

TEST(LockedDistance, DistantUnmatchedPartsDoNotPull) {
  // The target goes on far beyond the source. Psi as published is least somewhere between; here the truth wins.
  const PreparedMap target = prepared(text_map(
      {
          "##############################",
          "#..#.........................#",
          "#..#.........................#",
          "#............................#",
          "#######......................#",
          "#............................#",
          "##############################",
      },
      kCell_m));
  const PreparedMap source = prepared(text_map({"########", "#..#....", "#..#....", "#.......", "#######."}, kCell_m));
  const Pose2 truth = to_local({0, 0.2, 0}, target, source);
  const Pose2 pulled{truth.x_m + 0.4, truth.y_m, 0};
  const LockedDistance robust(target, source, 0, {}, 100000);
  EXPECT_LT(robust(truth), robust(pulled));
  const MapDistance published(target, source);
  EXPECT_GT(published(truth).psi_cells, published(pulled).psi_cells);
}

TEST(AdaptiveSteps, StartWithTheFirstWidths) {
  const AdaptiveSteps steps({.first_sigma = {0.5, 0.5, 0.1}, .floor_share = 0.001, .memory = 4});
  RandomStream random(1, "steps");
  PoseStep squares{};
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const PoseStep step = steps.draw(random);
    for (std::size_t k = 0; k < 3; ++k) {
      squares[k] += step[k] * step[k] / kDraws;
    }
  }
  EXPECT_NEAR(std::sqrt(squares[0]), 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(squares[1]), 0.5, 0.02);
  EXPECT_NEAR(std::sqrt(squares[2]), 0.1, 0.004);
  EXPECT_NEAR(steps.sigma_m(), 0.5, 1e-3);
}

TEST(AdaptiveSteps, FollowTheMeanAndTheSpreadOfTheLastAccepted) {
  AdaptiveSteps steps({.first_sigma = {1, 1, 1}, .floor_share = 0.01, .memory = 4});
  steps.accepted({9, 9, 9});  // forgotten after four more
  for (const double x : {1.0, 3.0, 1.0, 3.0}) {
    steps.accepted({x, 2 * x, 0.5});
  }
  RandomStream random(1, "steps");
  constexpr int kDraws = 20000;
  PoseStep mean{};
  double xy = 0;
  for (int i = 0; i < kDraws; ++i) {
    const PoseStep step = steps.draw(random);
    for (std::size_t k = 0; k < 3; ++k) {
      mean[k] += step[k] / kDraws;
    }
    xy += (step[0] - 2) * (step[1] - 4) / kDraws;
  }
  EXPECT_NEAR(mean[0], 2, 0.05);
  EXPECT_NEAR(mean[1], 4, 0.1);
  EXPECT_NEAR(mean[2], 0.5, 0.01);
  EXPECT_NEAR(xy, 2, 0.15);  // x has variance 1, y goes twice as far
}

TEST(AdaptiveSteps, WidenWithSuccessAndNarrowWithFailureWithinBounds) {
  AdaptiveSteps steps({.first_sigma = {1, 1, 1},
                       .floor_share = 0.5,
                       .memory = 4,
                       .on_accepted = 2,
                       .on_rejected = 0.5,
                       .mean_fade = 0.5,
                       .least_width = 0.25,
                       .most_width = 2});
  const double first = steps.sigma_m();
  for (int i = 0; i < 10; ++i) {
    steps.rejected();
  }
  EXPECT_NEAR(steps.sigma_m(), 0.25 * first, 1e-9);
  for (int i = 0; i < 10; ++i) {
    steps.accepted({0, 0, 0});
  }
  EXPECT_NEAR(steps.sigma_m(), 2 * 0.5, 1e-9);  // most_width times the floor: the accepted steps had no spread
}

TEST(StartPoses, LieInTheWindow) {
  const AlignRequest request = flat().request(fence(0.5, 0.2, 5));
  RandomStream random(1, "starts");
  const std::optional<PoseWindow> window = window_of(request);
  const std::vector<Pose2> poses = start_poses(request, window, 400, random);
  EXPECT_GT(poses.size(), 200U);
  EXPECT_LE(poses.size(), 400U);
  for (const Pose2& pose : poses) {
    EXPECT_TRUE(inside(pose, window));
  }
}

TEST(StartPoses, AreDrawnWhereNoWallSaysFromWhereItWasSeen) {
  const PreparedMap specks = prepared(text_map({"#...#", "....."}, kCell_m));
  const AlignRequest request{.target = specks, .source = specks, .prior = {}, .carried = nullptr};
  RandomStream random(1, "starts");
  EXPECT_THAT(start_poses(request, {}, 80, random), Not(IsEmpty()));
}

TEST(StartPoses, LieRoundTheTruthFarMoreOftenThanByChance) {
  const AlignRequest request = flat().request();
  const Pose2 truth = to_local(flat().pair.target_from_source, flat().target, flat().source);
  RandomStream random(1, "starts");
  int near = 0;
  int near_by_chance = 0;
  const auto is_near = [&](const Pose2& pose) {
    const PoseDifference apart = difference_at({}, pose, truth);
    return apart.distance_m < 0.5 && degrees(apart.angle_rad) < 6;
  };
  for (int i = 0; i < 20000; ++i) {
    near_by_chance += is_near(uniform_pose(request, {}, random)) ? 1 : 0;
    const std::optional<Pose2> pose = wall_on_wall_pose(request, random);
    near += pose && is_near(*pose) ? 1 : 0;
  }
  EXPECT_GT(near, 5 * (near_by_chance + 1));
}

TEST(RandomWalk, FindsTheTruthAnywhereForNearlyEverySeed) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    found += flat().found_by(RandomWalkMerger(quick()).propose(flat().request(), run(seed))) ? 1 : 0;
  }
  EXPECT_GE(found, 4) << "of 5 seeds";
}

TEST(RandomWalk, FindsTheTruthInAWindowForEverySeed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_TRUE(flat().found_by(RandomWalkMerger(quick()).propose(flat().request(fence(1.2, -1.5, 12)), run(seed))))
        << seed;
  }
}

TEST(RandomWalk, StandsWhereItStartsWithoutSteps) {
  RandomWalkOptions options;
  options.window_starts = 1;
  PosePrior start = fence(0.1, 0, 1);
  const Proposal proposal =
      RandomWalkMerger(options).propose(flat().request(start), run(1, StopToken().with_iterations(0)));
  EXPECT_EQ(proposal.iterations, 0);
  EXPECT_FALSE(proposal.stopped);
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_NEAR(pose_error(flat().pair, proposal.candidates.front().target_from_source).distance_m, 0.1, 1e-6);
}

TEST(RandomWalk, ItsWalksBringADistantStartHome) {
  // One start, off by more than the refinement behind could mend.
  RandomWalkOptions options;
  options.window_starts = 1;
  options.walks = 1;
  options.steps = 200;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    found += flat().found_by(RandomWalkMerger(options).propose(flat().request(fence(0.5, -0.4, 6)), run(seed))) ? 1 : 0;
  }
  EXPECT_GE(found, 8) << "of 10 seeds";
}

TEST(RandomWalk, ProposesDistinctPoses) {
  const RandomWalkOptions options = quick();
  const Proposal proposal = RandomWalkMerger(options).propose(flat().request(), run(1));
  ASSERT_LE(proposal.candidates.size(), static_cast<std::size_t>(options.candidates));
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[j].target_from_source);
      EXPECT_TRUE(apart.distance_m > options.niche_m - 1e-6 || degrees(apart.angle_rad) > options.niche_deg - 1e-6);
    }
  }
}

TEST(RandomWalk, NeverClaimsToHaveLookedEverywhere) {
  EXPECT_FALSE(RandomWalkMerger(quick()).propose(flat().request(), run(1)).surveyed);
  EXPECT_FALSE(PaperRandomWalkMerger({}).propose(flat().request(fence(0, 0, 0)), run(1)).surveyed);
}

TEST(RandomWalk, DoesNotMergeMapsOfTwoPlaces) {
  for (int scene = 1; scene <= 2; ++scene) {
    const worlds::MapPair pair = worlds::make_scene(known_pair("two_flats", scene));
    const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = {}},
                                      RandomWalkMerger(quick()), {}, {.seed = 1, .num_threads = 2});
    EXPECT_NE(alignment.outcome, Outcome::kMerged) << "scene " << scene;
  }
}

/// Keeps every view that it is shown.
struct Viewer : TraceSink {
  std::vector<View> views;
  [[nodiscard]] bool wants_views() const override { return true; }
  void on_view(const View& view) override { views.push_back(view); }
};

void expect_drawable(const Viewer& viewer) {
  std::set<std::string> names;
  for (const View& view : viewer.views) {
    EXPECT_TRUE(names.insert(view.name).second) << view.name;
    EXPECT_THAT(view.title, Not(IsEmpty()));
    if (const auto* curves = std::get_if<CurvesView>(&view.content)) {
      for (const Curve& curve : curves->curves) {
        EXPECT_THAT(curve.y, SizeIs(curve.x.size())) << view.name;
        EXPECT_THAT(curve.y, Not(IsEmpty())) << view.name;
      }
    } else if (const auto* map = std::get_if<MapView>(&view.content)) {
      EXPECT_THAT(map->shapes, Not(IsEmpty())) << view.name;
    }
  }
  for (const char* name : {"walks", "delta", "acceptance", "step_widths"}) {
    EXPECT_TRUE(names.contains(name)) << name;
  }
}

TEST(RandomWalk, ShowsItsWalksAndIsNotChangedByIt) {
  Viewer viewer;
  const AlignRequest request = flat().request(fence(1, 1, 10));
  const Proposal shown = RandomWalkMerger(quick()).propose(request, run(1, {}, &viewer));
  const Proposal unseen = RandomWalkMerger(quick()).propose(request, run(1));
  expect_drawable(viewer);
  ASSERT_EQ(shown.candidates.size(), unseen.candidates.size());
  EXPECT_EQ(shown.candidates.front().target_from_source, unseen.candidates.front().target_from_source);
}

TEST(PaperRandomWalk, FindsTheTruthNearbyForMostSeeds) {
  PaperRandomWalkOptions options;
  options.samples = 400;
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Proposal proposal = PaperRandomWalkMerger(options).propose(flat().request(fence(0.8, -0.5, 8)), run(seed));
    ASSERT_THAT(proposal.candidates, SizeIs(1));
    found += flat().found_by(proposal, 0.5, 4) ? 1 : 0;
  }
  EXPECT_GE(found, 4) << "of 5 seeds";
}

TEST(PaperRandomWalk, StartsAtThePriorAndAnywhereWithoutOne) {
  const StopToken at_once = StopToken().with_iterations(0);
  const PaperRandomWalkMerger method({});
  const PosePrior prior = fence(0.3, 0, 2);
  const Proposal there = method.propose(flat().request(prior), run(1, at_once));
  EXPECT_LT(difference_at(flat().source.centre_in_map(), there.candidates.front().target_from_source,
                          prior.target_from_source)
                .distance_m,
            1e-6);
  const Pose2 one = method.propose(flat().request(), run(1, at_once)).candidates.front().target_from_source;
  const Pose2 other = method.propose(flat().request(), run(2, at_once)).candidates.front().target_from_source;
  EXPECT_NE(one, other);
}

TEST(PaperRandomWalk, ShowsItsWalk) {
  PaperRandomWalkOptions options;
  options.samples = 100;
  Viewer viewer;
  (void)PaperRandomWalkMerger(options).propose(flat().request(fence(1, 1, 10)), run(1, {}, &viewer));
  expect_drawable(viewer);
}

TEST(RandomWalk, RefusesOptionsOutOfRange) {
  RandomWalkOptions options;
  options.walks = 0;
  EXPECT_THROW(RandomWalkMerger{options}, std::invalid_argument);
  options = {};
  options.lock.reach_m = 0;
  EXPECT_THROW(RandomWalkMerger{options}, std::invalid_argument);
  PaperRandomWalkOptions published;
  published.memory = 0;
  EXPECT_THROW(PaperRandomWalkMerger{published}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
