#include "report/view_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "report/axis.hpp"
#include "report/drawing.hpp"
#include "report/painted_maps.hpp"

namespace gridmerge {
namespace {

using drawing::Legend;
using drawing::LegendEntry;
using drawing::TextStyle;

constexpr int kEdge = 18;       // [px], paper round everything
constexpr int kTickLength = 6;  // [px]
constexpr int kPad = 8;         // [px], between things that belong together
constexpr int kWidestPlot = 900;
constexpr TextStyle kTickText{.height_px = 11};
constexpr TextStyle kLabelText{.height_px = 12};
constexpr TextStyle kLabelUpwards{.height_px = 12, .upwards = true};
constexpr TextStyle kMarkText{.height_px = 11, .outlined = true};
constexpr int kLabelLine = 26;  // [px], a line of label with the space round it
constexpr int kNumberedMarks = 12;
constexpr Colour kGridColour{0xE6, 0xE8, 0xEA};
constexpr int kFraction = 4;  // bits: OpenCV draws to a sixteenth of a pixel

void require(bool good, const std::string& view, const std::string& rule) {
  if (!good) {
    throw std::invalid_argument("view '" + view + "': " + rule);
  }
}

bool is_finite(Point2 p) { return std::isfinite(p.x_m) && std::isfinite(p.y_m); }

struct Range {
  double low = 0;
  double high = 1;

  [[nodiscard]] double size() const { return high - low; }
  [[nodiscard]] double share(double value) const { return (value - low) / size(); }
  [[nodiscard]] bool holds(double value) const { return value >= low && value <= high; }
};

/// From the smallest to the largest number; none where there is no finite one.
template <typename Numbers>
std::optional<Range> range_of(const Numbers& numbers) {
  std::optional<Range> range;
  for (const double value : numbers) {
    if (std::isfinite(value)) {
      range = range ? Range{std::min(range->low, value), std::max(range->high, value)} : Range{value, value};
    }
  }
  return range;
}

/// The same, but never a single point.
Range opened(Range range) {
  const double least = 1e-9 * std::max({std::abs(range.low), std::abs(range.high), 1e-3});
  return range.size() > least ? range : Range{range.low - 0.5, range.high + 0.5};
}

/// An axis of a plot: what it spans, its label, and its marks once its length is known.
struct Axis {
  Range range;
  std::string label;
  Ticks ticks;

  [[nodiscard]] int widest_text() const {
    int widest = 0;
    for (const std::string& text : ticks.text) {
      widest = std::max(widest, drawing::text_width(text, kTickText));
    }
    return widest;
  }
  /// As many marks as there is room for along that length. @param along_text  the texts stand one after the other
  void mark(int length_px, bool along_text) {
    const bool are_degrees = unit_of(label) == "deg";
    for (int at_most = std::clamp(length_px / (along_text ? 60 : 42), 2, 14); at_most >= 2; --at_most) {
      ticks = round_ticks(range.low, range.high, at_most, are_degrees);
      const double apart_px = ticks.at.size() < 2 ? length_px : (ticks.at[1] - ticks.at[0]) / range.size() * length_px;
      if (!along_text || widest_text() + 2 * kPad < apart_px) {
        return;
      }
    }
  }
  [[nodiscard]] std::string full_label() const {
    return label + (ticks.factor.empty() ? "" : (label.empty() ? "in " : ", in ") + ticks.factor);
  }
};

/// The text, cut so that it is no longer than that.
std::string fitted(const std::string& text, const TextStyle& style, int length_px) {
  std::string shown = drawing::printable(text, std::max<std::size_t>(text.size(), 8));
  for (std::size_t longest = text.size(); longest > 8 && drawing::text_width(shown, style) > length_px; --longest) {
    shown = drawing::printable(text, longest);
  }
  return shown;
}

/// What a plot is made of, before anything is drawn.
struct PlotPlan {
  Axis x;
  Axis y;
  std::optional<Axis> bar;  ///< of colours, at the right
  cv::Size size;            ///< of the plotted area; its width may have to shrink
  std::vector<LegendEntry> legend;
};

/// A sheet of paper with an empty plot: the area to draw in, and the axes round it.
class Plot {
 public:
  explicit Plot(PlotPlan plan) : plan_(std::move(plan)) {
    plan_.y.mark(plan_.size.height, false);
    if (plan_.bar) {
      plan_.bar->mark(plan_.size.height, false);
    }
    plan_.x.mark(plan_.size.width, true);
    const int left =
        kEdge + (plan_.y.full_label().empty() ? 0 : kLabelLine) + plan_.y.widest_text() + kPad + kTickLength;
    const int right = std::max(kEdge, plan_.x.widest_text() / 2 + kPad) + bar_px();
    plan_.size.width = std::min(plan_.size.width, ViewPicture::kWidest_px - left - right);
    plan_.x.mark(plan_.size.width, true);

    area_ = {{left, kEdge}, plan_.size};
    const int width = left + plan_.size.width + right;
    legend_top_ = area_.br().y + kTickLength + kLabelLine + (plan_.x.full_label().empty() ? 0 : kLabelLine) + kPad;
    const Legend legend(plan_.legend, 1);
    picture_.image = drawing::blank_image(width, legend_top_ + legend.height(width - left - kEdge) + kEdge / 2);
    picture_.left_px = area_.x;
    picture_.top_px = area_.y;
    picture_.width_px = area_.width;
    picture_.height_px = area_.height;
    picture_.low = {plan_.x.range.low, plan_.y.range.low};
    picture_.high = {plan_.x.range.high, plan_.y.range.high};
    image_ = drawing::matrix_of(picture_.image);
    legend.draw(image_, {left, legend_top_}, width - left - kEdge);
  }

  [[nodiscard]] cv::Mat& image() { return image_; }
  [[nodiscard]] cv::Rect area() const { return area_; }
  [[nodiscard]] const PlotPlan& plan() const { return plan_; }

  /// The pixel under a point of the axes.
  [[nodiscard]] cv::Point2d at(double x, double y) const {
    return {area_.x + plan_.x.range.share(x) * area_.width, area_.br().y - plan_.y.range.share(y) * area_.height};
  }
  [[nodiscard]] int column_of(double x) const {
    return std::clamp(cv::saturate_cast<int>(at(x, 0).x), area_.x, area_.br().x - 1);
  }
  [[nodiscard]] int row_of(double y) const {
    return std::clamp(cv::saturate_cast<int>(at(0, y).y), area_.y, area_.br().y - 1);
  }

  void draw_grid() {
    for (const double x : plan_.x.ticks.at) {
      drawing::fill(image_, {column_of(x), area_.y, 1, area_.height}, kGridColour);
    }
    for (const double y : plan_.y.ticks.at) {
      drawing::fill(image_, {area_.x, row_of(y), area_.width, 1}, kGridColour);
    }
  }

  /// Axes, and the bar of colours: the last thing that is drawn.
  ViewPicture finished() {
    cv::rectangle(image_, area_ + cv::Size(2, 2) - cv::Point(1, 1), drawing::scalar(kFrameColour));
    draw_x_axis();
    draw_y_axis();
    if (plan_.bar) {
      draw_bar(*plan_.bar);
    }
    return std::move(picture_);
  }

 private:
  [[nodiscard]] int bar_px() const {
    return plan_.bar ? kBarGap + kBarWidth + kTickLength + kPad + plan_.bar->widest_text() +
                           (plan_.bar->full_label().empty() ? 0 : kLabelLine)
                     : 0;
  }

  void draw_x_axis() {
    const int bottom = area_.br().y;
    for (std::size_t i = 0; i < plan_.x.ticks.at.size(); ++i) {
      const int column = column_of(plan_.x.ticks.at[i]);
      drawing::fill(image_, {column, bottom, 1, kTickLength}, kInkColour);
      drawing::write(image_, plan_.x.ticks.text[i], {column, bottom + kTickLength + kLabelLine / 2}, 0.5, kTickText);
    }
    drawing::write(image_, fitted(plan_.x.full_label(), kLabelText, area_.width),
                   {area_.x + area_.width / 2, bottom + kTickLength + kLabelLine + kLabelLine / 2}, 0.5, kLabelText);
  }

  void draw_y_axis() {
    for (std::size_t i = 0; i < plan_.y.ticks.at.size(); ++i) {
      const int row = row_of(plan_.y.ticks.at[i]);
      drawing::fill(image_, {area_.x - kTickLength, row, kTickLength, 1}, kInkColour);
      drawing::write(image_, plan_.y.ticks.text[i], {area_.x - kTickLength - kPad / 2, row}, 1, kTickText);
    }
    drawing::write(image_, fitted(plan_.y.full_label(), kLabelUpwards, area_.height),
                   {kEdge + kLabelLine / 2 - 4, area_.y + area_.height / 2}, 0.5, kLabelUpwards);
  }

  void draw_bar(const Axis& bar) {
    const cv::Rect box(area_.br().x + kBarGap, area_.y, kBarWidth, area_.height);
    for (int y = 0; y < box.height; ++y) {
      const double share = 1 - (y + 0.5) / box.height;
      drawing::fill(image_, {box.x, box.y + y, box.width, 1}, heat_colour(share));
    }
    cv::rectangle(image_, box + cv::Size(2, 2) - cv::Point(1, 1), drawing::scalar(kFrameColour));
    const int right = box.br().x;
    for (std::size_t i = 0; i < bar.ticks.at.size(); ++i) {
      const double from_top = (1 - bar.range.share(bar.ticks.at[i])) * box.height;
      const int row = std::clamp(box.y + cv::saturate_cast<int>(from_top), box.y, box.br().y - 1);
      drawing::fill(image_, {right + 1, row, kTickLength, 1}, kInkColour);
      drawing::write(image_, bar.ticks.text[i], {right + kTickLength + kPad / 2 + 2, row}, 0, kTickText);
    }
    drawing::write(image_, fitted(bar.full_label(), kLabelUpwards, area_.height),
                   {right + kTickLength + kPad + bar.widest_text() + kLabelLine / 2, area_.y + area_.height / 2}, 0.5,
                   kLabelUpwards);
  }

  static constexpr int kBarGap = 22;
  static constexpr int kBarWidth = 20;
  PlotPlan plan_;
  ViewPicture picture_;
  cv::Mat image_;  ///< borrows the picture's samples
  cv::Rect area_;
  int legend_top_ = 0;
};

// ---- surfaces

/// The numbers that one pixel stands for: their largest; NaN where none is finite.
float largest_of(const SurfaceView& view, int column, int columns, int row, int rows) {
  float largest = std::numeric_limits<float>::quiet_NaN();
  for (int r = row; r < row + rows; ++r) {
    for (int c = column; c < column + columns; ++c) {
      const float value =
          view.values[static_cast<std::size_t>(r) * static_cast<std::size_t>(view.width) + static_cast<std::size_t>(c)];
      if (std::isfinite(value) && !(largest >= value)) {
        largest = value;
      }
    }
  }
  return largest;
}

/// The cells that pixel `i` of `pixels` covers, of `cells` in all: the first, and how many.
std::pair<int, int> cells_under(int i, int pixels, int cells) {
  const auto cell = [&](int pixel) { return static_cast<int>(static_cast<std::int64_t>(pixel) * cells / pixels); };
  return {cell(i), std::max(1, cell(i + 1) - cell(i))};
}

void draw_values(cv::Mat& image, const cv::Rect& area, const SurfaceView& view, const Range& shown) {
  for (int y = 0; y < area.height; ++y) {
    const auto [row, rows] = cells_under(area.height - 1 - y, area.height, view.height);
    for (int x = 0; x < area.width; ++x) {
      const auto [column, columns] = cells_under(x, area.width, view.width);
      const float value = largest_of(view, column, columns, row, rows);
      image.at<cv::Vec3b>(area.y + y, area.x + x) =
          drawing::pixel(std::isnan(value) ? kUnknownColour : heat_colour(shown.share(value)));
    }
  }
}

/// Rings in white on a dark rim, so that they are seen on every colour. The first have numbers beside them, but for
/// those that would cover a better one's.
void draw_marks(Plot& plot, const std::vector<Point2>& marks) {
  constexpr int kRadius = 8;
  const cv::Rect area = plot.area();
  std::vector<std::optional<cv::Point>> places;
  for (const Point2& mark : marks) {
    const bool shown = plot.plan().x.range.holds(mark.x_m) && plot.plan().y.range.holds(mark.y_m);
    places.push_back(shown ? std::optional(cv::Point(plot.column_of(mark.x_m), plot.row_of(mark.y_m))) : std::nullopt);
  }
  for (std::size_t i = marks.size(); i-- > 0;) {  // the best on top
    if (places[i]) {
      const int radius = i < kNumberedMarks ? kRadius : kRadius / 2;
      cv::circle(plot.image(), *places[i], radius, drawing::scalar(kInkColour), 4, cv::LINE_AA);
      cv::circle(plot.image(), *places[i], radius, drawing::scalar(kPaperColour), 2, cv::LINE_AA);
    }
  }
  std::vector<cv::Rect> taken;
  for (std::size_t i = 0; i < std::min<std::size_t>(kNumberedMarks, marks.size()); ++i) {
    if (!places[i]) {
      continue;
    }
    const std::string number = std::to_string(i + 1);
    const int width = drawing::text_width(number, kMarkText);
    const bool fits = places[i]->x + 3 * kRadius + width < area.br().x;
    const int row = std::clamp(places[i]->y - kRadius, area.y + kPad, area.br().y - kPad);
    const int column = places[i]->x + (fits ? 1 : -1) * (kRadius + 4);
    const cv::Rect box(column - (fits ? 0 : width), row - kPad, width, 2 * kPad);
    if (std::none_of(taken.begin(), taken.end(), [&](const cv::Rect& other) { return (other & box).area() > 0; })) {
      drawing::write(plot.image(), number, {column, row}, fits ? 0 : 1, kMarkText);
      taken.push_back(box);
    }
  }
}

/// One scale for both axes where they have one unit and neither would be too thin to read.
cv::Size surface_size(const SurfaceView& view) {
  constexpr int kTallest = 720;
  constexpr double kThinnest = 130;
  const double width = view.x_high - view.x_low;
  const double height = view.y_high - view.y_low;
  const double scale = std::min(kWidestPlot / width, kTallest / height);
  if (unit_of(view.x_label) == unit_of(view.y_label) && std::min(width, height) * scale >= kThinnest) {
    return {static_cast<int>(std::lround(scale * width)), static_cast<int>(std::lround(scale * height))};
  }
  return {kWidestPlot, 460};
}

ViewPicture draw(const SurfaceView& view, const std::string& name) {
  require(view.width > 0 && view.height > 0, name, "width and height must be positive");
  require(view.values.size() == static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height), name,
          "there are " + std::to_string(view.values.size()) + " values for " + std::to_string(view.width) + " x " +
              std::to_string(view.height) + " places");
  require(view.x_low < view.x_high && std::isfinite(view.x_high - view.x_low), name, "x_low must be below x_high");
  require(view.y_low < view.y_high && std::isfinite(view.y_high - view.y_low), name, "y_low must be below y_high");
  require(std::all_of(view.marks.begin(), view.marks.end(), is_finite), name, "every mark must be finite");

  const Range shown = opened(range_of(view.values).value_or(Range{}));
  PlotPlan plan{.x = {{view.x_low, view.x_high}, view.x_label, {}},
                .y = {{view.y_low, view.y_high}, view.y_label, {}},
                .bar = Axis{shown, view.value_label, {}},
                .size = surface_size(view),
                .legend = {}};
  if (std::any_of(view.values.begin(), view.values.end(), [](float v) { return !std::isfinite(v); })) {
    plan.legend.push_back({.text = "nothing known", .colour = kUnknownColour, .second = kUnknownColour});
  }
  Plot plot(std::move(plan));
  draw_values(plot.image(), plot.area(), view, shown);
  draw_marks(plot, view.marks);
  return plot.finished();
}

// ---- curves

cv::Point fractional(cv::Point2d at) {
  constexpr double kFar = 1e6;  // beyond every picture, and far from overflow
  const double scale = 1 << kFraction;
  return {static_cast<int>(std::lround(std::clamp(at.x, -kFar, kFar) * scale)),
          static_cast<int>(std::lround(std::clamp(at.y, -kFar, kFar) * scale))};
}

void draw_polyline(cv::Mat& image, const std::vector<cv::Point>& points, Colour colour, int thickness) {
  if (points.size() == 1) {
    cv::circle(image, points.front(), (thickness + 1) << kFraction, drawing::scalar(colour), cv::FILLED, cv::LINE_AA,
               kFraction);
  } else if (!points.empty()) {
    cv::polylines(image, points, false, drawing::scalar(colour), thickness, cv::LINE_AA, kFraction);
  }
}

void draw_curve(Plot& plot, const Curve& curve, Colour colour) {
  cv::Mat inside = plot.image()(plot.area());
  const cv::Point2d corner = plot.area().tl();
  std::vector<cv::Point> run;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) {
      run.push_back(fractional(plot.at(curve.x[i], curve.y[i]) - corner));
      continue;
    }
    draw_polyline(inside, run, colour, 2);
    run.clear();
  }
  draw_polyline(inside, run, colour, 2);
}

void draw_upright_marks(Plot& plot, const std::vector<double>& marks) {
  constexpr int kDash = 6;
  const cv::Rect area = plot.area();
  for (std::size_t i = marks.size(); i-- > 0;) {
    const int column = plot.column_of(marks[i]);
    for (int y = 0; y < area.height; y += 2 * kDash) {
      drawing::fill(plot.image(), {column, area.y + y, 1, std::min(kDash, area.height - y)}, kInkColour);
    }
    if (i < kNumberedMarks) {
      const bool fits = column + 3 * kPad < area.br().x;
      drawing::write(plot.image(), std::to_string(i + 1), {column + (fits ? 4 : -4), area.y + 2 * kPad}, fits ? 0 : 1,
                     kMarkText);
    }
  }
}

/// A little air above and below; from zero on, where the curves stand on it.
Range value_range(const std::optional<Range>& values) {
  const Range range = opened(values.value_or(Range{}));
  const double air = 0.05 * range.size();
  const bool on_zero = range.low >= 0 && range.low < 0.3 * range.high;
  return {on_zero ? 0 : range.low - air, range.high + air};
}

ViewPicture draw(const CurvesView& view, const std::string& name) {
  std::vector<double> all_x = view.marks;
  std::vector<double> all_y;
  PlotPlan plan;
  for (std::size_t i = 0; i < view.curves.size(); ++i) {
    const Curve& curve = view.curves[i];
    require(curve.x.size() == curve.y.size(), name,
            "curve '" + curve.label + "' has " + std::to_string(curve.x.size()) + " x and " +
                std::to_string(curve.y.size()) + " y");
    all_x.insert(all_x.end(), curve.x.begin(), curve.x.end());
    all_y.insert(all_y.end(), curve.y.begin(), curve.y.end());
    if (!curve.label.empty()) {
      plan.legend.push_back(
          {.text = drawing::printable(curve.label, 60), .sign = LegendEntry::Sign::kLine, .colour = wall_colour(i)});
    }
  }
  require(std::all_of(view.marks.begin(), view.marks.end(), [](double x) { return std::isfinite(x); }), name,
          "every mark must be finite");
  plan.x = {opened(range_of(all_x).value_or(Range{})), view.x_label, {}};
  plan.y = {value_range(range_of(all_y)), view.y_label, {}};
  require(std::isfinite(plan.x.range.size()) && std::isfinite(plan.y.range.size()), name, "its numbers are too large");
  plan.size = {kWidestPlot, 420};
  Plot plot(std::move(plan));
  plot.draw_grid();
  draw_upright_marks(plot, view.marks);
  for (std::size_t i = view.curves.size(); i-- > 0;) {  // the first on top
    draw_curve(plot, view.curves[i], wall_colour(i));
  }
  return plot.finished();
}

// ---- shapes over maps

/// A prepared map as a grid whose map frame is its local frame.
OccupancyGrid local_grid(const PreparedMap& map) {
  const MapLevel& level = map.level(0);
  return {{level.width, level.height, level.resolution_m, {level.lower_left.x_m, level.lower_left.y_m, 0}},
          map.occupancy()};
}

/// The maps, and the shapes as far as they do not reach out for more than half the maps' extent.
Bounds shown_bounds(const std::vector<PlacedMap>& maps, const MapView& view) {
  const Pose2 frame_from_view = inverse(drawing::merged_from_first_cells(maps));
  const Bounds known = drawing::known_by_any(maps, frame_from_view);
  const Point2 reach = 0.5 * (known.high - known.low);
  const Bounds most{known.low - reach, known.high + reach};
  Bounds shown = known;
  for (const Shape& shape : view.shapes) {
    for (const Point2& point : shape.points) {
      const Point2 at = frame_from_view * point;
      const Point2 held{std::clamp(at.x_m, most.low.x_m, most.high.x_m),
                        std::clamp(at.y_m, most.low.y_m, most.high.y_m)};
      shown = drawing::joined(shown, {held, held});
    }
  }
  return shown;
}

int point_radius(std::size_t count) { return count <= 150 ? 4 : count <= 1500 ? 3 : 2; }

/// @param points  in pixels of the image, with a fraction
void draw_shape(cv::Mat& image, const std::vector<cv::Point>& points, Shape::Kind kind, Colour colour) {
  switch (kind) {
    case Shape::Kind::kLine:
      draw_polyline(image, points, colour, 2);
      return;
    case Shape::Kind::kSegments:
      for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
        cv::line(image, points[i], points[i + 1], drawing::scalar(colour), 2, cv::LINE_AA, kFraction);
      }
      return;
    case Shape::Kind::kPoints: {
      const int radius = point_radius(points.size());
      for (const cv::Point& point : points) {
        if (radius > 3) {
          cv::circle(image, point, (radius + 1) << kFraction, drawing::scalar(kPaperColour), cv::FILLED, cv::LINE_AA,
                     kFraction);
        }
        cv::circle(image, point, radius << kFraction, drawing::scalar(colour), cv::FILLED, cv::LINE_AA, kFraction);
      }
    }
  }
}

/// Colours of the shapes: one for each label.
std::vector<Colour> colours_of(const std::vector<Shape>& shapes) {
  std::vector<std::string> labels;
  std::vector<Colour> colours;
  for (const Shape& shape : shapes) {
    const auto known = std::find(labels.begin(), labels.end(), shape.label);
    colours.push_back(shape_colour(static_cast<std::size_t>(known - labels.begin())));
    if (known == labels.end()) {
      labels.push_back(shape.label);
    }
  }
  return colours;
}

std::vector<LegendEntry> map_legend(const MapView& view, double ruler_px, const std::string& ruler_text) {
  std::vector<LegendEntry> entries = {{.text = ruler_text, .sign = LegendEntry::Sign::kRuler, .ruler_px = ruler_px}};
  const auto add_map = [&](const std::string& text, std::size_t map) {
    entries.push_back({.text = text, .colour = faded(wall_colour(map)), .second = faded(free_colour(map))});
  };
  if (view.map != MapView::Map::kSource) {
    add_map("target", 0);
  }
  if (view.map != MapView::Map::kTarget) {
    add_map("source", 1);
  }
  if (view.map == MapView::Map::kBoth) {
    entries.push_back({.text = "both", .colour = faded(kAgreementColour), .second = faded(kFreeOfSeveralColour)});
  }
  std::vector<std::string> told;
  const std::vector<Colour> colours = colours_of(view.shapes);
  for (std::size_t i = 0; i < view.shapes.size(); ++i) {
    const Shape& shape = view.shapes[i];
    if (shape.label.empty() || std::find(told.begin(), told.end(), shape.label) != told.end()) {
      continue;
    }
    told.push_back(shape.label);
    const bool points = shape.kind == Shape::Kind::kPoints;
    entries.push_back({.text = drawing::printable(shape.label, 60),
                       .sign = points ? LegendEntry::Sign::kPoint : LegendEntry::Sign::kLine,
                       .colour = colours[i]});
  }
  return entries;
}

void check(const MapView& view, const std::string& name) {
  const Pose2& pose = view.local_target_from_source;
  require(std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad), name,
          "local_target_from_source must be finite");
  for (const Shape& shape : view.shapes) {
    require(std::all_of(shape.points.begin(), shape.points.end(), is_finite), name,
            "every point of shape '" + shape.label + "' must be finite");
    require(shape.kind != Shape::Kind::kSegments || shape.points.size() % 2 == 0, name,
            "shape '" + shape.label + "' has an odd number of points for its segments");
  }
}

ViewPicture draw(const MapView& view, const std::string& name, const ViewedMaps& prepared, int num_threads) {
  constexpr int kLargest = 1100;    // [px], of the maps
  constexpr int kNarrowest = 480;   // [px], so that the legend can be read
  constexpr int kLargestCell = 16;  // [px]
  check(view, name);
  const OccupancyGrid target = local_grid(prepared.target);
  const OccupancyGrid source = local_grid(prepared.source);
  std::vector<PlacedMap> maps;
  if (view.map != MapView::Map::kSource) {
    maps.push_back({&target, {}});
  }
  if (view.map != MapView::Map::kTarget) {
    maps.push_back({&source, view.map == MapView::Map::kBoth ? view.local_target_from_source : Pose2{}});
  }
  const GridGeometry canvas = drawing::canvas_round(maps, shown_bounds(maps, view), kLargest);
  const double tolerance_m = 2 * canvas.resolution_m;
  cv::Mat cells =
      drawing::paint_cells(maps, canvas, tolerance_m, num_threads, view.map == MapView::Map::kSource ? 1 : 0);
  cells.forEach<cv::Vec3b>([](cv::Vec3b& at, const int*) { at = drawing::pixel(faded({at[0], at[1], at[2]})); });
  const int cell_px = std::clamp(kLargest / std::max(canvas.width, canvas.height), 1, kLargestCell);
  cv::resize(cells, cells, {}, cell_px, cell_px, cv::INTER_NEAREST);

  const Pose2 canvas_from_view = inverse(canvas.map_from_grid);
  const double px_per_m = cell_px / canvas.resolution_m;
  const std::vector<Colour> colours = colours_of(view.shapes);
  for (std::size_t i = view.shapes.size(); i-- > 0;) {  // the first on top
    std::vector<cv::Point> points;
    for (const Point2& point : view.shapes[i].points) {
      const Point2 at = canvas_from_view * point;
      points.push_back(fractional({at.x_m * px_per_m, cells.rows - at.y_m * px_per_m}));
    }
    draw_shape(cells, points, view.shapes[i].kind, colours[i]);
  }

  const int width_px = std::max(cells.cols, kNarrowest);
  const double ruler_m = round_length(0.25 * width_px / px_per_m);
  const Legend legend(map_legend(view, ruler_m * px_per_m, drawing::metres(ruler_m)), 1.1);
  const cv::Rect area(kEdge + (width_px - cells.cols) / 2, kEdge, cells.cols, cells.rows);
  ViewPicture picture{
      .image = drawing::blank_image(width_px + 2 * kEdge, area.br().y + legend.height(width_px) + 2 * kEdge),
      .left_px = area.x,
      .top_px = area.y,
      .width_px = area.width,
      .height_px = area.height,
      .low = canvas.map_from_grid.translation(),
      .high = canvas.map_from_grid.translation() + Point2{area.width / px_per_m, area.height / px_per_m}};
  cv::Mat image = drawing::matrix_of(picture.image);
  cells.copyTo(image(area));
  cv::rectangle(image, area + cv::Size(2, 2) - cv::Point(1, 1), drawing::scalar(kFrameColour));
  legend.draw(image, {kEdge, area.br().y + kEdge}, width_px);
  return picture;
}

}  // namespace

Colour ViewPicture::colour_at(Point2 in_view) const {
  const double x = (in_view.x_m - low.x_m) / (high.x_m - low.x_m) * width_px;
  const double y = (high.y_m - in_view.y_m) / (high.y_m - low.y_m) * height_px;
  return drawing::colour_at(image, {left_px + std::clamp(static_cast<int>(x), 0, width_px - 1),
                                    top_px + std::clamp(static_cast<int>(y), 0, height_px - 1)});
}

ViewPicture draw_view(const View& view, const ViewedMaps& maps, int num_threads) {
  if (const auto* surface = std::get_if<SurfaceView>(&view.content)) {
    return draw(*surface, view.name);
  }
  if (const auto* curves = std::get_if<CurvesView>(&view.content)) {
    return draw(*curves, view.name);
  }
  return draw(std::get<MapView>(view.content), view.name, maps, num_threads);
}

}  // namespace gridmerge
