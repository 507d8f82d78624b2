#include "gridmerge/judge/evaluator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <stdexcept>

#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

/// Two maps of 1 m cells, drawn in one frame; a wall is confirmed by one in its cell or in the four beside it.
struct Drawn {
  PreparedMap target;
  PreparedMap source;

  Drawn(const OccupancyGrid& target_grid, const OccupancyGrid& source_grid)
      : target(target_grid, target_grid.geometry.resolution_m),
        source(source_grid, source_grid.geometry.resolution_m) {}

  [[nodiscard]] Evaluator evaluator(EvaluatorOptions options = {}) const {
    options.tolerance_m = 1;
    return {target, source, options};
  }
  [[nodiscard]] Figures figures(const Pose2& pose = {}, const EvaluatorOptions& options = {}) const {
    return evaluator(options).figures(pose);
  }
  [[nodiscard]] Figures swapped(const Pose2& pose = {}) const {
    return Evaluator(source, target, {.tolerance_m = 1}).figures(inverse(pose));
  }
};

TEST(Evaluator, CountsAgreementCellByCell) {
  const Drawn maps(text_map({"??????", "##8#??", "#...??", "#.#.??", "......"}),
                   text_map({"......", "##.#..", "#..?..", "#?#9..", "####??"}));
  // Row by row from the top: 0 + (3 agree, 1 not) + (3 agree) + (2 agree, 1 not) + (4 not).
  const Figures f = maps.figures();
  EXPECT_EQ(f.agreement_cells, 3 + 3 + 2);
  EXPECT_EQ(f.disagreement_cells, 1 + 0 + 1 + 4);
  EXPECT_NEAR(f.acceptance_index, 8.0 / 14, 1e-12);
  EXPECT_EQ(f.overlap_area_m2, 14);
  EXPECT_NEAR(f.overlap_share, 14.0 / 18, 1e-12);  // of the target's 18 cells; the source knows 26
  EXPECT_NEAR(f.fitness, 6, 1e-12);                // walls on walls, all of them of 100 percent
}

TEST(Evaluator, SupportDiscountsEvidenceByTheShareOfNearConflict) {
  // A wall of the source three cells beside the target's: beyond the tolerance of 1 m, within three of them.
  const Drawn maps(text_map({"#....", "#....", "#....", "#....", "#...."}),
                   text_map({"#....", "#....", "#....", "#....", "...#."}));
  const Figures f = maps.figures();
  const double same_side = f.source_in_target.same_side_m + f.target_in_source.same_side_m;
  const double near = f.source_in_target.in_free_m + f.target_in_source.in_free_m;
  ASSERT_GT(f.evidence_m, 0);
  ASSERT_GT(near, 0);
  ASSERT_EQ(f.far_conflict_share, 0);
  const double agreeing = same_side / (same_side + near);
  EXPECT_NEAR(f.support_m, f.evidence_m * std::pow(agreeing, EvaluatorOptions{}.near_conflict_power), 1e-9);
  EXPECT_EQ(maps.figures({}, {.near_conflict_power = 0}).support_m, f.evidence_m);
  const Figures nowhere = maps.figures({3, 0, 0});
  ASSERT_LT(nowhere.evidence_m, 0);
  EXPECT_EQ(nowhere.support_m, nowhere.evidence_m);
}

TEST(Evaluator, FitnessAddsTheTargetsOccupancyUnderTheSourcesWalls) {
  const Drawn maps(text_map({"879..6"}), text_map({"##.##8"}));
  EXPECT_NEAR(maps.figures().fitness, 0.8 + 0.7, 1e-6);  // 60 percent is no wall
  EXPECT_NEAR(maps.swapped().fitness, 1 + 1, 1e-6);
}

TEST(Evaluator, FiguresMoveWithThePose) {
  const Drawn maps(text_map({"#....", "#...."}), text_map({"#....", "#...."}));
  EXPECT_EQ(maps.figures().acceptance_index, 1);
  const Figures moved = maps.figures({2, 0, 0});  // the source's wall in the target's third column
  EXPECT_EQ(moved.overlap_area_m2, 6);
  EXPECT_EQ(moved.disagreement_cells, 2);
  EXPECT_EQ(moved.fitness, 0);
  const Figures turned = maps.figures({5, 2, kPi});  // upside down: its wall in the last column
  EXPECT_EQ(turned.overlap_area_m2, 10);
  EXPECT_EQ(turned.agreement_cells, 6);
  const Figures apart = maps.figures({100, 0, 0});
  EXPECT_EQ(apart.overlap_area_m2, 0);
  EXPECT_EQ(apart.acceptance_index, 0);
  EXPECT_EQ(apart.mutual_information_bit, 0);
}

TEST(Evaluator, SortsWallsIntoConfirmedInFreeAndUnseen) {
  //                             a wall on the left, seen from the right; the last columns unknown
  const Drawn maps(text_map({"#.........???", "#.........???", "#.........???", "#.........???", "#.........???"}),
                   text_map({"#????????????", "?#???????????", "??#??????????", "????#????????", "??????????#??"}));
  const WallMeeting source = maps.figures().source_in_target;
  EXPECT_EQ(source.all_m, 5);
  EXPECT_EQ(source.confirmed_m, 2);  // on the wall, and in the cell beside it
  EXPECT_EQ(source.in_free_m, 1);    // four metres off
  EXPECT_EQ(source.unseen_m, 2);     // two metres off: too near to be sure; and where nobody has been
  EXPECT_EQ(source.same_side_m, 1);  // no side is known of the source's walls: each counts half
  const WallMeeting target = maps.figures().target_in_source;
  EXPECT_EQ(target.all_m, 5);
  EXPECT_EQ(target.confirmed_m, 2);  // its two upper cells: the diagonal leaves the third two metres off
  EXPECT_EQ(target.in_free_m, 0);    // the source knows no free space
}

TEST(Evaluator, LooksFarEnoughBesideAWallButNoFarther) {
  const Drawn maps(text_map({"....................", "#...................", "...................."}),
                   text_map({"????????????????????", "#???????????????????", "????????????????????"}));
  for (const double shift_m : {0.0, 1.0}) {
    EXPECT_EQ(maps.figures({shift_m, 0, 0}).source_in_target.confirmed_m, 1) << shift_m;
  }
  EXPECT_EQ(maps.figures({2, 0, 0}).source_in_target.unseen_m, 1);
  EXPECT_EQ(maps.figures({1, 1, 0}).source_in_target.unseen_m, 1);
  EXPECT_EQ(maps.figures({3, 0, 0}).source_in_target.in_free_m, 1);
  EXPECT_EQ(maps.figures({0, 5, 0}).source_in_target.unseen_m, 1);  // off the map
}

TEST(Evaluator, EvidenceIsWallsSeenFromTheSameSideLessThoseInFreeSpace) {
  const Drawn maps(text_map({"######????", "......????", "..........", "..........", ".........."}),
                   text_map({"######????", "......????", "??????????", "#?????????", "??????????"}));
  const Figures f = maps.figures({}, {.conflict_weight = 2});
  EXPECT_EQ(f.source_in_target.all_m, 7);
  EXPECT_EQ(f.source_in_target.same_side_m, 6);
  EXPECT_EQ(f.source_in_target.in_free_m, 1);
  EXPECT_EQ(f.target_in_source.same_side_m, 6);
  EXPECT_EQ(f.target_in_source.in_free_m, 0);
  EXPECT_EQ(f.evidence_m, 12 - 2 * 1);
  EXPECT_NEAR(f.conflict_share, 1.0 / 13, 1e-12);
  EXPECT_NEAR(f.same_side_share, 1, 1e-12);
  EXPECT_EQ(maps.evaluator({.conflict_weight = 0}).evidence_m({}), 12);
}

TEST(Evaluator, TellsWallsFarOutInFreeSpaceFromThoseThatDriftMayHavePutThere) {
  const Drawn maps(text_map({"........", "#.......", "........"}), text_map({"????????", "#???????", "????????"}));
  const auto source_at = [&](double shift_m) { return maps.figures({shift_m, 0, 0}).source_in_target; };
  EXPECT_EQ(source_at(3).in_free_m, 1);
  EXPECT_EQ(source_at(3).far_in_free_m, 0);  // three tolerances off, and no farther
  EXPECT_EQ(source_at(4).in_free_m, 1);
  EXPECT_EQ(source_at(4).far_in_free_m, 1);
  EXPECT_EQ(maps.figures({3, 0, 0}).far_conflict_share, 0);
  EXPECT_EQ(maps.figures({4, 0, 0}).far_conflict_share, 1);
}

/// A room of 6 m by 5 m in 0.1 m cells, with blocks standing in it: lower left corner and side, in cells.
OccupancyGrid room_with(const std::vector<std::array<int, 3>>& blocks) {
  OccupancyGrid grid = unknown_grid({.width = 60, .height = 50, .resolution_m = 0.1, .map_from_grid = {}});
  for (int row = 0; row < 50; ++row) {
    for (int column = 0; column < 60; ++column) {
      const bool border = column == 0 || column == 59 || row == 0 || row == 49;
      const bool block = std::any_of(blocks.begin(), blocks.end(), [&](const std::array<int, 3>& one) {
        return column >= one[0] && column < one[0] + one[2] && row >= one[1] && row < one[1] + one[2];
      });
      grid.at({column, row}) = border || block ? kOccupied : kFree;
    }
  }
  return grid;
}
Figures at_home(const OccupancyGrid& a, const OccupancyGrid& b) {
  const Drawn maps(a, b);
  return Evaluator(maps.target, maps.source, EvaluatorOptions{}).figures({});
}
const std::array<int, 3> kCupboard = {10, 10, 10};
const std::array<int, 3> kCounter = {25, 8, 25};

TEST(Evaluator, FurnitureElsewhereSpeaksAgainstAPoseThatItsWallsFit) {
  const OccupancyGrid here = room_with({kCupboard});
  const OccupancyGrid elsewhere = room_with({{40, 30, 10}});
  const Figures same = at_home(here, here);
  const Figures moved = at_home(here, elsewhere);
  EXPECT_LT(same.furniture_conflict_share, 0.2);
  EXPECT_EQ(same.elastic_both_furniture_conflict_share, 0);
  EXPECT_GT(moved.furniture_conflict_share, 0.8);
  EXPECT_GT(moved.elastic_both_furniture_conflict_share, 0.6);
  EXPECT_GT(moved.both_far_conflict_share, 0.1);
}

TEST(Evaluator, LegsElsewhereAreNoFurnitureElsewhere) {
  const OccupancyGrid here = room_with({kCupboard, {30, 30, 2}, {34, 30, 2}, {30, 34, 2}, {34, 34, 2}});
  const OccupancyGrid pushed = room_with({kCupboard, {40, 20, 2}, {44, 20, 2}, {40, 24, 2}, {44, 24, 2}});
  const Figures f = at_home(here, pushed);
  EXPECT_GT(f.conflict_share, 0);
  EXPECT_LT(f.furniture_conflict_share, 0.2);
  EXPECT_EQ(f.elastic_both_furniture_conflict_share, 0);
  EXPECT_EQ(f.both_far_conflict_share, 0);
}

TEST(Evaluator, WhatAPlanLacksStandsInItsFreeSpaceOneWayOnly) {
  const Figures f = at_home(room_with({}), room_with({kCupboard}));
  EXPECT_GT(f.furniture_conflict_share, 0.8);
  EXPECT_EQ(f.elastic_both_furniture_conflict_share, 0);
  EXPECT_EQ(f.both_far_conflict_share, 0);
}

TEST(Evaluator, OfPiecesThatAreNotThereNothingIsKnown) {
  const Figures bare = at_home(room_with({}), room_with({}));
  EXPECT_NEAR(bare.furniture_conflict_share, 0.5, 1e-12);
  EXPECT_NEAR(bare.fittings_conflict_share, 0.5, 1e-12);
  const Figures fitted = at_home(room_with({kCounter}), room_with({kCounter}));
  EXPECT_NEAR(fitted.furniture_conflict_share, 0.5, 1e-12);
  EXPECT_LT(fitted.fittings_conflict_share, 0.1);
}

TEST(Evaluator, WithoutWallsToTellByAPlaceIsAsRoughAsAStrangeOne) {
  EXPECT_LT(at_home(room_with({}), room_with({})).elastic_roughness_m, 0.05);
  OccupancyGrid open = room_with({kCupboard});  // its border not yet seen
  for (int row = 0; row < open.geometry.height; ++row) {
    for (int column = 0; column < open.geometry.width; ++column) {
      const bool border =
          column == 0 || column == open.geometry.width - 1 || row == 0 || row == open.geometry.height - 1;
      open.at({column, row}) = border ? kUnknown : open.at({column, row});
    }
  }
  const Figures f = at_home(open, open);
  EXPECT_EQ(f.conflict_share, 0);
  EXPECT_NEAR(f.elastic_roughness_m, 0.4, 1e-12);
}

TEST(Evaluator, PiecesAddUpToTheWhole) {
  const Drawn maps(room_with({kCupboard, {30, 40, 2}}), room_with({kCounter}));
  const Figures f = Evaluator(maps.target, maps.source, EvaluatorOptions{}).figures({0.3, -0.2, 0.1});
  for (const WallMeeting& met : {f.source_in_target, f.target_in_source}) {
    PieceMeeting sum;
    for (const PieceMeeting& piece : met.pieces) {
      sum.same_side_m += piece.same_side_m;
      sum.in_free_m += piece.in_free_m;
      sum.far_in_free_m += piece.far_in_free_m;
    }
    EXPECT_NEAR(sum.same_side_m, met.same_side_m, 1e-9);
    EXPECT_NEAR(sum.in_free_m, met.in_free_m, 1e-9);
    EXPECT_NEAR(sum.far_in_free_m, met.far_in_free_m, 1e-9);
    EXPECT_GT(met.in_free_m, 0);
  }
}

TEST(Evaluator, AWallSeenFromTheOtherSideIsConfirmedButDoesNotSpeakForThePose) {
  const OccupancyGrid from_below = text_map({"????????", "????????", "########", "........", "........", "........"});
  const OccupancyGrid from_above = text_map({"........", "........", "........", "########", "????????", "????????"});
  const Drawn same(from_below, from_below);
  EXPECT_EQ(same.figures().source_in_target.same_side_m, 8);
  EXPECT_EQ(same.figures().same_side_share, 1);
  // One row down, so that wall lies on wall.
  const Drawn other(from_below, from_above);
  const Figures back_to_back = other.figures({0, 1, 0});
  EXPECT_EQ(back_to_back.source_in_target.confirmed_m, 8);
  EXPECT_EQ(back_to_back.source_in_target.same_side_m, 0);
  EXPECT_EQ(back_to_back.same_side_share, 0);
  EXPECT_EQ(back_to_back.evidence_m, 0);
  // Half a turn, and the wall that was seen from above has been seen from below.
  const Figures turned = other.figures({8, 6, kPi});
  EXPECT_EQ(turned.source_in_target.confirmed_m, 8);
  EXPECT_EQ(turned.source_in_target.same_side_m, 8);
}

TEST(Evaluator, AWallSeenFromBothSidesAgreesWithEither) {
  const std::string free(40, '.');
  const std::string wall(40, '#');
  const std::string unknown(40, '?');
  const Drawn maps(text_map({free, free, wall, free, free}), text_map({unknown, unknown, wall, free, free}));
  EXPECT_EQ(maps.figures().source_in_target.same_side_m, 40);
  // Without a side of its own a wall counts half; at the ends free space lies to one side only.
  const double half = maps.figures().target_in_source.same_side_m;
  EXPECT_GE(half, 0.5 * 34);
  EXPECT_LE(half, 0.5 * 34 + 6);
}

TEST(Evaluator, MutualInformationOfKnownTables) {
  const auto bits = [](const OccupancyGrid& a, const OccupancyGrid& b) {
    return Drawn(a, b).figures().mutual_information_bit;
  };
  EXPECT_NEAR(bits(text_map({"##.."}), text_map({"##.."})), 1, 1e-12);
  EXPECT_NEAR(bits(text_map({"##.."}), text_map({"..##"})), 1, 1e-12);  // each tells the other all the same
  EXPECT_NEAR(bits(text_map({"##.."}), text_map({"#.#."})), 0, 1e-12);
  EXPECT_NEAR(bits(text_map({"...."}), text_map({"...."})), 0, 1e-12);
  // Five cells: 2 walls together, 2 free together, 1 wall of the target's on free.
  const double expected =
      0.4 * std::log2(0.4 / (0.6 * 0.4)) + 0.4 * std::log2(0.4 / (0.4 * 0.6)) + 0.2 * std::log2(0.2 / (0.6 * 0.6));
  EXPECT_NEAR(bits(text_map({"###.."}), text_map({"##..."})), expected, 1e-12);
  EXPECT_NEAR(bits(text_map({"###..?#"}), text_map({"##...#?"})), expected, 1e-12);  // known in both only
}

/// d of Eq. 2.7 at level 2, by looking at every pair of cells.
double mean_manhattan(const PreparedMap& fixed_map, const PreparedMap& moving_map, const Pose2& fixed_from_moving,
                      CellState state) {
  const MapLevel& fixed = fixed_map.level(2);
  const MapLevel& moving = moving_map.level(2);
  double sum = 0;
  int count = 0;
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      if (moving.state[moving.offset(column, row)] != state) {
        continue;
      }
      const Point2 in_moving = moving.lower_left + moving.resolution_m * Point2{column + 0.5, row + 0.5};
      const Point2 at = 1 / fixed.resolution_m * (fixed_from_moving * in_moving - fixed.lower_left);
      int nearest = std::numeric_limits<int>::max();
      for (int r = 0; r < fixed.height; ++r) {
        for (int c = 0; c < fixed.width; ++c) {
          if (fixed.state[fixed.offset(c, r)] == state) {
            nearest = std::min(nearest, std::abs(c - static_cast<int>(std::floor(at.x_m))) +
                                            std::abs(r - static_cast<int>(std::floor(at.y_m))));
          }
        }
      }
      sum += nearest;
      ++count;
    }
  }
  return sum / count;
}

/// Every cell becomes 4 x 4 cells, so that level 2 shows what was drawn.
OccupancyGrid for_level_2(const OccupancyGrid& drawn) {
  GridGeometry geometry = drawn.geometry;
  geometry.width *= 4;
  geometry.height *= 4;
  OccupancyGrid grid = unknown_grid(geometry);
  for (int row = 0; row < geometry.height; ++row) {
    for (int column = 0; column < geometry.width; ++column) {
      grid.at({column, row}) = drawn.at({column / 4, row / 4});
    }
  }
  return grid;
}

TEST(Evaluator, PsiIsTheSumOfMeanManhattanDistancesBothWays) {
  const Drawn maps(
      for_level_2(text_map({"####....????", "#...........", "#.......####", "#...........", "#....#......",
                            "......#.....", "............", "...........?"},
                           0.05)),
      for_level_2(text_map({"#......#", "........", "........", "..##....", "........", "#......#"}, 0.05)));
  for (const Pose2& pose : {Pose2{}, Pose2{0.23, -0.11, 0.4}, Pose2{-0.6, 0.4, 2}, Pose2{3, 4, -1}, Pose2{-40, 7, 3}}) {
    const Pose2 local = to_local(pose, maps.target, maps.source);
    double expected = 0;
    for (const CellState state : {CellState::kOpen, CellState::kWall}) {
      expected += mean_manhattan(maps.target, maps.source, local, state) +
                  mean_manhattan(maps.source, maps.target, inverse(local), state);
    }
    const Figures f = Evaluator(maps.target, maps.source, {.c_lock = 0.5}).figures(pose);
    EXPECT_NEAR(f.psi_cells, expected, 1e-6);
    EXPECT_NEAR(f.delta, expected + 0.5 * (f.disagreement_cells - f.agreement_cells), 1e-6);  // Eq. 2.5
  }
}

TEST(Evaluator, PsiOfAMapOnItselfIsNothing) {
  const OccupancyGrid grid =
      for_level_2(text_map({"####........", "#...........", "#.......####", "#..........."}, 0.05));
  const Drawn maps(grid, grid);
  EXPECT_EQ(maps.figures().psi_cells, 0);
  EXPECT_NEAR(maps.figures().delta, -1e-3 * 48 * 16, 1e-9);
}

/// A pair of scenes, prepared.
struct Scene {
  worlds::MapPair pair = worlds::make_scene(known_pair("flat"));
  PreparedMap target{pair.target, 0.05};
  PreparedMap source{pair.source, 0.05};

  [[nodiscard]] std::vector<Pose2> poses() const {
    std::vector<Pose2> poses{pair.target_from_source};
    RandomStream random(1, "poses");
    for (int i = 0; i < 12; ++i) {
      const Pose2 local{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-kPi, kPi)};
      poses.push_back(from_local(local, target, source));
    }
    return poses;
  }
};

TEST(Evaluator, WallsAreSortedAsByHandOnAScene) {
  const Scene scene;
  const Evaluator evaluator(scene.target, scene.source, {});
  const MapLevel& level = scene.target.level(0);
  for (const Pose2& pose : scene.poses()) {
    const Pose2 local = to_local(pose, scene.target, scene.source);
    int confirmed = 0;
    int in_free = 0;
    int doubtful = 0;
    for (const WallPoint& wall : scene.source.walls()) {
      const Point2 at = 1 / level.resolution_m * (local * Point2{wall.at.x_m, wall.at.y_m} - level.lower_left);
      doubtful += std::abs(at.x_m - std::round(at.x_m)) < 1e-3 || std::abs(at.y_m - std::round(at.y_m)) < 1e-3;
      const int column = static_cast<int>(std::floor(at.x_m));
      const int row = static_cast<int>(std::floor(at.y_m));
      if (!level.contains(column, row)) {
        continue;
      }
      const double distance_m = level.wall_distance_m[level.offset(column, row)];
      const bool near = distance_m < 0.2 + 1e-4;
      const bool free = level.state[level.offset(column, row)] == CellState::kOpen;
      confirmed += near ? 1 : 0;
      in_free += !near && free && distance_m > 0.25 + 1e-4 ? 1 : 0;
    }
    const Figures f = evaluator.figures(pose);
    EXPECT_NEAR(f.source_in_target.all_m, 0.05 * static_cast<double>(scene.source.walls().size()), 1e-6);
    EXPECT_NEAR(f.source_in_target.confirmed_m, 0.05 * confirmed, 0.05 * doubtful + 1e-6);
    EXPECT_NEAR(f.source_in_target.in_free_m, 0.05 * in_free, 0.05 * doubtful + 1e-6);
    EXPECT_LE(f.source_in_target.same_side_m, f.source_in_target.confirmed_m);
    EXPECT_LT(doubtful, 60);
    EXPECT_NEAR(f.evidence_m, evaluator.evidence_m(pose), 1e-9);
    EXPECT_NEAR(f.evidence_m, evaluator.wall_figures(pose).evidence_m, 1e-9);
  }
}

TEST(Evaluator, StaysWhenTheMapsAreSwappedAndThePoseInverted) {
  const Scene scene;
  const Evaluator forth(scene.target, scene.source, {});
  const Evaluator back(scene.source, scene.target, {});
  for (const Pose2& pose : scene.poses()) {
    const Figures a = forth.figures(pose);
    const Figures b = back.figures(inverse(pose));
    EXPECT_NEAR(a.source_in_target.confirmed_m, b.target_in_source.confirmed_m, 0.101);  // two cells, rounded
    EXPECT_NEAR(a.source_in_target.in_free_m, b.target_in_source.in_free_m, 0.101);
    EXPECT_NEAR(a.target_in_source.same_side_m, b.source_in_target.same_side_m, 0.02 * a.target_in_source.all_m);
    EXPECT_NEAR(a.evidence_m, b.evidence_m, 0.02 * a.target_in_source.all_m);
    EXPECT_NEAR(a.psi_cells, b.psi_cells, 0.02 * (1 + a.psi_cells));
    // Cells are read at the nearest cell of the other map: turned, some are read twice and some not at all.
    EXPECT_NEAR(a.overlap_area_m2, b.overlap_area_m2, 0.02 * (1 + a.overlap_area_m2));
    EXPECT_NEAR(a.acceptance_index, b.acceptance_index, 0.02);
    EXPECT_NEAR(a.mutual_information_bit, b.mutual_information_bit, 0.05);
  }
}

TEST(Evaluator, TellsOfARivalWhatItTellsOfTheBestPose) {
  const Scene scene;
  const Evaluator evaluator(scene.target, scene.source, {});
  for (const Pose2& pose : scene.poses()) {
    const Figures all = evaluator.figures(pose);
    const Figures some = evaluator.rival_figures(pose);
    EXPECT_EQ(some.evidence_m, all.evidence_m);
    EXPECT_EQ(some.conflict_share, all.conflict_share);
    EXPECT_EQ(some.elastic_evidence_m, all.elastic_evidence_m);
    EXPECT_EQ(some.elastic_conflict_share, all.elastic_conflict_share);
    EXPECT_EQ(some.elastic_roughness_m, all.elastic_roughness_m);
    EXPECT_NEAR(some.overlap_area_m2, all.overlap_area_m2, 0.3 + 0.03 * all.overlap_area_m2);
    EXPECT_NEAR(some.overlap_share, all.overlap_share, 0.02);
  }
}

TEST(Evaluator, TheTruthStandsOutOfChance) {
  const Scene scene;
  const Evaluator evaluator(scene.target, scene.source, {});
  const RandomLevel level = evaluator.random_level(1);
  EXPECT_EQ(level.poses, EvaluatorOptions{}.random_poses);
  EXPECT_GT(level.deviation_m, 0);
  const double truth = evaluator.evidence_m(scene.pair.target_from_source);
  EXPECT_GT(truth, level.mean_m + 3 * level.deviation_m);
  for (const Pose2& pose : scene.poses()) {
    EXPECT_LE(evaluator.evidence_m(pose), truth);
  }
}

TEST(Evaluator, RandomLevelDependsOnTheSeedAlone) {
  const Scene scene;
  const Evaluator evaluator(scene.target, scene.source, {});
  const RandomLevel once = evaluator.random_level(5);
  const RandomLevel again = Evaluator(scene.target, scene.source, {}).random_level(5);
  EXPECT_EQ(once.mean_m, again.mean_m);
  EXPECT_EQ(once.deviation_m, again.deviation_m);
  EXPECT_NE(once.mean_m, evaluator.random_level(6).mean_m);
  EXPECT_EQ(Evaluator(scene.target, scene.source, {.random_poses = 7}).random_level(5).poses, 7);
}

TEST(Evaluator, RandomLevelOfMapsWithoutWallsIsNothing) {
  const Drawn maps(text_map({"..."}), text_map({"#.."}));
  const RandomLevel level = maps.evaluator().random_level(1);
  EXPECT_EQ(level.poses, 0);
  EXPECT_EQ(level.mean_m, 0);
  EXPECT_EQ(level.deviation_m, 0);
}

TEST(Evaluator, SomeOfTheWallsTellNearlyWhatAllOfThemDo) {
  const Scene scene;
  const Evaluator all(scene.target, scene.source, {.max_points = 1000000});
  const Evaluator some(scene.target, scene.source, {.max_points = 800});
  ASSERT_GT(scene.source.walls().size(), 1600U);
  for (const Pose2& pose : scene.poses()) {
    const Figures a = all.wall_figures(pose);
    const Figures b = some.wall_figures(pose);
    const double walls_m = a.source_in_target.all_m;
    EXPECT_NEAR(b.source_in_target.all_m, walls_m, 0.3);
    EXPECT_NEAR(b.source_in_target.confirmed_m, a.source_in_target.confirmed_m, 0.06 * walls_m);
    EXPECT_NEAR(b.source_in_target.in_free_m, a.source_in_target.in_free_m, 0.06 * walls_m);
    EXPECT_NEAR(b.source_in_target.same_side_m, a.source_in_target.same_side_m, 0.06 * walls_m);
  }
}

TEST(Evaluator, StaysFiniteForPosesFarOff) {
  const Drawn maps(text_map({"####", "#..."}, 0.05), text_map({"#...", "####"}, 0.05));
  for (const Pose2& pose : {Pose2{1e6, 0, 0}, Pose2{-1e12, 1e12, 1}, Pose2{0, 1e30, 2}}) {
    const Figures f = maps.figures(pose);
    for (const auto& [name, value] : f.named()) {
      EXPECT_TRUE(std::isfinite(value)) << name;
    }
    EXPECT_EQ(f.overlap_area_m2, 0);
    EXPECT_EQ(f.evidence_m, 0);
  }
}

TEST(Evaluator, NamesEveryFigureOnce) {
  std::set<std::string> names;
  for (const auto& [name, value] : Figures{}.named()) {
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(value, 0) << name;
    EXPECT_THAT(name, testing::MatchesRegex("[a-z][a-z0-9_]*"));
  }
}

TEST(Evaluator, RefusesOptionsOutOfRange) {
  const Drawn maps(text_map({"#."}), text_map({"#."}));
  EXPECT_THROW(Evaluator(maps.target, maps.source, {.tolerance_m = 0}), std::invalid_argument);
  EXPECT_THROW(Evaluator(maps.target, maps.source, {.random_poses = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
