#pragma once
/// Runs that went wrong, as pictures.
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "study/row.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::page {

/// The maps of a row, and, where they were drawn, the place and the ways.
struct PairMaps {
  OccupancyGrid target;
  OccupancyGrid source;
  std::optional<worlds::Tracks> tracks;
};

/// What can be seen of one run: PNG files, empty where there is no such picture.
struct FailurePicture {
  std::int64_t run = 0;
  std::string found = {};  ///< both maps at the pose found
  std::string truth = {};  ///< at the true pose
  std::string scene = {};  ///< the place and both ways
  std::string note = {};   ///< why there is no picture at all; else empty
};

struct FailureOptions {
  int most = 40;
  int max_side_px = 700;  ///< >= 400, of a picture
  int num_threads = 1;    ///< the pictures are the same at any number
  /// Makes or reads the maps again (see Row::pair_spec). Called from several threads. An InputError becomes the note.
  std::function<PairMaps(const study::Row&)> maps_of = {};
};

/// Places of the failures that are shown, the gravest first: merged though nothing is shared, merged elsewhere, missed.
/// Missed ones only where there is room left. By turns from all sets and methods, the most confident first; from
/// another pair each time while there are such. Runs of more than two robots are passed over.
[[nodiscard]] std::vector<std::size_t> choose_failures(std::span<const study::Row> rows, int most);

/// The pictures of those.
[[nodiscard]] std::vector<FailurePicture> draw_failures(std::span<const study::Row> rows,
                                                        const FailureOptions& options);

}  // namespace gridmerge::page
