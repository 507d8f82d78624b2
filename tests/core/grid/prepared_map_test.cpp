#include "gridmerge/grid/prepared_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

constexpr int kMargin = 16;  // cells of unknown round what is known

/// Noise with every kind of cell; `wall_share` of them occupied.
OccupancyGrid noise(int width, int height, std::uint64_t seed, double wall_share = 0.1, double resolution_m = 0.05) {
  RandomStream random(seed, "noise");
  OccupancyGrid grid = unknown_grid({.width = width,
                                     .height = height,
                                     .resolution_m = resolution_m,
                                     .map_from_grid = {random.uniform(-9, 9), random.uniform(-9, 9), 0.7}});
  for (std::int8_t& cell : grid.cells) {
    const double what = random.uniform();
    cell = what < wall_share ? static_cast<std::int8_t>(65 + random.below(36))
                             : static_cast<std::int8_t>(static_cast<int>(random.below(66)) - 1);
  }
  return grid;
}

/// State of the cell of level 0 that covers a point of the map frame.
CellState state_at(const PreparedMap& map, Point2 in_map) {
  const MapLevel& level = map.level(0);
  const Point2 local = inverse(map.map_from_local()) * in_map;
  const int column = static_cast<int>(std::floor((local.x_m - level.lower_left.x_m) / level.resolution_m));
  const int row = static_cast<int>(std::floor((local.y_m - level.lower_left.y_m) / level.resolution_m));
  return level.contains(column, row) ? level.state[level.offset(column, row)] : CellState::kUnseen;
}

void expect_same(const PreparedMap& a, const PreparedMap& b) {
  EXPECT_EQ(a.map_from_local(), b.map_from_local());
  EXPECT_EQ(a.resolution_m(), b.resolution_m());
  EXPECT_EQ(a.radius_m(), b.radius_m());
  EXPECT_EQ(a.known_cells(), b.known_cells());
  EXPECT_EQ(a.occupancy(), b.occupancy());
  ASSERT_EQ(a.walls().size(), b.walls().size());
  for (std::size_t i = 0; i < a.walls().size(); ++i) {
    EXPECT_EQ(a.walls()[i].at.x_m, b.walls()[i].at.x_m);
    EXPECT_EQ(a.walls()[i].at.y_m, b.walls()[i].at.y_m);
    EXPECT_EQ(a.walls()[i].free_normal.x_m, b.walls()[i].free_normal.x_m);
    EXPECT_EQ(a.walls()[i].free_normal.y_m, b.walls()[i].free_normal.y_m);
  }
  for (int k = 0; k < PreparedMap::kLevels; ++k) {
    EXPECT_EQ(a.level(k).width, b.level(k).width);
    EXPECT_EQ(a.level(k).state, b.level(k).state) << "level " << k;
    EXPECT_EQ(a.level(k).wall_distance_m, b.level(k).wall_distance_m) << "level " << k;
  }
}

TEST(PreparedMap, LocalOriginIsTheCentreOfTheKnownCells) {
  const OccupancyGrid grid = text_map({"????????", "?##..???", "?#...???", "????????"}, 0.1, {3, -2, 0.6});
  const PreparedMap map(grid, 0.1);
  const Point2 expected = centre_of_known(grid);
  EXPECT_NEAR(map.centre_in_map().x_m, expected.x_m, 1e-12);
  EXPECT_NEAR(map.centre_in_map().y_m, expected.y_m, 1e-12);
  EXPECT_EQ(map.map_from_local().theta_rad, 0.6);
  EXPECT_EQ(map.known_cells(), 8U);
  EXPECT_NEAR(map.known_area_m2(), 0.08, 1e-12);
  EXPECT_NEAR(map.radius_m(), std::hypot(0.15, 0.05), 1e-9);
}

TEST(PreparedMap, WallsLieWhereTheGridHasThem) {
  const OccupancyGrid grid = noise(50, 31, 1);
  const PreparedMap map(grid, grid.geometry.resolution_m);
  std::size_t next = 0;  // walls come row by row, as cells do
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      if (grid.at({column, row}) >= 65) {
        ASSERT_LT(next, map.walls().size());
        const Point2f at = map.walls()[next++].at;
        const Point2 off = map.map_from_local() * Point2{at.x_m, at.y_m} - grid.geometry.cell_centre({column, row});
        ASSERT_LT(norm(off), 1e-6) << column << ", " << row;
      }
    }
  }
  EXPECT_EQ(next, map.walls().size());
}

TEST(PreparedMap, IsCroppedToWhatIsKnownWithAMargin) {
  OccupancyGrid grid = unknown_grid({.width = 300, .height = 200, .resolution_m = 0.05, .map_from_grid = {}});
  for (int row = 60; row < 63; ++row) {
    for (int column = 120; column < 125; ++column) {
      grid.at({column, row}) = static_cast<std::int8_t>(column == 120 ? 100 : 0);
    }
  }
  const PreparedMap map(grid, 0.05);
  const MapLevel& level = map.level(0);
  EXPECT_EQ(level.width, 5 + 2 * kMargin);
  EXPECT_EQ(level.height, 3 + 2 * kMargin);
  for (int row = 0; row < level.height; ++row) {
    for (int column = 0; column < level.width; ++column) {
      const bool known = column >= kMargin && column < kMargin + 5 && row >= kMargin && row < kMargin + 3;
      const CellState expected = !known ? CellState::kUnseen : column == kMargin ? CellState::kWall : CellState::kOpen;
      ASSERT_EQ(level.state[level.offset(column, row)], expected) << column << ", " << row;
    }
  }
}

TEST(PreparedMap, KnowsAMapThatFillsItsGridToTheRim) {
  const PreparedMap map(text_map({"###", "#.#", "###"}, 0.05), 0.05);
  EXPECT_EQ(map.level(0).width, 3 + 2 * kMargin);
  EXPECT_EQ(map.known_cells(), 9U);
  EXPECT_EQ(map.walls().size(), 8U);
}

TEST(PreparedMap, LevelsShareTheirLowerLeftCorner) {
  const PreparedMap map(noise(77, 45, 2), 0.05);
  for (int k = 1; k < PreparedMap::kLevels; ++k) {
    const MapLevel& fine = map.level(k - 1);
    const MapLevel& coarse = map.level(k);
    EXPECT_EQ(coarse.lower_left, fine.lower_left);
    EXPECT_EQ(coarse.resolution_m, 2 * fine.resolution_m);
    EXPECT_EQ(coarse.width, (fine.width + 1) / 2);
    EXPECT_EQ(coarse.height, (fine.height + 1) / 2);
  }
}

TEST(PreparedMap, ACoarseCellIsTheMostOccupiedOfItsFourFineOnes) {
  const PreparedMap map(noise(77, 45, 3, 0.03), 0.05);
  for (int k = 1; k < PreparedMap::kLevels; ++k) {
    const MapLevel& fine = map.level(k - 1);
    const MapLevel& coarse = map.level(k);
    for (int row = 0; row < coarse.height; ++row) {
      for (int column = 0; column < coarse.width; ++column) {
        CellState expected = CellState::kUnseen;
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          if (fine.contains(2 * column + dx, 2 * row + dy)) {
            expected = std::max(expected, fine.state[fine.offset(2 * column + dx, 2 * row + dy)]);
          }
        }
        ASSERT_EQ(coarse.state[coarse.offset(column, row)], expected) << "level " << k;
      }
    }
  }
}

TEST(PreparedMap, OccupancyIsKeptAndThresholdsAreSharp) {
  OccupancyGrid grid = unknown_grid({.width = 102, .height = 1, .resolution_m = 0.05, .map_from_grid = {}});
  for (int percent = -1; percent <= 100; ++percent) {
    grid.at({percent + 1, 0}) = static_cast<std::int8_t>(percent);
  }
  const PreparedMap map(grid, 0.05, {.occupied_percent = 70, .free_percent = 30});
  for (int percent = 0; percent <= 100; ++percent) {
    const std::size_t at = map.level(0).offset(kMargin + percent, kMargin);  // the first cell is unknown: cropped
    ASSERT_EQ(map.occupancy()[at], percent);
    ASSERT_EQ(map.level(0).state[at], percent >= 70   ? CellState::kWall
                                      : percent <= 30 ? CellState::kOpen
                                                      : CellState::kUnseen)
        << percent;
  }
  EXPECT_EQ(map.known_cells(), 31U + 31U);
}

TEST(PreparedMap, WallDistancesEqualBruteForceAtEveryLevel) {
  const PreparedMap map(noise(40, 33, 4, 0.01), 0.05);
  for (int k = 0; k < PreparedMap::kLevels; ++k) {
    const MapLevel& level = map.level(k);
    for (int row = 0; row < level.height; ++row) {
      for (int column = 0; column < level.width; ++column) {
        double nearest = std::numeric_limits<double>::infinity();
        for (int r = 0; r < level.height; ++r) {
          for (int c = 0; c < level.width; ++c) {
            if (level.state[level.offset(c, r)] == CellState::kWall) {
              nearest = std::min(nearest, level.resolution_m * std::hypot(c - column, r - row));
            }
          }
        }
        ASSERT_NEAR(level.wall_distance_m[level.offset(column, row)], nearest, 1e-5 * (1 + nearest)) << "level " << k;
      }
    }
  }
}

TEST(PreparedMap, WithoutWallsEverythingIsFarFromThem) {
  const PreparedMap map(text_map({"...", "..."}, 0.05), 0.05);
  EXPECT_TRUE(map.walls().empty());
  EXPECT_THAT(map.level(0).wall_distance_m, testing::Each(kFarFromWalls));
}

/// The normal of the wall at that cell of a drawn map.
Point2f normal_at(const OccupancyGrid& grid, CellIndex cell) {
  const PreparedMap map(grid, grid.geometry.resolution_m);
  const Point2 local = inverse(map.map_from_local()) * grid.geometry.cell_centre(cell);
  for (const WallPoint& wall : map.walls()) {
    if (std::hypot(wall.at.x_m - local.x_m, wall.at.y_m - local.y_m) < 1e-4) {
      return wall.free_normal;
    }
  }
  ADD_FAILURE() << "no wall there";
  return {};
}

TEST(PreparedMap, FreeNormalsPointFromTheWallToWhereItWasSeenFrom) {
  const OccupancyGrid seen_from_below =
      text_map({"???????", "???????", "#######", ".......", ".......", "......."}, 0.05, {5, 5, 1});
  const Point2f down = normal_at(seen_from_below, {3, 3});
  EXPECT_NEAR(down.x_m, 0, 1e-6);
  EXPECT_NEAR(down.y_m, -1, 1e-6);
  const OccupancyGrid seen_from_the_left = text_map({"...#???", "...#???", "...#???", "...#???", "...#???"}, 0.05);
  const Point2f left = normal_at(seen_from_the_left, {3, 2});
  EXPECT_NEAR(left.x_m, -1, 1e-6);
  EXPECT_NEAR(left.y_m, 0, 1e-6);
  const OccupancyGrid inner_corner = text_map({"#####", "#....", "#....", "#....", "#...."}, 0.05);
  const Point2f diagonal = normal_at(inner_corner, {0, 4});
  EXPECT_NEAR(diagonal.x_m, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(diagonal.y_m, -std::sqrt(0.5), 1e-6);
}

TEST(PreparedMap, ThereIsNoFreeNormalWhereAWallWasSeenFromAllSidesOrNone) {
  const OccupancyGrid post = text_map({".......", ".......", ".......", "...#...", ".......", ".......", "......."});
  const OccupancyGrid both_sides = text_map({".......", ".......", "#######", ".......", "......."});
  const OccupancyGrid inside = text_map({"#########", "#########", "#########", "#########"});
  for (const auto& [grid, cell] :
       {std::pair{post, CellIndex{3, 3}}, {both_sides, CellIndex{3, 2}}, {inside, CellIndex{4, 2}}}) {
    const Point2f none = normal_at(grid, cell);
    EXPECT_EQ(none.x_m, 0) << to_text(grid);
    EXPECT_EQ(none.y_m, 0) << to_text(grid);
  }
}

TEST(PreparedMap, NormalsHaveLengthOneOrNone) {
  const worlds::MapPair pair = worlds::make_scene(known_pair("flat"));
  const PreparedMap map(pair.target, 0.05);
  std::size_t sided = 0;
  for (const WallPoint& wall : map.walls()) {
    const double length = std::hypot(wall.free_normal.x_m, wall.free_normal.y_m);
    ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-5) << length;
    sided += length > 0 ? 1 : 0;
  }
  EXPECT_GT(sided, map.walls().size() * 8 / 10);
}

TEST(PreparedMap, AtACoarserResolutionNoWallIsLostAndNoGapOpens) {
  for (const auto& [from_m, to_m] : {std::pair{0.04, 0.05}, {0.03, 0.05}, {0.05, 0.12}, {0.05, 0.05}}) {
    OccupancyGrid grid =
        unknown_grid({.width = 140, .height = 90, .resolution_m = from_m, .map_from_grid = {-4, 7, 2.5}});
    for (int row = 0; row < 90; ++row) {
      for (int column = 0; column < 140; ++column) {
        const bool rim = row == 0 || column == 0 || row == 89 || column == 139;
        const bool diagonal = row == column;
        grid.at({column, row}) = rim || diagonal ? kOccupied : kFree;
      }
    }
    const PreparedMap map(grid, to_m);
    std::size_t walls_hit = 0;
    for (int row = 0; row < 90; ++row) {
      for (int column = 0; column < 140; ++column) {
        // A centre may fall on the edge between two coarser cells: either may have it.
        const Point2 centre = grid.geometry.cell_centre({column, row});
        CellState state = CellState::kUnseen;
        for (const auto& [dx, dy] : {std::pair{1e-6, 1e-6}, {1e-6, -1e-6}, {-1e-6, 1e-6}, {-1e-6, -1e-6}}) {
          state = std::max(state, state_at(map, centre + Point2{dx, dy}));
        }
        ASSERT_NE(state, CellState::kUnseen) << from_m << " -> " << to_m << ": " << column << ", " << row;
        if (grid.at({column, row}) == kOccupied) {
          ASSERT_EQ(state, CellState::kWall) << from_m << " -> " << to_m << ": " << column << ", " << row;
          ++walls_hit;
        }
      }
    }
    EXPECT_LE(map.walls().size(), walls_hit);
    // Nothing is known that was not: the area grows by a cell at the rim at the most.
    const double width_m = 140 * from_m;
    const double height_m = 90 * from_m;
    EXPECT_GE(map.known_area_m2(), (width_m - to_m) * (height_m - to_m));
    EXPECT_LE(map.known_area_m2(), (width_m + to_m) * (height_m + to_m));
  }
}

TEST(PreparedMap, LocalPosesAndMapPosesAreEachOthersInverse) {
  const PreparedMap target(noise(30, 40, 5), 0.05);
  const PreparedMap source(noise(35, 20, 6), 0.05);
  RandomStream random(1, "poses");
  for (int i = 0; i < 20; ++i) {
    const Pose2 pose{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-kPi, kPi)};
    const Pose2 local = to_local(pose, target, source);
    const PoseDifference back = difference_at(source.centre_in_map(), from_local(local, target, source), pose);
    EXPECT_LT(back.distance_m, 1e-9);
    EXPECT_LT(back.angle_rad, 1e-9);
    // Once through the local frames, once through the map frames.
    const Point2 in_source{random.uniform(-5, 5), random.uniform(-5, 5)};
    const Point2 one_way = target.map_from_local() * (local * in_source);
    const Point2 other_way = pose * (source.map_from_local() * in_source);
    EXPECT_LT(norm(one_way - other_way), 1e-9);
  }
}

TEST(PreparedMap, KnowsNothingOfEmptyAndOfUnknownMaps) {
  const OccupancyGrid empty = unknown_grid({.width = 0, .height = 0, .resolution_m = 0.05, .map_from_grid = {}});
  const OccupancyGrid line = unknown_grid({.width = 0, .height = 7, .resolution_m = 0.05, .map_from_grid = {}});
  const OccupancyGrid unknown = text_map({"????", "????"}, 0.05, {1, 2, 3});
  const OccupancyGrid undecided = text_map({"4444", "5555"}, 0.05, {1, 2, 3});
  for (const OccupancyGrid& grid : {empty, line, unknown, undecided}) {
    const PreparedMap map(grid, 0.05);
    EXPECT_EQ(map.known_cells(), 0U);
    EXPECT_EQ(map.known_area_m2(), 0);
    EXPECT_EQ(map.radius_m(), 0);
    EXPECT_TRUE(map.walls().empty());
    EXPECT_TRUE(std::isfinite(map.centre_in_map().x_m) && std::isfinite(map.centre_in_map().y_m));
    for (int k = 0; k < PreparedMap::kLevels; ++k) {
      EXPECT_THAT(map.level(k).state, testing::Each(CellState::kUnseen));
    }
  }
}

TEST(PreparedMap, AMapMayBeASingleCell) {
  const OccupancyGrid grid = text_map({"#"}, 0.05, {10, 20, 1});
  const PreparedMap map(grid, 0.05);
  ASSERT_EQ(map.walls().size(), 1U);
  EXPECT_EQ(map.known_cells(), 1U);
  EXPECT_NEAR(map.radius_m(), 0, 1e-9);
  EXPECT_LT(norm(map.centre_in_map() - grid.geometry.cell_centre({0, 0})), 1e-9);
  EXPECT_NEAR(map.walls()[0].at.x_m, 0, 1e-6);
  EXPECT_NEAR(map.walls()[0].at.y_m, 0, 1e-6);
  EXPECT_EQ(PreparedMap(text_map({"."}, 0.05), 0.05).known_cells(), 1U);
}

TEST(PreparedMap, RefusesWhatIsOutOfRange) {
  const OccupancyGrid grid = text_map({"#."}, 0.05);
  EXPECT_THROW(PreparedMap(grid, 0.049), std::invalid_argument);  // finer than the grid
  EXPECT_THROW(PreparedMap(grid, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(PreparedMap(grid, std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(PreparedMap(grid, 0.05, {.occupied_percent = 0}), std::invalid_argument);
  EXPECT_THROW(PreparedMap(grid, 0.05, {.occupied_percent = 101}), std::invalid_argument);
  EXPECT_THROW(PreparedMap(grid, 0.05, {.occupied_percent = 50, .free_percent = 50}), std::invalid_argument);
  EXPECT_THROW(PreparedMap(grid, 0.05, {.finest_resolution_m = 0}), std::invalid_argument);
}

TEST(PreparedMap, IsTheSameAtAnyNumberOfThreads) {
  const OccupancyGrid grid = noise(90, 300, 7);
  const PreparedMap one(grid, 0.06, {}, 1);
  for (const int threads : {0, 2, 4, 9}) {
    SCOPED_TRACE(threads);
    expect_same(one, PreparedMap(grid, 0.06, {}, threads));
  }
}

TEST(PreparedMap, LosesNothingHoweverFarOffTheOriginLies) {
  OccupancyGrid near = noise(60, 40, 8);
  OccupancyGrid far = near;
  near.geometry.map_from_grid = {0, 0, 0.5};
  far.geometry.map_from_grid = {1e6, -1e6, 0.5};
  const PreparedMap here(near, 0.05);
  const PreparedMap there(far, 0.05);
  EXPECT_EQ(here.level(0).lower_left, there.level(0).lower_left);
  EXPECT_EQ(here.level(0).wall_distance_m, there.level(0).wall_distance_m);
  ASSERT_EQ(here.walls().size(), there.walls().size());
  for (std::size_t i = 0; i < here.walls().size(); ++i) {
    EXPECT_EQ(here.walls()[i].at.x_m, there.walls()[i].at.x_m);
    EXPECT_EQ(here.walls()[i].at.y_m, there.walls()[i].at.y_m);
  }
  const Pose2 pose{-1e6, 1e6, 0.1};
  const PoseDifference back =
      difference_at(there.centre_in_map(), from_local(to_local(pose, here, there), here, there), pose);
  EXPECT_LT(back.distance_m, 1e-6);
  EXPECT_LT(back.angle_rad, 1e-12);
}

TEST(PreparedMap, CommonResolutionIsTheCoarsest) {
  const OccupancyGrid fine = text_map({"#"}, 0.02);
  const OccupancyGrid coarse = text_map({"#"}, 0.1);
  EXPECT_EQ(common_resolution_m(fine, fine, {}), 0.05);
  EXPECT_EQ(common_resolution_m(fine, coarse, {}), 0.1);
  EXPECT_EQ(common_resolution_m(coarse, fine, {.finest_resolution_m = 0.2}), 0.2);
}

/// The grid seen in a mirror along its x axis.
OccupancyGrid flipped(const OccupancyGrid& grid) {
  OccupancyGrid other = grid;
  for (int row = 0; row < grid.geometry.height; ++row) {
    for (int column = 0; column < grid.geometry.width; ++column) {
      other.at({column, grid.geometry.height - 1 - row}) = grid.at({column, row});
    }
  }
  return other;
}

TEST(PreparedMap, MirroredIsThePreparedMirrorImage) {
  const OccupancyGrid grid = worlds::make_scene(known_pair("flat")).target;
  const PreparedMap map(grid, 0.05);
  const PreparedMap mirrored = map.mirrored();
  const PreparedMap expected(flipped(grid), 0.05);
  EXPECT_EQ(mirrored.level(0).state, expected.level(0).state);
  EXPECT_EQ(mirrored.level(0).wall_distance_m, expected.level(0).wall_distance_m);
  EXPECT_NEAR(mirrored.level(0).lower_left.y_m, expected.level(0).lower_left.y_m, 1e-9);
  EXPECT_EQ(mirrored.occupancy(), expected.occupancy());
  EXPECT_NEAR(mirrored.radius_m(), expected.radius_m(), 1e-6);
  ASSERT_EQ(mirrored.walls().size(), expected.walls().size());
  for (std::size_t i = 0; i < expected.walls().size(); ++i) {
    ASSERT_NEAR(mirrored.walls()[i].at.x_m, expected.walls()[i].at.x_m, 1e-4) << i;
    ASSERT_NEAR(mirrored.walls()[i].at.y_m, expected.walls()[i].at.y_m, 1e-4) << i;
    ASSERT_NEAR(mirrored.walls()[i].free_normal.y_m, expected.walls()[i].free_normal.y_m, 1e-3) << i;
  }
}

TEST(PreparedMap, MirroredFromALevelOnLacksTheFinerOnesAlone) {
  const PreparedMap map(worlds::make_scene(known_pair("flat")).source, 0.05);
  const PreparedMap all = map.mirrored();
  const PreparedMap some = map.mirrored(2);
  EXPECT_TRUE(some.level(0).state.empty());
  EXPECT_TRUE(some.level(1).state.empty());
  EXPECT_TRUE(some.occupancy().empty());
  for (int level = 2; level < PreparedMap::kLevels; ++level) {
    EXPECT_EQ(some.level(level).state, all.level(level).state) << level;
    EXPECT_EQ(some.level(level).wall_distance_m, all.level(level).wall_distance_m) << level;
  }
  EXPECT_EQ(some.walls().size(), all.walls().size());
  EXPECT_EQ(some.radius_m(), all.radius_m());
}

TEST(PreparedMap, MirroredTwiceIsTheMapItself) {
  const PreparedMap map(worlds::make_scene(known_pair("flat")).source, 0.05);
  const PreparedMap twice = map.mirrored().mirrored();
  for (int level = 0; level < PreparedMap::kLevels; ++level) {
    EXPECT_EQ(twice.level(level).state, map.level(level).state) << level;
    EXPECT_NEAR(twice.level(level).lower_left.y_m, map.level(level).lower_left.y_m, 1e-9) << level;
  }
  EXPECT_EQ(twice.walls().size(), map.walls().size());
  const PreparedMap nothing(unknown_grid({.width = 3, .height = 2, .resolution_m = 1, .map_from_grid = {}}), 1);
  EXPECT_EQ(nothing.mirrored().known_cells(), 0U);
}

}  // namespace
}  // namespace gridmerge
