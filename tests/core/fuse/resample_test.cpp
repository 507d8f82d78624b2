#include "gridmerge/fuse/resample.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "support/text_map.hpp"

namespace gridmerge {
namespace {

constexpr int kSide = 41;  // cells of the grid that maps are read into; its centre is the origin

GridGeometry target_geometry() { return {kSide, kSide, 0.1, {-2.05, -2.05, 0}}; }

/// A free map round the origin, larger than the target at any turn, with walls where `is_wall` says, given the column
/// and row from the map's middle.
OccupancyGrid free_map(double resolution_m, const std::function<bool(int, int)>& is_wall) {
  const int half = static_cast<int>(3.2 / resolution_m);
  const int side = 2 * half + 1;
  const double corner_m = -0.5 * side * resolution_m;
  OccupancyGrid map = unknown_grid({side, side, resolution_m, {corner_m, corner_m, 0}});
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      map.at({column, row}) = is_wall(column - half, row - half) ? kOccupied : kFree;
    }
  }
  return map;
}

/// The cells reached from `start` over cells of that value, in steps to 4 or 8 neighbours.
OccupancyGrid flood(const OccupancyGrid& grid, CellIndex start, bool corners) {
  OccupancyGrid reached = unknown_grid(grid.geometry);
  std::vector<CellIndex> open{start};
  while (!open.empty()) {
    const CellIndex cell = open.back();
    open.pop_back();
    if (!grid.geometry.contains(cell) || reached.at(cell) != kUnknown || grid.at(cell) != grid.at(start)) {
      continue;
    }
    reached.at(cell) = kFree;
    for (const int row : {-1, 0, 1}) {
      for (const int column : {-1, 0, 1}) {
        if (corners || row == 0 || column == 0) {
          open.push_back({cell.column + column, cell.row + row});
        }
      }
    }
  }
  return reached;
}

/// Whether steps over free cells lead from one side of a wall through the middle to the other.
bool leaks(const OccupancyGrid& grid, double wall_angle_rad, bool corners) {
  const Point2 across{-1.5 * std::sin(wall_angle_rad), 1.5 * std::cos(wall_angle_rad)};
  const CellIndex there = grid.geometry.cell_at(-1.0 * across);
  return flood(grid, grid.geometry.cell_at(across), corners).at(there) != kUnknown;
}

TEST(Resampling, KeepsAThinWallTightAtAnyTurnAndResolution) {
  for (const double resolution_m : {0.03, 0.05, 0.09, 0.1, 0.13, 0.2, 0.31}) {
    const OccupancyGrid map = free_map(resolution_m, [](int, int row) { return row == 0; });
    for (int turn_deg = 0; turn_deg <= 180; turn_deg += 5) {
      for (const double shift_m : {0.0, 0.017, 0.05}) {
        const double turn = radians(turn_deg);
        const OccupancyGrid read = resample({&map, {shift_m, shift_m, turn}}, target_geometry());
        ASSERT_FALSE(leaks(read, turn, true)) << resolution_m << " m, " << turn_deg << " deg\n" << to_text(read);
        const auto walls = std::count(read.cells.begin(), read.cells.end(), kOccupied);
        const double length = kSide / std::max(std::abs(std::cos(turn)), std::abs(std::sin(turn)));
        ASSERT_LE(static_cast<double>(walls), length * (1.75 + resolution_m / 0.1)) << to_text(read);
      }
    }
  }
}

TEST(Resampling, KeepsWhatTouchesAtCornersConnected) {
  for (const double resolution_m : {0.05, 0.1, 0.2}) {
    const OccupancyGrid map = free_map(resolution_m, [](int column, int row) { return column == row; });
    for (int turn_deg = 0; turn_deg <= 180; turn_deg += 5) {
      const double turn = radians(turn_deg);
      const OccupancyGrid read = resample({&map, {0.02, 0.03, turn}}, target_geometry());
      ASSERT_FALSE(leaks(read, turn + radians(45), false)) << resolution_m << " m, " << turn_deg << " deg\n"
                                                           << to_text(read);
    }
  }
}

TEST(Resampling, DoesNotThickenAWallOfAnUnturnedMap) {
  const OccupancyGrid map = free_map(0.1, [](int, int row) { return row == 0; });
  for (const double shift_m : {0.0, 0.02, 0.04, 0.06}) {
    const OccupancyGrid read = resample({&map, {shift_m, shift_m, 0}}, target_geometry());
    EXPECT_EQ(std::count(read.cells.begin(), read.cells.end(), kOccupied), kSide) << to_text(read);
  }
}

TEST(Resampling, LeavesNoHoles) {
  for (const double resolution_m : {0.04, 0.09, 0.1, 0.25}) {
    for (const bool wall : {false, true}) {
      const OccupancyGrid map = free_map(resolution_m, [&](int, int) { return wall; });
      for (int turn_deg = 0; turn_deg < 90; turn_deg += 5) {
        const OccupancyGrid read = resample({&map, {0.01, 0.02, radians(turn_deg)}}, target_geometry());
        ASSERT_EQ(std::count(read.cells.begin(), read.cells.end(), wall ? kOccupied : kFree), kSide * kSide)
            << resolution_m << " m, " << turn_deg << " deg\n"
            << to_text(read);
      }
    }
  }
}

TEST(Resampling, LosesNoSpeck) {
  for (const double resolution_m : {0.02, 0.1}) {
    const OccupancyGrid map = free_map(resolution_m, [](int column, int row) { return column % 20 == 0 && row == 0; });
    for (int turn_deg = 0; turn_deg < 360; turn_deg += 10) {
      const PlacedMap placed{&map, {0.013, 0.029, radians(turn_deg)}};
      const OccupancyGrid read = resample(placed, target_geometry());
      for (const double x_m : {-20 * resolution_m, 0.0, 20 * resolution_m}) {
        ASSERT_EQ(read.at(read.geometry.cell_at(placed.merged_from_map * Point2{x_m, 0})), kOccupied) << to_text(read);
      }
    }
  }
}

TEST(Resampling, TakesTheMeanOfFinerCellsAndLetsWallsWin) {
  // Two by two source cells a target cell.
  const OccupancyGrid map{{6, 2, 0.05, {}}, {0, 10, 0, -1, -1, -1, 20, 31, 100, -1, -1, -1}};
  const OccupancyGrid read = resample({&map, {}}, {3, 1, 0.1, {}});
  EXPECT_EQ(read.at({0, 0}), 15);
  EXPECT_EQ(read.at({1, 0}), 100);
  EXPECT_EQ(read.at({2, 0}), kUnknown);
}

TEST(Resampling, SpreadsCoarserCellsOverTheirFootprint) {
  const OccupancyGrid map{{2, 1, 0.2, {}}, {30, -1}};
  const OccupancyGrid read = resample({&map, {}}, {4, 3, 0.1, {}});
  EXPECT_EQ(to_text(read), "????\n33??\n33??\n");
}

TEST(Resampling, CopiesWhatDiffersByWholeCells) {
  OccupancyGrid map = free_map(0.1, [](int column, int row) { return (column * 7 + row * 3) % 5 == 0; });
  const GridGeometry onto{20, 20, 0.1, Pose2{0.4, 0.2, 0.7}};
  map.geometry.map_from_grid = Pose2{1, 2, 3} * onto.map_from_grid * Pose2{-0.3, -0.2, 0};
  const OccupancyGrid read = resample({&map, inverse(Pose2{1, 2, 3})}, onto);
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 20; ++column) {
      ASSERT_EQ(read.at({column, row}), map.at({column + 3, row + 2}));
    }
  }
}

TEST(Resampling, ReadsNothingFarFromTheMap) {
  const OccupancyGrid map = free_map(0.1, [](int, int) { return false; });
  for (const double turn : {0.0, 0.5}) {
    for (const double far_m : {50.0, 1e12}) {
      const Resampler resampler({&map, {far_m, -far_m, turn}}, target_geometry());
      std::vector<std::int8_t> cells(9, kFree);
      EXPECT_FALSE(resampler.read({{0, 0}, 3, 3}, cells));
      EXPECT_EQ(cells, std::vector<std::int8_t>(9, kUnknown));
    }
  }
}

TEST(KnownBounds, EncloseTheKnownCellsInTheFrameAskedFor) {
  OccupancyGrid map = unknown_grid({10, 10, 0.1, {}});
  EXPECT_FALSE(known_bounds({&map, {}}, {}).has_value());
  map.at({2, 3}) = kFree;
  map.at({5, 7}) = kOccupied;
  const auto bounds = known_bounds({&map, {1, 0, 0}}, {0, 0, radians(90)});
  ASSERT_TRUE(bounds.has_value());
  EXPECT_NEAR(bounds->low.x_m, -0.8, 1e-12);
  EXPECT_NEAR(bounds->high.x_m, -0.3, 1e-12);
  EXPECT_NEAR(bounds->low.y_m, 1.2, 1e-12);
  EXPECT_NEAR(bounds->high.y_m, 1.6, 1e-12);
}

}  // namespace
}  // namespace gridmerge
