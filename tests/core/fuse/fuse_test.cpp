#include "gridmerge/fuse/fuse.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>

#include "gridmerge/base/random.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using ::testing::ElementsAre;

constexpr std::int8_t kU = kUnknown;

OccupancyGrid row_of_cells(const std::vector<std::int8_t>& cells) {
  return {{static_cast<int>(cells.size()), 1, 0.1, {}}, cells};
}

/// Fuses maps of one row that lie on each other.
std::vector<std::int8_t> fuse_rows(const std::vector<std::vector<std::int8_t>>& rows, const FuseOptions& options) {
  std::vector<OccupancyGrid> grids;
  for (const auto& row : rows) {
    grids.push_back(row_of_cells(row));
  }
  std::vector<PlacedMap> maps;
  for (const OccupancyGrid& grid : grids) {
    maps.push_back({&grid, {}});
  }
  return fuse(maps, options).cells;
}

FuseOptions by_rule(const std::string& rule) {
  FuseOptions options;
  options.rule = rule;
  return options;
}

OccupancyGrid random_grid(int width, int height, std::uint64_t seed, bool ternary) {
  RandomStream random(seed, "fuse_test");
  OccupancyGrid grid = unknown_grid({width, height, 0.05, {-1.5, 2.25, 0.3}});
  for (std::int8_t& cell : grid.cells) {
    cell = ternary ? std::array{kUnknown, kFree, kOccupied}[random.below(3)]
                   : static_cast<std::int8_t>(static_cast<int>(random.below(102)) - 1);
  }
  return grid;
}

TEST(Fusion, ContinuesTheTargetsCells) {
  const OccupancyGrid target = random_grid(40, 30, 1, true);
  OccupancyGrid source = random_grid(50, 20, 2, true);
  source.geometry.resolution_m = 0.07;
  const OccupancyGrid merged = fuse({{&target, {}}, {&source, {-1.3, -0.4, 2.0}}}, by_rule("keep_target"));

  EXPECT_EQ(merged.geometry.resolution_m, target.geometry.resolution_m);
  EXPECT_DOUBLE_EQ(merged.geometry.map_from_grid.theta_rad, target.geometry.map_from_grid.theta_rad);
  const CellIndex corner = merged.geometry.cell_at(target.geometry.cell_centre({0, 0}));
  EXPECT_GT(corner.column, 0);
  for (int row = 0; row < target.geometry.height; ++row) {
    for (int column = 0; column < target.geometry.width; ++column) {
      const CellIndex in_merged{corner.column + column, corner.row + row};
      const Point2 shift = merged.geometry.cell_centre(in_merged) - target.geometry.cell_centre({column, row});
      ASSERT_LT(norm(shift), 1e-9);
      if (target.at({column, row}) != kUnknown) {
        ASSERT_EQ(merged.at(in_merged), target.at({column, row})) << column << ", " << row;
      }
    }
  }
}

TEST(Fusion, JoinsTwoHalvesOfARoom) {
  const OccupancyGrid left = text_map({"#######????",  //
                                       "#......????",  //
                                       "#....#?????",  //
                                       "#######????"});
  const OccupancyGrid right = text_map({"######",  // seen by a robot that came in at the other end
                                        "#....#",  //
                                        "#.....",  //
                                        "######"});
  EXPECT_EQ(to_text(fuse({{&left, {}}, {&right, {11, 4, radians(180)}}})),
            "###########\n"
            "#.........#\n"
            "#....#....#\n"
            "###########\n");
}

TEST(Fusion, ReachesAsFarAsAnyMapKnowsACell) {
  const OccupancyGrid target = row_of_cells({0, 0});
  OccupancyGrid source = unknown_grid({10, 10, 0.1, {}});
  source.at({7, 4}) = kOccupied;
  const OccupancyGrid merged = fuse({{&target, {}}, {&source, {-1.0, 0, 0}}});
  EXPECT_EQ(merged.geometry.width, 5);  // the wall lies in column -3
  EXPECT_EQ(merged.geometry.height, 5);
  EXPECT_NEAR(merged.geometry.map_from_grid.x_m, -0.3, 1e-12);
  EXPECT_EQ(merged.at({0, 4}), kOccupied);
  EXPECT_EQ(merged.at({3, 0}), kFree);
}

TEST(Fusion, ReturnsOneMapAsItIs) {
  for (const char* rule : {"log_odds", "max", "entropy", "keep_target"}) {
    for (const bool ternary : {true, false}) {
      const OccupancyGrid map = random_grid(150, 140, 3, ternary);
      EXPECT_EQ(fuse({{&map, {}}}, by_rule(rule)), map) << rule;
    }
  }
}

TEST(Fusion, LetsUnknownOverwriteNothing) {
  for (const char* rule : {"log_odds", "max", "entropy", "keep_target"}) {
    EXPECT_THAT(fuse_rows({{0, 100, kU, kU, kU}, {kU, kU, 0, 100, kU}}, by_rule(rule)), ElementsAre(0, 100, 0, 100, kU))
        << rule;
  }
}

TEST(Fusion, AddsLogOdds) {
  FuseOptions options;
  options.wall_margin_cells = 0;
  // 0.8 / 0.2 * 0.7 / 0.3 = 28 / 3; a map never counts for more than occupied_probability: 9 * 9 = 81.
  EXPECT_THAT(fuse_rows({{80, 100, 30, 50}, {70, 100, 70, 20}}, options), ElementsAre(90, 99, 50, 20));
}

TEST(Fusion, ByLogOddsOrMaxIsTheSameInAnyOrder) {
  std::vector<OccupancyGrid> grids;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    grids.push_back(random_grid(60, 50, seed, false));
  }
  for (const char* rule : {"log_odds", "max"}) {
    std::vector<int> order{0, 1, 2, 3};
    std::optional<OccupancyGrid> first;
    do {
      std::vector<PlacedMap> maps;
      for (const int index : order) {
        maps.push_back({&grids[static_cast<std::size_t>(index)], {}});
      }
      const OccupancyGrid merged = fuse(maps, by_rule(rule));
      first = first ? first : merged;
      ASSERT_EQ(merged, *first) << rule;
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Fusion, ByLogOddsClearsAGhostThatMaxKeeps) {
  const std::vector<std::int8_t> ghost{0, 0, 0, 100, 0, 0, 0};
  const std::vector<std::int8_t> clear(7, 0);
  EXPECT_THAT(fuse_rows({ghost, clear, clear}, by_rule("log_odds")), ElementsAre(0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(fuse_rows({ghost, clear, clear}, by_rule("max")), ElementsAre(0, 0, 0, 100, 0, 0, 0));
}

TEST(Fusion, TakesOneAgainstOneForAWallUnlessFreeWeighsMore) {
  FuseOptions options;
  EXPECT_THAT(fuse_rows({{0, 100, 0}, {0, 0, 0}}, options), ElementsAre(0, 100, 0));
  EXPECT_THAT(fuse_rows({{0, 0, 0}, {0, 100, 0}}, options), ElementsAre(0, 100, 0));
  options.free_probability = 0.05;
  EXPECT_THAT(fuse_rows({{0, 100, 0}, {0, 0, 0}}, options), ElementsAre(0, 0, 0));
}

TEST(Fusion, LosesNoWallThatIsMisplacedByACell) {
  // Four maps put one wall into four columns: one by one, each wall is outvoted.
  const std::vector<std::vector<std::int8_t>> maps{{0, 0, 0, 100, 0, 0, 0, 0, 0},
                                                   {0, 0, 0, 0, 100, 0, 0, 0, 0},
                                                   {0, 0, 0, 100, 0, 0, 0, 0, 0},
                                                   {0, 0, 0, 0, 0, 100, 0, 0, 0}};
  FuseOptions options;
  EXPECT_THAT(fuse_rows(maps, options), ElementsAre(0, 0, 0, 100, 100, 100, 0, 0, 0));
  options.wall_margin_cells = 0;
  EXPECT_THAT(fuse_rows({maps[0], maps[1], maps[3]}, options), ElementsAre(0, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(Fusion, TurnsNoMisplacedWallGrey) {
  const std::vector<std::vector<std::int8_t>> maps{{10, 10, 80, 10, 10, 10}, {10, 10, 10, 80, 10, 10}};
  FuseOptions options;
  EXPECT_THAT(fuse_rows(maps, options), ElementsAre(1, 1, 80, 80, 1, 1));
  options.wall_margin_cells = 0;
  EXPECT_THAT(fuse_rows(maps, options), ElementsAre(1, 1, 31, 31, 1, 1));
}

TEST(Fusion, ByEntropyKeepsTheTargetWhereInformationWouldBeLost) {
  // log-odds: 90 against 10 cancel (lost), 60 against 10 is surer than 60 (won), 90 and 80 agree (won).
  EXPECT_THAT(fuse_rows({{90, 60, 90, kU, 70}, {10, 10, 80, 30, kU}}, by_rule("entropy")),
              ElementsAre(90, 14, 97, 30, 70));
  EXPECT_THAT(fuse_rows({{100, 0}, {0, 100}}, by_rule("entropy")), ElementsAre(100, 0));
}

TEST(Fusion, ByKeepTargetKeepsTheTarget) {
  EXPECT_THAT(fuse_rows({{0, 100, kU, 40}, {100, 0, 70, 90}}, by_rule("keep_target")), ElementsAre(0, 100, 70, 40));
}

TEST(Fusion, GivesTernaryMapsWhereAllAreTernaryOrAsAsked) {
  FuseOptions options;
  EXPECT_THAT(fuse_rows({{0, 100, 100}, {0, 100, 0}}, options), ElementsAre(0, 100, 100));
  options.output = "probability";
  options.wall_margin_cells = 0;
  EXPECT_THAT(fuse_rows({{0, 100, 100}, {0, 100, 0}}, options), ElementsAre(1, 99, 50));
  options.output = "ternary";
  EXPECT_THAT(fuse_rows({{49, 50, kU}, {kU, kU, kU}}, options), ElementsAre(0, 100, kU));
}

TEST(Fusion, IsTheSameAtAnyNumberOfThreads) {
  const OccupancyGrid target = random_grid(300, 270, 5, false);
  const OccupancyGrid source = random_grid(280, 310, 6, false);
  for (const char* rule : {"log_odds", "max", "entropy", "keep_target"}) {
    const std::vector<PlacedMap> maps{{&target, {}}, {&source, {3.1, -2.2, 0.6}}};
    EXPECT_EQ(fuse(maps, by_rule(rule), 1), fuse(maps, by_rule(rule), 4)) << rule;
  }
}

TEST(Fusion, TakesMapsThatKnowNothingOrHoldNoCell) {
  const OccupancyGrid target = row_of_cells({0, 100});
  const OccupancyGrid unknown = unknown_grid({5, 5, 0.2, {7, 7, 1}});
  const OccupancyGrid empty = unknown_grid({0, 0, 0.1, {}});
  EXPECT_EQ(fuse({{&target, {}}, {&unknown, {100, 0, 0}}, {&empty, {}}}), target);
  EXPECT_THAT(fuse({{&empty, {}}, {&target, {}}}).cells, ElementsAre(0, 100));
  EXPECT_THAT(fuse({{&empty, {}}}).cells, ElementsAre());
}

TEST(Fusion, RefusesAbsurdExtentsBeforeItTakesMemory) {
  const OccupancyGrid map = row_of_cells({0, 100});
  EXPECT_THROW((void)fuse({{&map, {}}, {&map, {1e6, 1e6, 0}}}), std::invalid_argument);
  EXPECT_THROW((void)fuse({{&map, {}}, {&map, {1e300, 0, 0}}}), std::invalid_argument);
  FuseOptions options;
  options.max_cells = 10;
  EXPECT_NO_THROW((void)fuse({{&map, {}}, {&map, {0.8, 0, 0}}}, options));
  EXPECT_THROW((void)fuse({{&map, {}}, {&map, {0.9, 0, 0}}}, options), std::invalid_argument);
}

TEST(Fusion, RefusesWhatIsMalformed) {
  const OccupancyGrid map = row_of_cells({0, 100});
  OccupancyGrid broken = map;
  broken.cells.pop_back();
  EXPECT_THROW((void)fuse({}), std::invalid_argument);
  EXPECT_THROW((void)fuse({{nullptr, {}}}), std::invalid_argument);
  EXPECT_THROW((void)fuse({{&map, {}}, {&broken, {}}}), std::invalid_argument);
  EXPECT_THROW((void)fuse({{&map, {}}, {&map, {std::numeric_limits<double>::quiet_NaN(), 0, 0}}}),
               std::invalid_argument);
  EXPECT_THROW((void)fuse({{&map, {}}}, by_rule("average")), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
