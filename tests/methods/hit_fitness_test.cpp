#include "methods/genetic/hit_fitness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

constexpr int kOccupiedFrom = 65;

/// Noise with every kind of cell, in a frame that is turned against the cells.
OccupancyGrid noise(int width, int height, std::uint64_t seed) {
  RandomStream random(seed, "noise");
  OccupancyGrid grid =
      unknown_grid({.width = width,
                    .height = height,
                    .resolution_m = 0.05,
                    .map_from_grid = {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)}});
  for (std::int8_t& cell : grid.cells) {
    cell = static_cast<std::int8_t>(static_cast<int>(random.below(102)) - 1);
  }
  return grid;
}

PreparedMap prepared(const OccupancyGrid& grid) {
  return PreparedMap(grid, grid.geometry.resolution_m, {.occupied_percent = kOccupiedFrom});
}

struct Count {
  std::int64_t sum = 0;
  std::int64_t doubtful = 0;  ///< the most by which rounding may change it: cells that fall on the edge of a cell
};

/// Eq. 3.5 and 3.6 word by word, in double precision, on the grids themselves.
Count count_by_hand(const OccupancyGrid& target, const OccupancyGrid& source, const Pose2& target_from_source) {
  const auto value = [&](Point2 in_map) {
    const CellIndex cell = target.geometry.cell_at(in_map);
    const int percent = target.geometry.contains(cell) ? target.at(cell) : kUnknown;
    return percent >= kOccupiedFrom ? percent : 0;
  };
  const double reach = 1e-3 * target.geometry.resolution_m;
  Count count;
  for (int row = 0; row < source.geometry.height; ++row) {
    for (int column = 0; column < source.geometry.width; ++column) {
      if (source.at({column, row}) < kOccupiedFrom) {
        continue;
      }
      const Point2 at = target_from_source * source.geometry.cell_centre({column, row});
      const int here = value(at);
      count.sum += here;
      for (const Point2 beside :
           {Point2{reach, reach}, Point2{reach, -reach}, Point2{-reach, reach}, Point2{-reach, -reach}}) {
        if (value(at + beside) != here) {
          count.doubtful += kOccupied;
          break;
        }
      }
    }
  }
  return count;
}

TEST(HitFitness, EqualsACountByHandAtRandomPoses) {
  RandomStream random(1, "poses");
  for (std::uint64_t map = 0; map < 6; ++map) {
    const OccupancyGrid target = noise(40 + static_cast<int>(17 * map), 75, 2 * map);
    const OccupancyGrid source = noise(61, 33 + static_cast<int>(9 * map), 2 * map + 1);
    const PreparedMap prepared_target = prepared(target);
    const PreparedMap prepared_source = prepared(source);
    const HitFitness fitness(prepared_target, prepared_source);
    int touching = 0;
    for (int i = 0; i < 60; ++i) {
      const Pose2 local{random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-kPi, kPi)};
      const Pose2 pose = from_local(local, prepared_target, prepared_source);
      const Count expected = count_by_hand(target, source, pose);
      EXPECT_LE(std::abs(fitness(pose) - expected.sum), expected.doubtful) << "map " << map << ", pose " << i;
      EXPECT_LT(expected.doubtful, 3000);
      touching += expected.sum > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 20);
  }
}

TEST(HitFitness, IsTheNumberOfOccupiedCellsWhereAMapLiesOnItself) {
  OccupancyGrid grid = noise(83, 59, 3);
  std::int64_t occupied = 0;
  for (std::int8_t& cell : grid.cells) {
    cell = cell >= kOccupiedFrom ? kOccupied : kFree;
    occupied += cell == kOccupied ? 1 : 0;
  }
  OccupancyGrid turned = grid;
  turned.geometry.map_from_grid = {100, -70, 2};
  const HitFitness fitness(prepared(turned), prepared(grid));
  EXPECT_EQ(static_cast<std::int64_t>(fitness.cell_count()), occupied);
  const Pose2 truth = turned.geometry.map_from_grid * inverse(grid.geometry.map_from_grid);
  EXPECT_EQ(fitness(truth), occupied * kOccupied);
  EXPECT_LT(fitness(truth * Pose2{0.2, 0, 0.3}), occupied * kOccupied / 2);
}

TEST(HitFitness, AddsTheTargetsOccupancyAndOnlyWhereItIsOccupied) {
  OccupancyGrid target = unknown_grid({.width = 20, .height = 20, .resolution_m = 0.1, .map_from_grid = {}});
  OccupancyGrid source = target;
  target.at({5, 5}) = 80;
  target.at({6, 5}) = 64;  // not quite occupied
  target.at({7, 5}) = kOccupied;
  source.at({5, 5}) = kOccupied;
  source.at({6, 5}) = kOccupied;
  source.at({7, 5}) = 70;
  source.at({8, 5}) = kOccupied;
  EXPECT_EQ(HitFitness(prepared(target), prepared(source))({}), 80 + 100);
  EXPECT_EQ(HitFitness(prepared(source), prepared(target))({}), 100 + 70);
}

TEST(HitFitness, IsZeroWhereTheMapsLieApartHoweverFar) {
  const OccupancyGrid grid = noise(30, 30, 4);
  const HitFitness fitness(prepared(grid), prepared(grid));
  for (const double far_m : {30.0, 1e4, 1e12}) {
    for (const Pose2 pose : {Pose2{far_m, 0, 1}, Pose2{-far_m, far_m, -2}, Pose2{0, -far_m, 3}}) {
      EXPECT_EQ(fitness(pose), 0) << far_m;
    }
  }
}

TEST(HitFitness, IsZeroWithoutOccupiedCells) {
  const OccupancyGrid some = noise(30, 30, 5);
  const OccupancyGrid none = unknown_grid(some.geometry);
  EXPECT_EQ(HitFitness(prepared(none), prepared(some))({}), 0);
  EXPECT_EQ(HitFitness(prepared(some), prepared(none))({}), 0);
}

}  // namespace
}  // namespace gridmerge
