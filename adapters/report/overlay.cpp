#include "report/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

namespace gridmerge {
namespace {

constexpr Colour kPaper{0xFF, 0xFF, 0xFF};
constexpr Colour kInk{0x30, 0x34, 0x38};
constexpr Colour kFrame{0xA8, 0xAC, 0xB0};

struct MapColours {
  Colour wall;
  Colour free;
};
// After Okabe, Ito: "Color universal design" (2008).
constexpr std::array<MapColours, 6> kPalette{{{{0x00, 0x72, 0xB2}, {0xDD, 0xEB, 0xF7}},
                                              {{0xE6, 0x9F, 0x00}, {0xFB, 0xEE, 0xD0}},
                                              {{0x00, 0x9E, 0x73}, {0xD8, 0xF0, 0xE6}},
                                              {{0x56, 0xB4, 0xE9}, {0xE4, 0xF4, 0xFD}},
                                              {{0x94, 0x67, 0xBD}, {0xEC, 0xE4, 0xF4}},
                                              {{0x8C, 0x56, 0x4B}, {0xF0, 0xE4, 0xE1}}}};

cv::Vec3b pixel(Colour colour) { return {colour.red, colour.green, colour.blue}; }
cv::Scalar scalar(Colour colour) { return {double(colour.red), double(colour.green), double(colour.blue)}; }

/// What one map says of the cells of the canvas.
struct Layer {
  OccupancyGrid grid;
  cv::Mat near_wall;  ///< 255 within the tolerance of a wall
};

Layer make_layer(const PlacedMap& map, const GridGeometry& canvas, double tolerance_m, int num_threads) {
  Layer layer{resample(map, canvas, num_threads), {}};
  const cv::Mat cells(canvas.height, canvas.width, CV_8S, layer.grid.cells.data());
  cv::Mat distance_cells;
  cv::distanceTransform(cells <= kUndecided, distance_cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  layer.near_wall = distance_cells <= tolerance_m / canvas.resolution_m + 1e-3;
  return layer;
}

Colour cell_colour(const std::vector<Layer>& layers, CellIndex cell) {
  Colour wall = kPaper;
  Colour free = kUnknownColour;
  bool any_wall = false;
  bool agreement = false;
  bool conflict = false;
  int free_maps = 0;
  for (std::size_t map = 0; map < layers.size(); ++map) {
    const std::int8_t value = layers[map].grid.at(cell);
    if (value > kUndecided) {
      wall = any_wall ? wall : wall_colour(map);
      any_wall = true;
      for (std::size_t other = 0; other < layers.size(); ++other) {
        const bool near_wall = layers[other].near_wall.at<std::uint8_t>(cell.row, cell.column) != 0;
        agreement |= other != map && near_wall;
        conflict |= other != map && !near_wall && layers[other].grid.at(cell) >= 0;
      }
    } else if (value >= 0) {
      free = ++free_maps == 1 ? free_colour(map) : kFreeOfSeveralColour;
    }
  }
  return conflict ? kConflictColour : agreement ? kAgreementColour : any_wall ? wall : free;
}

/// The canvas as an image of one pixel a cell, the last row on top.
cv::Mat paint_cells(const std::vector<Layer>& layers, const GridGeometry& canvas) {
  cv::Mat image(canvas.height, canvas.width, CV_8UC3);
  for (int row = 0; row < canvas.height; ++row) {
    auto* pixels = image.ptr<cv::Vec3b>(canvas.height - 1 - row);
    for (int column = 0; column < canvas.width; ++column) {
      pixels[column] = pixel(cell_colour(layers, {column, row}));
    }
  }
  return image;
}

/// Upright in the first map's cells, round everything that any map knows.
GridGeometry make_canvas(const std::vector<OverlayMap>& maps, int max_side_cells) {
  const GridGeometry& target = maps.front().placed.grid->geometry;
  const Pose2 merged_from_frame = maps.front().placed.merged_from_map * target.map_from_grid;
  std::optional<Bounds> all;
  for (const OverlayMap& map : maps) {
    if (const auto bounds = known_bounds(map.placed, inverse(merged_from_frame))) {
      all = all ? Bounds{{std::min(all->low.x_m, bounds->low.x_m), std::min(all->low.y_m, bounds->low.y_m)},
                         {std::max(all->high.x_m, bounds->high.x_m), std::max(all->high.y_m, bounds->high.y_m)}}
                : *bounds;
    }
  }
  const Bounds bounds = all.value_or(Bounds{{0, 0}, {target.resolution_m, target.resolution_m}});
  const Point2 size = bounds.high - bounds.low;
  constexpr int kEdgeCells = 4;
  const double resolution_m =
      std::max(target.resolution_m, std::max(size.x_m, size.y_m) / (max_side_cells - 2 * kEdgeCells - 2));
  // Whole cells from the target's origin: at the target's own resolution its cells are drawn as they are.
  const double left = std::floor(bounds.low.x_m / resolution_m + 1e-3) - kEdgeCells;
  const double bottom = std::floor(bounds.low.y_m / resolution_m + 1e-3) - kEdgeCells;
  const Point2 corner = merged_from_frame * Point2{left * resolution_m, bottom * resolution_m};
  return {static_cast<int>(std::ceil(bounds.high.x_m / resolution_m - 1e-3) - left) + kEdgeCells,
          static_cast<int>(std::ceil(bounds.high.y_m / resolution_m - 1e-3) - bottom) + kEdgeCells,
          resolution_m,
          {corner.x_m, corner.y_m, merged_from_frame.theta_rad}};
}

/// Conflicts grow by a cell on all sides: a person looks for them first.
void embolden_conflicts(cv::Mat& image) {
  cv::Mat conflicts;
  cv::inRange(image, scalar(kConflictColour), scalar(kConflictColour), conflicts);
  cv::dilate(conflicts, conflicts, {});
  image.setTo(scalar(kConflictColour), conflicts);
}

std::string printable(std::string text) {
  constexpr std::size_t kLongest = 40;
  if (text.size() > kLongest) {
    text = text.substr(0, kLongest / 2 - 2) + "..." + text.substr(text.size() - kLongest / 2 + 1);
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

std::string metres(double length_m) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g m", length_m);
  return text.data();
}

/// The longest of 1, 2, 5 times a power of ten that is not longer.
double round_length(double length_m) {
  const double power = std::pow(10.0, std::floor(std::log10(length_m)));
  const double digits = length_m / power;
  return (digits >= 5 ? 5 : digits >= 2 ? 2 : 1) * power;
}

/// An item of the legend: a patch of one colour, or of a wall and a free colour side by side, and its text.
struct LegendEntry {
  std::string text;
  Colour wall;
  Colour free;
};

std::vector<LegendEntry> legend(const std::vector<OverlayMap>& maps, const std::string& tolerance) {
  std::vector<LegendEntry> entries;
  for (std::size_t map = 0; map < maps.size(); ++map) {
    entries.push_back({printable(maps[map].name), wall_colour(map), free_colour(map)});
  }
  const bool two = maps.size() <= 2;
  entries.push_back(
      {std::string(two ? "both" : "several") + ", walls within " + tolerance, kAgreementColour, kFreeOfSeveralColour});
  entries.push_back({std::string("conflict: a wall in ") + (two ? "the other's" : "another's") + " free space",
                     kConflictColour, kConflictColour});
  entries.push_back({"unknown", kUnknownColour, kUnknownColour});
  return entries;
}

/// The strip under the canvas: scale bar and legend, set in lines as a text is.
class Footer {
 public:
  Footer(std::vector<LegendEntry> entries, double scale) : entries_(std::move(entries)), scale_(scale) {}

  /// Draws into a strip that is `width_px` wide; an empty image: only measures. @return the height
  int draw(cv::Mat image, cv::Point corner, int width_px, double bar_px, const std::string& bar_text) const {
    cv::Point at = corner;
    const auto next = [&](int item_px) {  // where an item of that width goes
      if (at.x > corner.x && at.x + item_px > corner.x + width_px) {
        at = {corner.x, at.y + px(kLine)};
      }
      const cv::Point left = at;
      at.x += item_px + px(kGap);
      return left;
    };
    const cv::Size bar(static_cast<int>(std::lround(bar_px)), px(4));
    const cv::Point bar_corner = next(bar.width + px(kPad) + text_px(bar_text));
    if (!image.empty()) {
      const int middle = bar_corner.y + px(kLine) / 2;
      fill(image, {{bar_corner.x, middle - bar.height / 2}, bar}, kInk);
      for (const int x : {bar_corner.x, bar_corner.x + bar.width - px(2)}) {
        fill(image, {x, middle - px(6), px(2), px(12)}, kInk);
      }
      write(image, bar_text, {bar_corner.x + bar.width + px(kPad), bar_corner.y});
    }
    for (const LegendEntry& entry : entries_) {
      const cv::Size patch(px(30), px(15));
      const cv::Point left = next(patch.width + px(kPad) + text_px(entry.text));
      if (!image.empty()) {
        const cv::Rect frame({left.x, left.y + (px(kLine) - patch.height) / 2}, patch);
        fill(image, frame, entry.free);
        fill(image, {frame.tl(), cv::Size(entry.wall == entry.free ? patch.width : patch.width / 2, patch.height)},
             entry.wall);
        cv::rectangle(image, frame, scalar(kFrame));
        write(image, entry.text, {left.x + patch.width + px(kPad), left.y});
      }
    }
    return at.y + px(kLine) - corner.y;
  }

 private:
  [[nodiscard]] int px(int at_scale_one) const { return static_cast<int>(std::lround(at_scale_one * scale_)); }
  [[nodiscard]] int text_px(const std::string& text) const {
    int baseline = 0;
    return cv::getTextSize(text, kFont, kFontScale * scale_, 1, &baseline).width;
  }
  void write(cv::Mat& image, const std::string& text, cv::Point line_corner) const {
    cv::putText(image, text, line_corner + cv::Point(0, px(kLine) / 2 + px(5)), kFont, kFontScale * scale_,
                scalar(kInk), 1, cv::LINE_AA);
  }
  static void fill(cv::Mat& image, const cv::Rect& box, Colour colour) {
    cv::rectangle(image, box, scalar(colour), cv::FILLED);
  }

  static constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  static constexpr double kFontScale = 0.46;
  static constexpr int kLine = 26;  // pixels at scale 1
  static constexpr int kGap = 24;
  static constexpr int kPad = 8;
  std::vector<LegendEntry> entries_;
  double scale_;
};

void check(const std::vector<OverlayMap>& maps, const OverlayOptions& options) {
  if (maps.empty()) {
    throw std::invalid_argument("overlay: there must be at least one map");
  }
  for (const OverlayMap& map : maps) {
    check_placed_map(map.placed, "overlay");
  }
  if (!(options.tolerance_cells >= 0) || options.max_side_px < 400) {
    throw std::invalid_argument("overlay: tolerance_cells must be >= 0 and max_side_px >= 400");
  }
}

}  // namespace

Colour wall_colour(std::size_t map) { return kPalette[map % kPalette.size()].wall; }
Colour free_colour(std::size_t map) { return kPalette[map % kPalette.size()].free; }

Colour Overlay::colour_at(Point2 in_merged) const {
  const CellIndex cell = canvas.cell_at(in_merged);
  const int x = left_px + cell.column * pixels_a_cell + pixels_a_cell / 2;
  const int y = top_px + (canvas.height - 1 - cell.row) * pixels_a_cell + pixels_a_cell / 2;
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {image.samples[at], image.samples[at + 1], image.samples[at + 2]};
}

Overlay draw_overlay(const std::vector<OverlayMap>& maps, const OverlayOptions& options, int num_threads) {
  constexpr int kMargin = 16;       // [px], round everything
  constexpr int kNarrowest = 480;   // [px], so that the legend can be read
  constexpr int kGoal = 1600;       // [px], up to which small maps are enlarged
  constexpr int kLargestCell = 16;  // [px]
  check(maps, options);
  const int narrowest_px = std::min(kNarrowest, options.max_side_px - 2 * kMargin);
  const int tallest_footer = Footer(legend(maps, "0.000 m"), 1).draw({}, {}, narrowest_px, narrowest_px / 4.0, "100 m");
  const int room_px = std::max(100, options.max_side_px - 3 * kMargin - tallest_footer);

  Overlay overlay;
  overlay.canvas = make_canvas(maps, room_px);
  const GridGeometry& canvas = overlay.canvas;
  const double tolerance_m =
      std::max(options.tolerance_cells * maps.front().placed.grid->geometry.resolution_m, canvas.resolution_m);
  std::vector<Layer> layers;
  for (const OverlayMap& map : maps) {
    layers.push_back(make_layer(map.placed, canvas, tolerance_m, num_threads));
  }
  cv::Mat cells = paint_cells(layers, canvas);
  overlay.pixels_a_cell = std::clamp(std::min(kGoal, room_px) / std::max(canvas.width, canvas.height), 1, kLargestCell);
  if (overlay.pixels_a_cell == 1) {
    embolden_conflicts(cells);
  }
  cv::resize(cells, cells, {}, overlay.pixels_a_cell, overlay.pixels_a_cell, cv::INTER_NEAREST);

  const int width_px = std::max(cells.cols, narrowest_px);
  const Footer footer(legend(maps, metres(tolerance_m)), std::clamp(width_px / 1000.0, 1.0, 1.6));
  const double bar_m = round_length(0.25 * width_px * canvas.resolution_m / overlay.pixels_a_cell);
  const double bar_px = bar_m / canvas.resolution_m * overlay.pixels_a_cell;
  const int footer_px = footer.draw({}, {}, width_px, bar_px, metres(bar_m));

  RasterImage& image = overlay.image;
  image = {width_px + 2 * kMargin, cells.rows + footer_px + 3 * kMargin, 3, {}};
  image.samples.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  overlay.left_px = kMargin + (width_px - cells.cols) / 2;
  overlay.top_px = kMargin;
  cv::Mat picture(image.height, image.width, CV_8UC3, image.samples.data());
  picture = scalar(kPaper);
  const cv::Rect area(overlay.left_px, overlay.top_px, cells.cols, cells.rows);
  cells.copyTo(picture(area));
  cv::rectangle(picture, area + cv::Size(2, 2) - cv::Point(1, 1), scalar(kFrame));
  footer.draw(picture, {kMargin, area.br().y + kMargin}, width_px, bar_px, metres(bar_m));
  return overlay;
}

}  // namespace gridmerge
