#include "gridmerge/grid/pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/text_map.hpp"

namespace gridmerge {
namespace {

TEST(Pieces, TellsSmallOnesFromWalls) {
  // A wall of twelve cells, a post, and a slanted piece of three cells that touch by their corners only.
  const OccupancyGrid grid = text_map(
      {
          "............",
          "..#......#..",
          "..........#.",
          "...........#",
          "............",
          "############",
      },
      0.5);
  const PreparedMap map(grid, 0.5);
  const std::vector<bool> small = in_small_pieces(map, 2);
  ASSERT_EQ(small.size(), 16U);
  EXPECT_EQ(std::count(small.begin(), small.end(), true), 4);
  for (std::size_t i = 0; i < small.size(); ++i) {
    const bool of_the_wall = map.walls()[i].at.y_m < map.walls().back().at.y_m - 1.9F;  // the lowest row
    EXPECT_EQ(small[i], !of_the_wall) << i;
  }
  const std::vector<bool> finer = in_small_pieces(map, 1);
  EXPECT_EQ(std::count(finer.begin(), finer.end(), true), 1);  // the post alone
}

TEST(Pieces, ThereAreNoneWithoutWalls) {
  const PreparedMap map(text_map({"...", "..."}), 1);
  EXPECT_TRUE(in_small_pieces(map, 1).empty());
}

}  // namespace
}  // namespace gridmerge
