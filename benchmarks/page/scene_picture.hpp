#pragma once
/// The place as it is, and where both robots went in it.
#include "map_server/raster_image.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::page {

/// Walls, trunks and both true ways, each with its start and heading; robots in two worlds get a picture each, side by
/// side or one above the other.
/// @param max_side_px  >= 400, of the whole picture
[[nodiscard]] RasterImage draw_scene(const worlds::Tracks& tracks, int max_side_px = 700);

}  // namespace gridmerge::page
