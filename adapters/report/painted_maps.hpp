#pragma once
/// Maps as coloured cells, one pixel a cell: the ground of the overlay and of views. Only for this folder's .cpp files.
#include <opencv2/core.hpp>
#include <vector>

#include "gridmerge/fuse/resample.hpp"

namespace gridmerge::drawing {

/// The smallest box, upright in `frame`, round the known cells of all maps; of the first map's first cell, if nothing
/// is known.
[[nodiscard]] Bounds known_by_any(const std::vector<PlacedMap>& maps, const Pose2& frame_from_merged);

/// The smallest box round both.
[[nodiscard]] Bounds joined(const Bounds& a, const Bounds& b);

/// Where the cells of the first map begin, as a frame in the merged one.
[[nodiscard]] Pose2 merged_from_first_cells(const std::vector<PlacedMap>& maps);

/// Cells along those of the first map round the bounds, with an edge; as fine as its own if there is room for that.
/// @param bounds  upright in the frame of merged_from_first_cells
[[nodiscard]] GridGeometry canvas_round(const std::vector<PlacedMap>& maps, const Bounds& bounds, int max_side_cells);

/// The canvas as an RGB image of one pixel a cell, the last row on top.
/// @param tolerance_m  walls no farther apart agree
/// @param first_colour  the first map's place in the palette
[[nodiscard]] cv::Mat paint_cells(const std::vector<PlacedMap>& maps, const GridGeometry& canvas, double tolerance_m,
                                  int num_threads, std::size_t first_colour = 0);

}  // namespace gridmerge::drawing
