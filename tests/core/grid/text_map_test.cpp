#include "support/text_map.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace gridmerge {
namespace {

TEST(TextMap, FirstRowIsTheTop) {
  const OccupancyGrid grid = text_map({"#.?",  //
                                       "7 ."},
                                      0.5, {1, 2, 0});
  EXPECT_EQ(grid.geometry, (GridGeometry{.width = 3, .height = 2, .resolution_m = 0.5, .map_from_grid = {1, 2, 0}}));
  EXPECT_EQ(grid.cells, (std::vector<std::int8_t>{70, -1, 0, 100, 0, -1}));
}

TEST(TextMap, PrintsWhatItRead) {
  EXPECT_EQ(to_text(text_map({"#.?", "19."})), "#.?\n19.\n");
  OccupancyGrid grid = text_map({"...."});
  grid.cells = {4, 5, 94, 95};
  EXPECT_EQ(to_text(grid), ".19#\n");
}

TEST(TextMap, ShowsTheGridWhenAnExpectationFails) {
  EXPECT_EQ(testing::PrintToString(text_map({"#.", ".?"}, 0.05, {1, -2, 0.5})),
            "2 x 2 cells of 0.05 m, origin (1, -2, 0.5)\n#.\n.?\n");
}

TEST(TextMap, MayBeEmpty) { EXPECT_EQ(text_map({}).geometry.cell_count(), 0U); }

TEST(TextMap, RefusesWhatIsNoMap) {
  EXPECT_THROW(static_cast<void>(text_map({"..", "..."})), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(text_map({".x."})), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
