#include "report/overlay.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "report/axis.hpp"
#include "report/drawing.hpp"
#include "report/painted_maps.hpp"

namespace gridmerge {
namespace {

using drawing::Legend;
using drawing::LegendEntry;
using drawing::metres;

/// Conflicts grow by a cell on all sides: a person looks for them first.
void embolden_conflicts(cv::Mat& image) {
  cv::Mat conflicts;
  cv::inRange(image, drawing::scalar(kConflictColour), drawing::scalar(kConflictColour), conflicts);
  cv::dilate(conflicts, conflicts, {});
  image.setTo(drawing::scalar(kConflictColour), conflicts);
}

std::vector<LegendEntry> legend(const std::vector<OverlayMap>& maps, const std::string& tolerance, double ruler_px,
                                const std::string& ruler_text) {
  std::vector<LegendEntry> entries = {{.text = ruler_text, .sign = LegendEntry::Sign::kRuler, .ruler_px = ruler_px}};
  const auto add = [&](std::string text, Colour wall, Colour free) {
    entries.push_back({.text = std::move(text), .colour = wall, .second = free});
  };
  for (std::size_t map = 0; map < maps.size(); ++map) {
    add(drawing::printable(maps[map].name), wall_colour(map), free_colour(map));
  }
  const bool two = maps.size() <= 2;
  add(std::string(two ? "both" : "several") + ", walls within " + tolerance, kAgreementColour, kFreeOfSeveralColour);
  add(std::string("conflict: a wall in ") + (two ? "the other's" : "another's") + " free space", kConflictColour,
      kConflictColour);
  add("unknown", kUnknownColour, kUnknownColour);
  return entries;
}

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

std::vector<PlacedMap> placed(const std::vector<OverlayMap>& maps) {
  std::vector<PlacedMap> all;
  for (const OverlayMap& map : maps) {
    all.push_back(map.placed);
  }
  return all;
}

}  // namespace

Colour Overlay::colour_at(Point2 in_merged) const {
  const CellIndex cell = canvas.cell_at(in_merged);
  return drawing::colour_at(image, {left_px + cell.column * pixels_a_cell + pixels_a_cell / 2,
                                    top_px + (canvas.height - 1 - cell.row) * pixels_a_cell + pixels_a_cell / 2});
}

Overlay draw_overlay(const std::vector<OverlayMap>& maps, const OverlayOptions& options, int num_threads) {
  constexpr int kMargin = 16;       // [px], round everything
  constexpr int kNarrowest = 480;   // [px], so that the legend can be read
  constexpr int kGoal = 1600;       // [px], up to which small maps are enlarged
  constexpr int kLargestCell = 16;  // [px]
  check(maps, options);
  const int narrowest_px = std::min(kNarrowest, options.max_side_px - 2 * kMargin);
  const int tallest_legend = Legend(legend(maps, "0.000 m", narrowest_px / 4.0, "100 m"), 1).height(narrowest_px);
  const int room_px = std::max(100, options.max_side_px - 3 * kMargin - tallest_legend);

  Overlay overlay;
  const std::vector<PlacedMap> all = placed(maps);
  overlay.canvas =
      drawing::canvas_round(all, drawing::known_by_any(all, inverse(drawing::merged_from_first_cells(all))), room_px);
  const GridGeometry& canvas = overlay.canvas;
  const double tolerance_m =
      std::max(options.tolerance_cells * maps.front().placed.grid->geometry.resolution_m, canvas.resolution_m);
  cv::Mat cells = drawing::paint_cells(all, canvas, tolerance_m, num_threads);
  overlay.pixels_a_cell = std::clamp(std::min(kGoal, room_px) / std::max(canvas.width, canvas.height), 1, kLargestCell);
  if (overlay.pixels_a_cell == 1) {
    embolden_conflicts(cells);
  }
  cv::resize(cells, cells, {}, overlay.pixels_a_cell, overlay.pixels_a_cell, cv::INTER_NEAREST);

  const int width_px = std::max(cells.cols, narrowest_px);
  const double ruler_m = round_length(0.25 * width_px * canvas.resolution_m / overlay.pixels_a_cell);
  const double ruler_px = ruler_m / canvas.resolution_m * overlay.pixels_a_cell;
  const Legend strip(legend(maps, metres(tolerance_m), ruler_px, metres(ruler_m)),
                     std::clamp(width_px / 1000.0, 1.0, 1.6));

  overlay.left_px = kMargin + (width_px - cells.cols) / 2;
  overlay.top_px = kMargin;
  overlay.image = drawing::blank_image(width_px + 2 * kMargin, cells.rows + strip.height(width_px) + 3 * kMargin);
  cv::Mat picture = drawing::matrix_of(overlay.image);
  const cv::Rect area(overlay.left_px, overlay.top_px, cells.cols, cells.rows);
  cells.copyTo(picture(area));
  cv::rectangle(picture, area + cv::Size(2, 2) - cv::Point(1, 1), drawing::scalar(kFrameColour));
  strip.draw(picture, {kMargin, area.br().y + kMargin}, width_px);
  return overlay;
}

}  // namespace gridmerge
