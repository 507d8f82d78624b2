#include "gridmerge/grid/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>

#include "support/text_map.hpp"

namespace gridmerge {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const GridGeometry kTurned = {.width = 7, .height = 5, .resolution_m = 0.05, .map_from_grid = {-12.3, 4.56, 0.7}};

TEST(GridGeometry, WorldToCellInvertsCellCentre) {
  for (const double yaw_rad : {0.0, 0.7, kPi / 2, kPi, -2.5}) {
    GridGeometry geometry = kTurned;
    geometry.map_from_grid.theta_rad = yaw_rad;
    for (int row = -3; row < geometry.height + 3; ++row) {
      for (int column = -3; column < geometry.width + 3; ++column) {
        const CellIndex cell = {column, row};
        EXPECT_EQ(geometry.cell_at(geometry.cell_centre(cell)), cell) << "yaw " << yaw_rad;
      }
    }
  }
}

TEST(GridGeometry, OriginIsTheLowerLeftCornerOfTheFirstCell) {
  const GridGeometry geometry = {.width = 4, .height = 3, .resolution_m = 0.5, .map_from_grid = {10, 20, 0}};
  EXPECT_EQ(geometry.cell_centre({0, 0}), (Point2{10.25, 20.25}));
  EXPECT_EQ(geometry.cell_centre({3, 2}), (Point2{11.75, 21.25}));
}

TEST(GridGeometry, YawTurnsTheCellsAboutTheOrigin) {
  const GridGeometry geometry = {.width = 4, .height = 3, .resolution_m = 1, .map_from_grid = {10, 20, kPi / 2}};
  const Point2 centre = geometry.cell_centre({3, 0});  // 3.5 along the grid's x axis, which points up
  EXPECT_NEAR(centre.x_m, 9.5, 1e-12);
  EXPECT_NEAR(centre.y_m, 23.5, 1e-12);
}

TEST(GridGeometry, CellHoldsItsLowerEdgesAndNotItsUpperOnes) {
  const GridGeometry geometry = {.width = 4, .height = 4, .resolution_m = 0.5, .map_from_grid = {}};
  EXPECT_EQ(geometry.cell_at({0.5, 1.0}), (CellIndex{1, 2}));
  EXPECT_EQ(geometry.cell_at({0.4999, 0.9999}), (CellIndex{0, 1}));
  EXPECT_EQ(geometry.cell_at({-1e-9, -1e-9}), (CellIndex{-1, -1}));
}

TEST(GridGeometry, ContainsItsCellsAndNoOther) {
  EXPECT_TRUE(kTurned.contains({0, 0}));
  EXPECT_TRUE(kTurned.contains({6, 4}));
  EXPECT_FALSE(kTurned.contains({7, 4}));
  EXPECT_FALSE(kTurned.contains({6, 5}));
  EXPECT_FALSE(kTurned.contains({-1, 0}));
  EXPECT_FALSE(kTurned.contains({0, -1}));
}

TEST(GridGeometry, StoresRowByRowFromTheLowerLeft) {
  EXPECT_EQ(kTurned.cell_count(), 35U);
  EXPECT_EQ(kTurned.offset({0, 0}), 0U);
  EXPECT_EQ(kTurned.offset({6, 0}), 6U);
  EXPECT_EQ(kTurned.offset({0, 1}), 7U);
  EXPECT_EQ(kTurned.offset({6, 4}), 34U);
}

TEST(GridGeometry, CountsMoreCellsThanAnIntHolds) {
  const GridGeometry large = {.width = 70000, .height = 70000, .resolution_m = 0.05, .map_from_grid = {}};
  EXPECT_EQ(large.cell_count(), 4900000000U);
  EXPECT_EQ(large.offset({69999, 69999}), 4899999999U);
}

TEST(UnknownGrid, IsUnknownEverywhere) {
  const OccupancyGrid grid = unknown_grid(kTurned);
  EXPECT_EQ(grid.geometry, kTurned);
  EXPECT_EQ(grid.cells, std::vector<std::int8_t>(35, kUnknown));
  EXPECT_NO_THROW(check_grid(grid));
}

TEST(UnknownGrid, MayBeEmpty) {
  const OccupancyGrid grid = unknown_grid({.width = 0, .height = 0, .resolution_m = 1, .map_from_grid = {}});
  EXPECT_TRUE(grid.cells.empty());
  EXPECT_NO_THROW(check_grid(grid));
}

TEST(OccupancyGrid, WritesAndReadsTheSameCell) {
  OccupancyGrid grid = unknown_grid(kTurned);
  grid.at({6, 1}) = 37;
  EXPECT_EQ(grid.cells[13], 37);
  EXPECT_EQ(grid.at({6, 1}), 37);
}

struct BadGrid {
  const char* rule;
  const char* problem;
  void (*spoil)(OccupancyGrid&);
};

void PrintTo(const BadGrid& bad, std::ostream* out) { *out << bad.rule; }

class CheckGrid : public testing::TestWithParam<BadGrid> {};

TEST_P(CheckGrid, NamesTheRuleBroken) {
  OccupancyGrid grid = unknown_grid(kTurned);
  GetParam().spoil(grid);
  try {
    check_grid(grid);
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), GetParam().problem);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , CheckGrid,
    testing::Values(BadGrid{"width", "grid of -1 x 5 cells: a size must not be negative",
                            [](OccupancyGrid& grid) { grid.geometry.width = -1; }},
                    BadGrid{"height", "grid of 7 x -5 cells: a size must not be negative",
                            [](OccupancyGrid& grid) { grid.geometry.height = -5; }},
                    BadGrid{"resolution 0", "grid resolution 0.000000 m: it must be finite and positive",
                            [](OccupancyGrid& grid) { grid.geometry.resolution_m = 0; }},
                    BadGrid{"resolution negative", "grid resolution -0.050000 m: it must be finite and positive",
                            [](OccupancyGrid& grid) { grid.geometry.resolution_m = -0.05; }},
                    BadGrid{"resolution NaN", "grid resolution nan m: it must be finite and positive",
                            [](OccupancyGrid& grid) { grid.geometry.resolution_m = kNaN; }},
                    BadGrid{"resolution infinite", "grid resolution inf m: it must be finite and positive",
                            [](OccupancyGrid& grid) { grid.geometry.resolution_m = kInfinity; }},
                    BadGrid{"origin x", "grid origin: x, y and yaw must be finite",
                            [](OccupancyGrid& grid) { grid.geometry.map_from_grid.x_m = kNaN; }},
                    BadGrid{"origin y", "grid origin: x, y and yaw must be finite",
                            [](OccupancyGrid& grid) { grid.geometry.map_from_grid.y_m = kInfinity; }},
                    BadGrid{"origin yaw", "grid origin: x, y and yaw must be finite",
                            [](OccupancyGrid& grid) { grid.geometry.map_from_grid.theta_rad = kNaN; }},
                    BadGrid{"too few cells", "grid holds 34 cells, its geometry says 35",
                            [](OccupancyGrid& grid) { grid.cells.pop_back(); }},
                    BadGrid{"too many cells", "grid holds 36 cells, its geometry says 35",
                            [](OccupancyGrid& grid) { grid.cells.push_back(0); }},
                    BadGrid{"cell too low", "grid cell value -2: cells must be -1 (unknown) or 0..100",
                            [](OccupancyGrid& grid) { grid.cells[5] = -2; }},
                    BadGrid{"cell too high", "grid cell value 101: cells must be -1 (unknown) or 0..100",
                            [](OccupancyGrid& grid) { grid.cells[5] = 101; }}));

TEST(UnknownGrid, RefusesAnUnusableGeometry) {
  GridGeometry geometry = kTurned;
  geometry.height = -1;
  EXPECT_THROW(static_cast<void>(unknown_grid(geometry)), std::invalid_argument);
  geometry = kTurned;
  geometry.resolution_m = 0;
  EXPECT_THROW(static_cast<void>(unknown_grid(geometry)), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
