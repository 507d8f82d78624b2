#include "report/painted_maps.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "report/drawing.hpp"

namespace gridmerge::drawing {
namespace {

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

Colour cell_colour(const std::vector<Layer>& layers, CellIndex cell, std::size_t first_colour) {
  Colour wall = kPaperColour;
  Colour free = kUnknownColour;
  bool any_wall = false;
  bool agreement = false;
  bool conflict = false;
  int free_maps = 0;
  for (std::size_t map = 0; map < layers.size(); ++map) {
    const std::int8_t value = layers[map].grid.at(cell);
    if (value > kUndecided) {
      wall = any_wall ? wall : wall_colour(first_colour + map);
      any_wall = true;
      for (std::size_t other = 0; other < layers.size(); ++other) {
        const bool near_wall = layers[other].near_wall.at<std::uint8_t>(cell.row, cell.column) != 0;
        agreement |= other != map && near_wall;
        conflict |= other != map && !near_wall && layers[other].grid.at(cell) >= 0;
      }
    } else if (value >= 0) {
      free = ++free_maps == 1 ? free_colour(first_colour + map) : kFreeOfSeveralColour;
    }
  }
  return conflict ? kConflictColour : agreement ? kAgreementColour : any_wall ? wall : free;
}

}  // namespace

Bounds joined(const Bounds& a, const Bounds& b) {
  return {{std::min(a.low.x_m, b.low.x_m), std::min(a.low.y_m, b.low.y_m)},
          {std::max(a.high.x_m, b.high.x_m), std::max(a.high.y_m, b.high.y_m)}};
}

Bounds known_by_any(const std::vector<PlacedMap>& maps, const Pose2& frame_from_merged) {
  std::optional<Bounds> all;
  for (const PlacedMap& map : maps) {
    if (const auto bounds = known_bounds(map, frame_from_merged)) {
      all = all ? joined(*all, *bounds) : *bounds;
    }
  }
  const double cell_m = maps.front().grid->geometry.resolution_m;
  return all.value_or(Bounds{{0, 0}, {cell_m, cell_m}});
}

Pose2 merged_from_first_cells(const std::vector<PlacedMap>& maps) {
  return maps.front().merged_from_map * maps.front().grid->geometry.map_from_grid;
}

GridGeometry canvas_round(const std::vector<PlacedMap>& maps, const Bounds& bounds, int max_side_cells) {
  constexpr int kEdgeCells = 4;
  const Point2 size = bounds.high - bounds.low;
  const double resolution_m = std::max(maps.front().grid->geometry.resolution_m,
                                       std::max(size.x_m, size.y_m) / (max_side_cells - 2 * kEdgeCells - 2));
  // Whole cells from the first map's origin: at its own resolution its cells are drawn as they are.
  const double left = std::floor(bounds.low.x_m / resolution_m + 1e-3) - kEdgeCells;
  const double bottom = std::floor(bounds.low.y_m / resolution_m + 1e-3) - kEdgeCells;
  const Pose2 merged_from_cells = merged_from_first_cells(maps);
  const Point2 corner = merged_from_cells * Point2{left * resolution_m, bottom * resolution_m};
  return {static_cast<int>(std::ceil(bounds.high.x_m / resolution_m - 1e-3) - left) + kEdgeCells,
          static_cast<int>(std::ceil(bounds.high.y_m / resolution_m - 1e-3) - bottom) + kEdgeCells,
          resolution_m,
          {corner.x_m, corner.y_m, merged_from_cells.theta_rad}};
}

cv::Mat paint_cells(const std::vector<PlacedMap>& maps, const GridGeometry& canvas, double tolerance_m, int num_threads,
                    std::size_t first_colour) {
  std::vector<Layer> layers;
  for (const PlacedMap& map : maps) {
    layers.push_back(make_layer(map, canvas, tolerance_m, num_threads));
  }
  cv::Mat image(canvas.height, canvas.width, CV_8UC3);
  for (int row = 0; row < canvas.height; ++row) {
    auto* pixels = image.ptr<cv::Vec3b>(canvas.height - 1 - row);
    for (int column = 0; column < canvas.width; ++column) {
      pixels[column] = pixel(cell_colour(layers, {column, row}, first_colour));
    }
  }
  return image;
}

}  // namespace gridmerge::drawing
