#pragma once
/// What a method sees inside, as a picture. The title is left to the page that shows it.
#include "gridmerge/base/view.hpp"
#include "gridmerge/grid/prepared_map.hpp"
#include "map_server/raster_image.hpp"
#include "report/colours.hpp"

namespace gridmerge {

/// The maps that a MapView is laid on; borrowed.
struct ViewedMaps {
  const PreparedMap& target;
  const PreparedMap& source;
};

/// The picture, and where the view's axes lie in it.
struct ViewPicture {
  static constexpr int kWidest_px = 1200;

  RasterImage image;  ///< RGB, no wider than that
  int left_px = 0;    ///< of the area that is plotted
  int top_px = 0;
  int width_px = 0;
  int height_px = 0;
  Point2 low;   ///< what the area's lower left and upper right corners stand for, in the axes' units; of a MapView, in
  Point2 high;  ///< the local frame that it is drawn in [m]

  /// The colour drawn at a point of the area.
  [[nodiscard]] Colour colour_at(Point2 in_view) const;
};

/// - A surface becomes a heat map: where a pixel holds several numbers, it shows the largest; what is not finite is
///   grey. Marks are numbered rings. Axes of one unit are drawn at one scale.
/// - Curves share their axes; numbers that are not finite leave a gap. Marks are upright lines, dashed and numbered.
/// - A map lies faded under its shapes, in the colours of the overlay. Shapes of one label share colour and legend.
/// @throws std::invalid_argument naming the view and the rule, if counts do not fit, an axis has no extent, or a point
/// or a pose is not finite
[[nodiscard]] ViewPicture draw_view(const View& view, const ViewedMaps& maps, int num_threads = 1);

}  // namespace gridmerge
