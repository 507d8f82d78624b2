#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "report/overlay.hpp"

namespace gridmerge {

std::ostream& operator<<(std::ostream& out, Colour colour) {
  return out << "rgb(" << int(colour.red) << ", " << int(colour.green) << ", " << int(colour.blue) << ")";
}

namespace {

constexpr double kResolution_m = 0.1;

/// All cells of one value.
OccupancyGrid plain(int width, int height, std::int8_t value) {
  OccupancyGrid grid = unknown_grid({width, height, kResolution_m, {}});
  std::fill(grid.cells.begin(), grid.cells.end(), value);
  return grid;
}

void draw_column(OccupancyGrid& grid, int column, std::int8_t value) {
  for (int row = 0; row < grid.geometry.height; ++row) {
    grid.at({column, row}) = value;
  }
}

/// The colour in that column, half way up.
Colour colour_in_column(const Overlay& overlay, const OccupancyGrid& target, int column) {
  return overlay.colour_at(target.geometry.cell_centre({column, target.geometry.height / 2}));
}

TEST(OverlayPicture, ShowsWhoseWallItIsAndWhereTheMapsAgreeOrConflict) {
  OccupancyGrid a = plain(40, 9, kFree);
  OccupancyGrid b = plain(40, 9, kFree);
  for (int column = 30; column < 40; ++column) {
    draw_column(a, column, kUnknown);
    draw_column(b, column - 30, kUnknown);
  }
  draw_column(a, 5, kOccupied);   // where B knows nothing
  draw_column(a, 13, kOccupied);  // B's is two cells beside it
  draw_column(b, 15, kOccupied);
  draw_column(a, 22, kOccupied);  // in B's free space
  draw_column(b, 26, kOccupied);  // in A's free space
  draw_column(b, 35, kOccupied);  // where A knows nothing
  const Overlay overlay = draw_overlay({{{&a, {}}, "a"}, {{&b, {}}, "b"}});

  EXPECT_EQ(colour_in_column(overlay, a, 2), free_colour(0));
  EXPECT_EQ(colour_in_column(overlay, a, 5), wall_colour(0));
  EXPECT_EQ(colour_in_column(overlay, a, 12), kFreeOfSeveralColour);
  EXPECT_EQ(colour_in_column(overlay, a, 13), kAgreementColour);
  EXPECT_EQ(colour_in_column(overlay, a, 15), kAgreementColour);
  EXPECT_EQ(colour_in_column(overlay, a, 22), kConflictColour);
  EXPECT_EQ(colour_in_column(overlay, a, 26), kConflictColour);
  EXPECT_EQ(colour_in_column(overlay, a, 33), free_colour(1));
  EXPECT_EQ(colour_in_column(overlay, a, 35), wall_colour(1));
  EXPECT_EQ(overlay.colour_at({-0.15, 0.45}), kUnknownColour);
}

TEST(OverlayPicture, PlacesAMapAtItsPoseWhateverTheTargetsYaw) {
  OccupancyGrid target = plain(30, 30, kFree);
  target.geometry.map_from_grid = {2, 1, 0.5};
  OccupancyGrid source = plain(30, 30, kUnknown);
  for (int row = 10; row < 13; ++row) {
    for (int column = 20; column < 23; ++column) {
      source.at({column, row}) = kOccupied;
    }
  }
  const Pose2 pose{3.0, 1.5, 1.2};
  const Overlay overlay = draw_overlay({{{&target, {}}, "target"}, {{&source, pose}, "source"}});
  const Point2 wall = pose * Point2{2.15, 1.15};
  ASSERT_TRUE(target.geometry.contains(target.geometry.cell_at(wall)));
  EXPECT_EQ(overlay.colour_at(wall), kConflictColour);
  EXPECT_EQ(overlay.colour_at(wall + Point2{0, 0.6}), free_colour(0));
}

TEST(OverlayPicture, GivesEachOfManyMapsItsColour) {
  const OccupancyGrid wall = plain(5, 5, kOccupied);
  std::vector<OverlayMap> maps;
  for (int map = 0; map < 8; ++map) {
    maps.push_back({{&wall, {2.0 * map, 0, 0}}, "robot " + std::to_string(map)});
  }
  const Overlay overlay = draw_overlay(maps);
  for (std::size_t map = 0; map < maps.size(); ++map) {
    EXPECT_EQ(overlay.colour_at({2.0 * static_cast<double>(map) + 0.25, 0.25}), wall_colour(map));
  }
  EXPECT_FALSE(wall_colour(0) == wall_colour(5));
}

TEST(OverlayPicture, LosesNoWallOfALargeMap) {
  OccupancyGrid map = plain(5000, 700, kFree);
  draw_column(map, 2501, kOccupied);
  const Overlay overlay = draw_overlay({{{&map, {}}, "large"}});
  EXPECT_LE(overlay.image.width, 2000);
  EXPECT_LE(overlay.image.height, 2000);
  for (const int row : {0, 123, 456, 699}) {
    EXPECT_EQ(overlay.colour_at(map.geometry.cell_centre({2501, row})), wall_colour(0)) << row;
  }
}

TEST(OverlayPicture, StaysWithinItsSizeWhateverItsShape) {
  const std::string long_name(100, 'm');
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 3000}, {3000, 1}, {390, 390}, {1700, 1700}}) {
    const OccupancyGrid map = plain(width, height, kFree);
    for (const int side_px : {400, 2000}) {
      const Overlay overlay = draw_overlay({{{&map, {}}, long_name}, {{&map, {}}, "\xC3\xA4\n"}}, {2, side_px});
      EXPECT_LE(std::max(overlay.image.width, overlay.image.height), side_px) << width << " x " << height;
      EXPECT_EQ(overlay.image.channels, 3);
      EXPECT_EQ(overlay.colour_at(map.geometry.cell_centre({0, 0})), kFreeOfSeveralColour);
    }
  }
}

TEST(OverlayPicture, EnlargesASmallMapByWholePixels) {
  OccupancyGrid map = plain(20, 10, kFree);
  draw_column(map, 7, kOccupied);
  const Overlay overlay = draw_overlay({{{&map, {}}, "small"}});
  EXPECT_EQ(overlay.pixels_a_cell, 16);
  EXPECT_EQ(overlay.canvas.resolution_m, kResolution_m);
  for (int column = 0; column < 20; ++column) {
    EXPECT_EQ(colour_in_column(overlay, map, column), column == 7 ? wall_colour(0) : free_colour(0));
  }
}

TEST(OverlayPicture, IsTheSameAtAnyNumberOfThreads) {
  OccupancyGrid a = plain(300, 200, kFree);
  draw_column(a, 100, kOccupied);
  const std::vector<OverlayMap> maps{{{&a, {}}, "a"}, {{&a, {1, 2, 0.3}}, "b"}};
  EXPECT_TRUE(draw_overlay(maps, {}, 1).image == draw_overlay(maps, {}, 4).image);
}

TEST(OverlayPicture, SurvivesTheWayThroughAPngFile) {
  const OccupancyGrid map = plain(20, 10, kOccupied);
  const RasterImage image = draw_overlay({{{&map, {}}, "map"}}).image;
  EXPECT_TRUE(decode_image(encode_png(image), "overlay.png") == image);
}

TEST(OverlayPicture, IsDrawnOfMapsThatKnowNothing) {
  const OccupancyGrid map = unknown_grid({20, 10, kResolution_m, {}});
  EXPECT_EQ(draw_overlay({{{&map, {}}, "nothing"}}).colour_at({0.05, 0.05}), kUnknownColour);
}

TEST(OverlayPicture, RefusesWhatCannotBeDrawn) {
  const OccupancyGrid map = plain(2, 2, kFree);
  EXPECT_THROW((void)draw_overlay({}), std::invalid_argument);
  EXPECT_THROW((void)draw_overlay({{{nullptr, {}}, "none"}}), std::invalid_argument);
  EXPECT_THROW((void)draw_overlay({{{&map, {INFINITY, 0, 0}}, "map"}}), std::invalid_argument);
  EXPECT_NO_THROW((void)draw_overlay({{{&map, {}}, "near"}, {{&map, {1e100, 0, 1}}, "far"}}));
  EXPECT_THROW((void)draw_overlay({{{&map, {}}, "map"}}, {-1, 2000}), std::invalid_argument);
  EXPECT_THROW((void)draw_overlay({{{&map, {}}, "map"}}, {2, 399}), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
