#pragma once
/// A picture that shows at a glance whether a merge fits.
#include <string>
#include <vector>

#include "gridmerge/fuse/resample.hpp"
#include "map_server/raster_image.hpp"
#include "report/colours.hpp"

namespace gridmerge {

struct OverlayMap {
  PlacedMap placed;
  std::string name;  ///< for the legend; characters outside ASCII are shown as '?'
};

struct OverlayOptions {
  double tolerance_cells = 2;  ///< walls no farther apart agree; in the first map's cells, at least one drawn cell
  int max_side_px = 2000;      ///< >= 400, of the whole picture
};

/// The picture, and where the maps lie in it.
struct Overlay {
  RasterImage image;      ///< RGB
  GridGeometry canvas;    ///< the cells that are drawn, in the merged frame
  int pixels_a_cell = 1;  ///< along either side
  int left_px = 0;        ///< of the canvas's first column
  int top_px = 0;         ///< of the canvas's last row

  /// The colour drawn at the centre of the canvas's cell at a point of the merged frame, which must lie inside.
  [[nodiscard]] Colour colour_at(Point2 in_merged) const;
};

/// Large maps are drawn smaller, in such a way that no wall is lost, and small ones larger.
/// @throws std::invalid_argument if there is no map, one is malformed, its pose is not finite, or an option is out of
/// range
[[nodiscard]] Overlay draw_overlay(const std::vector<OverlayMap>& maps, const OverlayOptions& options = {},
                                   int num_threads = 1);

}  // namespace gridmerge
