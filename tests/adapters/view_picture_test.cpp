#include "report/view_picture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "report/axis.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A small room, 4 m x 3 m, its local origin in the middle of it.
struct Room {
  OccupancyGrid grid =
      text_map({"########", "#......#", "#......#", "#..##..#", "#......#", "########"}, 0.5, {100, 50, 0.7});
  PreparedMap map{grid, 0.5};
  PreparedMap nothing{text_map({"??", "??"}, 0.5), 0.5};
};

const Room& room() {
  static const Room room;
  return room;
}

ViewPicture drawn(const decltype(View::content)& content) {
  return draw_view({.name = "view", .title = "a title", .content = content}, {room().map, room().map});
}

/// Width x height numbers, counted up.
SurfaceView counted(int width, int height) {
  SurfaceView view;
  view.width = width;
  view.height = height;
  for (int i = 0; i < width * height; ++i) {
    view.values.push_back(static_cast<float>(i));
  }
  view.x_high = width;
  view.y_high = height;
  return view;
}

CurvesView one_curve(std::vector<double> x, std::vector<double> y) {
  CurvesView view;
  view.curves = {{"a", std::move(x), std::move(y)}};
  return view;
}

/// Whether that colour is drawn within a few pixels of a point.
bool is_near(const ViewPicture& picture, Point2 at, Colour colour, int reach_px = 2) {
  const Point2 px{(picture.high.x_m - picture.low.x_m) / picture.width_px,
                  (picture.high.y_m - picture.low.y_m) / picture.height_px};
  for (int dy = -reach_px; dy <= reach_px; ++dy) {
    for (int dx = -reach_px; dx <= reach_px; ++dx) {
      if (picture.colour_at(at + Point2{dx * px.x_m, dy * px.y_m}) == colour) {
        return true;
      }
    }
  }
  return false;
}

/// Whether nothing is drawn on the outermost pixels: no text is cut off.
bool has_clear_edge(const RasterImage& image) {
  for (int y = 0; y < image.height; ++y) {
    const bool whole_row = y == 0 || y == image.height - 1;
    for (int x = 0; x < image.width; x += whole_row ? 1 : std::max(1, image.width - 1)) {
      const auto at =
          3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
      if (image.samples[at] != 0xFF || image.samples[at + 1] != 0xFF || image.samples[at + 2] != 0xFF) {
        return false;
      }
    }
  }
  return true;
}

void expect_sound(const ViewPicture& picture) {
  const RasterImage& image = picture.image;
  EXPECT_LE(image.width, ViewPicture::kWidest_px);
  EXPECT_LE(image.height, 1400);
  EXPECT_EQ(image.channels, 3);
  EXPECT_GT(std::min(picture.width_px, picture.height_px), 50);
  EXPECT_GE(std::min(picture.left_px, picture.top_px), 0);
  EXPECT_LE(picture.left_px + picture.width_px, image.width);
  EXPECT_LE(picture.top_px + picture.height_px, image.height);
  EXPECT_TRUE(has_clear_edge(image));
  EXPECT_TRUE(decode_image(encode_png(image), "view.png") == image);
}

TEST(RoundTicks, AreRoundAndNeverTooMany) {
  EXPECT_THAT(round_ticks(0, 10, 6).text, ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(round_ticks(-0.13, 0.31, 5).text, ElementsAre("-0.1", "0.0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(round_ticks(0, 360, 9, true).text,
              ElementsAre("0", "45", "90", "135", "180", "225", "270", "315", "360"));
  EXPECT_THAT(round_ticks(-3, 3, 7, true).text, ElementsAre("-3", "-2", "-1", "0", "1", "2", "3"));
  for (const auto& [low, high] : {std::pair{0.0, 1.0},
                                  {-1e-9, 3e-9},
                                  {5e8, 9e8},
                                  {-7, 1e-3},
                                  {1e5, 1e5 + 1e-3},
                                  {1e15, 1e15 + 4},
                                  {-1e300, 1e300},
                                  {1, 1.0000001}}) {
    for (int at_most = 2; at_most < 15; ++at_most) {
      const Ticks ticks = round_ticks(low, high, at_most);
      EXPECT_LE(ticks.at.size(), static_cast<std::size_t>(at_most)) << low << " .. " << high;
      EXPECT_EQ(ticks.at.size(), ticks.text.size());
      EXPECT_TRUE(std::is_sorted(ticks.at.begin(), ticks.at.end()));
      for (const double at : ticks.at) {
        EXPECT_GE(at, low - 1e-6 * (high - low));
        EXPECT_LE(at, high + 1e-6 * (high - low));
      }
    }
  }
}

TEST(RoundTicks, OfLargeAndSmallNumbersShareAFactor) {
  const Ticks large = round_ticks(0, 2.4e6, 4);
  EXPECT_THAT(large.text, ElementsAre("0", "1", "2"));
  EXPECT_EQ(large.factor, "1e6");
  EXPECT_EQ(round_ticks(0, 3e-5, 4).factor, "1e-6");
  EXPECT_THAT(round_ticks(0, 99000, 4).factor, IsEmpty());
}

TEST(HeatColour, GrowsLighterAllTheWay) {
  const auto lightness = [](double share) {
    const Colour c = heat_colour(share);
    return 0.2126 * std::pow(c.red, 2.2) + 0.7152 * std::pow(c.green, 2.2) + 0.0722 * std::pow(c.blue, 2.2);
  };
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(lightness(i / 100.0), lightness((i + 1) / 100.0)) << i;
  }
  EXPECT_EQ(heat_colour(-1), heat_colour(0));
  EXPECT_EQ(heat_colour(2), heat_colour(1));
  EXPECT_EQ(heat_colour(kNaN), heat_colour(0));
}

TEST(SurfacePicture, ShowsEveryNumberWhereItBelongs) {
  SurfaceView view = counted(5, 3);
  view.x_low = -10;
  view.x_high = 40;
  view.x_label = "angle [deg]";
  view.y_label = "distance [m]";
  view.value_label = "votes";
  const ViewPicture picture = drawn(view);
  expect_sound(picture);
  EXPECT_EQ(picture.low, (Point2{-10, 0}));
  EXPECT_EQ(picture.high, (Point2{40, 3}));
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 5; ++column) {
      EXPECT_EQ(picture.colour_at({-5.0 + 10 * column, 0.5 + row}), heat_colour((row * 5 + column) / 14.0));
    }
  }
}

TEST(SurfacePicture, ShowsWhatIsNotKnownInGrey) {
  SurfaceView view = counted(3, 1);
  view.values[1] = static_cast<float>(kNaN);
  const ViewPicture picture = drawn(view);
  EXPECT_EQ(picture.colour_at({1.5, 0.5}), kUnknownColour);
  EXPECT_EQ(picture.colour_at({2.5, 0.5}), heat_colour(1));
  view.values.assign(3, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(drawn(view).colour_at({2.5, 0.5}), kUnknownColour);
}

TEST(SurfacePicture, LosesNoPeakThatIsNarrowerThanAPixel) {
  SurfaceView view = counted(5000, 2);
  std::fill(view.values.begin(), view.values.end(), 0.0F);
  view.values[2345] = 7;
  EXPECT_TRUE(is_near(drawn(view), {2345.5, 0.5}, heat_colour(1), 1));
}

TEST(SurfacePicture, DrawsAxesOfOneUnitAtOneScale) {
  SurfaceView view = counted(40, 20);
  view.x_label = "x [m]";
  view.y_label = "y [m]";
  const ViewPicture metres = drawn(view);
  EXPECT_NEAR(metres.width_px, 2 * metres.height_px, 2);
  view.y_label = "angle [deg]";
  const ViewPicture mixed = drawn(view);
  EXPECT_GT(mixed.height_px, metres.height_px);
  view.y_label = "y [m]";
  view.y_high = 0.01;
  EXPECT_GT(drawn(view).height_px, 100) << "thin ones are stretched";
}

TEST(SurfacePicture, DrawsRingsRoundItsMarks) {
  SurfaceView view = counted(2, 2);
  view.marks = {{1, 0.5}};
  const ViewPicture picture = drawn(view);
  const double radius = 8 * 2.0 / picture.width_px;
  EXPECT_TRUE(is_near(picture, {1 - radius, 0.5}, kPaperColour));
  EXPECT_FALSE(is_near(picture, {0.5, 0.5}, kPaperColour, 8));
  view.marks.assign(40, {1.999, 1.999});  // in a corner, and outside: no harm
  view.marks.push_back({17, 0});
  expect_sound(drawn(view));
}

TEST(SurfacePicture, TakesOneNumberAndAllTheSame) {
  expect_sound(drawn(counted(1, 1)));
  SurfaceView view = counted(4, 4);
  std::fill(view.values.begin(), view.values.end(), 3e-7F);
  const ViewPicture picture = drawn(view);
  expect_sound(picture);
  EXPECT_EQ(picture.colour_at({0.5, 0.5}), picture.colour_at({3.5, 3.5}));
}

TEST(SurfacePicture, CutsNoLabelHoweverLong) {
  SurfaceView view = counted(30, 20);
  view.x_label = view.y_label = view.value_label = std::string(300, 'W') + " [m]";
  view.x_low = 1e5;
  view.x_high = 1e5 + 1e-4;
  view.y_low = -123456.789;
  view.y_high = -123456.78;
  expect_sound(drawn(view));
}

TEST(CurvesPicture, DrawsEachCurveInItsColour) {
  CurvesView view = one_curve({0, 10}, {1, 1});
  view.curves.push_back({"b", {0, 10}, {3, 3}});
  view.x_label = "iteration";
  view.y_label = "score";
  const ViewPicture picture = drawn(view);
  expect_sound(picture);
  EXPECT_TRUE(is_near(picture, {5, 1}, wall_colour(0)));
  EXPECT_TRUE(is_near(picture, {5, 3}, wall_colour(1)));
  EXPECT_FALSE(is_near(picture, {5, 2}, wall_colour(0)));
  EXPECT_LE(picture.low.y_m, 1);
  EXPECT_GE(picture.high.y_m, 3);
}

TEST(CurvesPicture, LeavesAGapWhereANumberIsMissing) {
  const ViewPicture picture = drawn(one_curve({0, 4, 5, 6, 10}, {2, 2, kNaN, 2, 2}));
  EXPECT_TRUE(is_near(picture, {3, 2}, wall_colour(0)));
  EXPECT_FALSE(is_near(picture, {5, 2}, wall_colour(0), 5));
  EXPECT_TRUE(is_near(picture, {7, 2}, wall_colour(0)));
}

TEST(CurvesPicture, MarksPlacesByUprightLines) {
  CurvesView view = one_curve({0, 10}, {0, 0});
  view.marks = {7, 2};
  const ViewPicture picture = drawn(view);
  const double middle = (picture.low.y_m + picture.high.y_m) / 2;
  EXPECT_TRUE(is_near(picture, {7, middle + 0.1}, kInkColour, 12));
  EXPECT_TRUE(is_near(picture, {2, middle + 0.1}, kInkColour, 12));
  EXPECT_FALSE(is_near(picture, {5, middle + 0.1}, kInkColour, 12));
}

TEST(CurvesPicture, TakesAnyNumberOfPoints) {
  expect_sound(drawn(CurvesView{}));
  expect_sound(drawn(one_curve({}, {})));
  expect_sound(drawn(one_curve({3}, {-2e9})));
  expect_sound(drawn(one_curve({1, 1, 1}, {kNaN, kNaN, kNaN})));
  CurvesView many;
  for (int i = 0; i < 30; ++i) {
    many.curves.push_back({std::string(50, 'x'), {0, 1}, {0.0, 1.0 * i}});
  }
  expect_sound(drawn(many));
}

TEST(MapPicture, LaysShapesOverTheFadedMap) {
  MapView view;
  view.shapes = {{Shape::Kind::kPoints, "points", {{-1.2, 0.6}}},
                 {Shape::Kind::kLine, "line", {{-1.2, -0.6}, {0, -0.6}}},
                 {Shape::Kind::kSegments, "segments", {{0.4, 0.6}, {0.8, 0.6}, {1.2, 0.6}, {1.4, 0.6}}}};
  const ViewPicture picture = drawn(view);
  expect_sound(picture);
  EXPECT_EQ(picture.colour_at({-1.75, 0}), faded(wall_colour(0)));
  EXPECT_EQ(picture.colour_at({-1.25, 0}), faded(free_colour(0)));
  EXPECT_EQ(picture.colour_at({-3, 0}), faded(kUnknownColour));
  EXPECT_EQ(picture.colour_at({-1.2, 0.6}), shape_colour(0));
  EXPECT_EQ(picture.colour_at({-0.6, -0.6}), shape_colour(1));
  EXPECT_EQ(picture.colour_at({0.6, 0.6}), shape_colour(2));
  EXPECT_EQ(picture.colour_at({1, 0.6}), faded(free_colour(0))) << "between two segments";
}

TEST(MapPicture, ShowsTheSourceInItsOwnColours) {
  MapView view;
  view.map = MapView::Map::kSource;
  EXPECT_EQ(drawn(view).colour_at({-1.75, 0}), faded(wall_colour(1)));
}

TEST(MapPicture, ShowsBothMapsInTheTargetsLocalFrame) {
  MapView view;
  view.map = MapView::Map::kBoth;
  view.local_target_from_source = {10, 0, 0};
  const ViewPicture apart = drawn(view);
  expect_sound(apart);
  EXPECT_EQ(apart.colour_at({-1.75, 0}), faded(wall_colour(0)));
  EXPECT_EQ(apart.colour_at({8.25, 0}), faded(wall_colour(1)));
  view.local_target_from_source = {};
  EXPECT_EQ(drawn(view).colour_at({-1.75, 0}), faded(kAgreementColour));
}

TEST(MapPicture, GivesShapesOfOneLabelOneColour) {
  MapView view;
  view.shapes = {{Shape::Kind::kPoints, "a", {{-1.2, 0.6}}},
                 {Shape::Kind::kPoints, "b", {{0, 0.6}}},
                 {Shape::Kind::kPoints, "a", {{1.2, 0.6}}}};
  const ViewPicture picture = drawn(view);
  EXPECT_EQ(picture.colour_at({1.2, 0.6}), shape_colour(0));
  EXPECT_EQ(picture.colour_at({0, 0.6}), shape_colour(1));
}

TEST(MapPicture, GrowsForShapesBesideTheMapButNotWithoutEnd) {
  MapView view;
  view.shapes = {{Shape::Kind::kPoints, "", {{3, 0}}}, {Shape::Kind::kLine, "", {{0, 0}, {1e9, 1e9}}}};
  const ViewPicture picture = drawn(view);
  expect_sound(picture);
  EXPECT_EQ(picture.colour_at({3, 0}), shape_colour(0));
  EXPECT_LT(picture.high.x_m, 10);
}

TEST(MapPicture, IsDrawnOfMapsThatKnowNothing) {
  View view{.name = "view", .title = "", .content = MapView{}};
  expect_sound(draw_view(view, {room().nothing, room().nothing}));
  std::get<MapView>(view.content).map = MapView::Map::kBoth;
  expect_sound(draw_view(view, {room().nothing, room().map}));
}

template <typename Content>
void expect_refused(const Content& content, const std::string& told) {
  EXPECT_THAT([&] { (void)drawn(content); }, ThrowsMessage<std::invalid_argument>(HasSubstr("'view': " + told)));
}

TEST(ViewPicture, RefusesViewsThatBreakTheirRules) {
  SurfaceView surface = counted(3, 2);
  surface.values.pop_back();
  expect_refused(surface, "there are 5 values for 3 x 2 places");
  expect_refused(SurfaceView{}, "width and height");
  surface = counted(3, 2);
  surface.x_high = surface.x_low;
  expect_refused(surface, "x_low");
  surface = counted(3, 2);
  surface.y_high = kNaN;
  expect_refused(surface, "y_low");
  surface = counted(3, 2);
  surface.marks = {{0, kNaN}};
  expect_refused(surface, "every mark");

  expect_refused(one_curve({1, 2}, {1}), "curve 'a' has 2 x and 1 y");
  CurvesView curves = one_curve({1, 2}, {1, 2});
  curves.marks = {kNaN};
  expect_refused(curves, "every mark");
  expect_refused(one_curve({-1.7e308, 1.7e308}, {1, 2}), "its numbers");

  MapView map;
  map.shapes = {{Shape::Kind::kSegments, "walls", {{0, 0}}}};
  expect_refused(map, "shape 'walls' has an odd number");
  map.shapes = {{Shape::Kind::kPoints, "walls", {{0, kNaN}}}};
  expect_refused(map, "every point of shape 'walls'");
  map.shapes.clear();
  map.local_target_from_source.theta_rad = kNaN;
  expect_refused(map, "local_target_from_source");
}

}  // namespace
}  // namespace gridmerge
