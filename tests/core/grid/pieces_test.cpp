#include "gridmerge/grid/pieces.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/text_map.hpp"

namespace gridmerge {
namespace {

TEST(Pieces, AreAsWideAsTheirBoxOnTheGrid) {
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
  const std::vector<float> widths_m = piece_widths_m(map);
  ASSERT_EQ(widths_m.size(), 16U);
  EXPECT_EQ(std::count(widths_m.begin(), widths_m.end(), 6.0F), 12);  // the wall
  EXPECT_EQ(std::count(widths_m.begin(), widths_m.end(), 1.5F), 3);   // the slanted one
  EXPECT_EQ(std::count(widths_m.begin(), widths_m.end(), 0.5F), 1);   // the post
  for (std::size_t i = 0; i < widths_m.size(); ++i) {
    const bool of_the_wall = map.walls()[i].at.y_m < map.walls().back().at.y_m - 1.9F;  // the lowest row
    EXPECT_EQ(widths_m[i] == 6.0F, of_the_wall) << i;
  }
}

TEST(Pieces, ThereAreNoneWithoutWalls) {
  const PreparedMap map(text_map({"...", "..."}), 1);
  EXPECT_TRUE(piece_widths_m(map).empty());
}

}  // namespace
}  // namespace gridmerge
