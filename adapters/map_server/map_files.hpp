#pragma once
/// Maps as ROS map_server and Nav2 keep them: a YAML description and an image beside it.
#include <filesystem>
#include <string>
#include <string_view>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "map_server/raster_image.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge {

/// How pixels become cells. With p = how dark the pixel is, 0 .. 1 (how bright, if negated):
enum class MapMode {
  kTrinary,  ///< p > occupied_thresh: 100; p < free_thresh: 0; between: unknown
  kScale,    ///< the same, but 1 .. 99 between; what is not opaque is unknown
  kRaw,      ///< a pixel of 0 .. 100 is the cell's value; any other: unknown
};

/// What the YAML file says.
struct MapDescription {
  std::string image;  ///< as written: relative to the YAML's folder, or absolute
  double resolution_m = 0;
  Pose2 map_from_grid;  ///< `origin`
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  MapMode mode = MapMode::kTrinary;
};

/// Reads a map. Where the two differ it does as map_server of ROS 1 (Noetic) does; see README.md.
/// @throws InputError naming file, key, value and rule for whatever is wrong with either file.
[[nodiscard]] OccupancyGrid read_map(const std::filesystem::path& yaml, const MapLimits& limits = {});

/// The same from memory, in two steps. `name` stands for the file in messages.
/// @throws InputError telling every problem, with its line.
[[nodiscard]] MapDescription parse_map_description(std::string_view yaml, const std::string& name);
/// @throws std::invalid_argument if the image has not as many samples as its size says.
[[nodiscard]] OccupancyGrid grid_from_image(const RasterImage& image, const MapDescription& description);

enum class ImageFormat { kPgm, kPng };

struct WriteOptions {
  /// kTrinary keeps free (below 19.6 %), occupied (65 % and up), unknown; kScale and kRaw keep every value.
  MapMode mode = MapMode::kTrinary;
  ImageFormat format = ImageFormat::kPgm;  ///< kScale needs kPng: it marks unknown cells by transparency
};

/// Writes the map to `yaml` and to an image of the same name with the format's extension beside it, both whole or
/// neither. read_map, map_server and Nav2 load it.
/// @throws InputError naming the file that cannot be written; std::invalid_argument if the grid is empty or breaks
/// check_grid, or for kScale with kPgm.
void write_map(const OccupancyGrid& grid, const std::filesystem::path& yaml, const WriteOptions& options = {});

/// The same as part of a larger set of files: nothing is in place before `files.commit()`.
void stage_map(WholeFiles& files, const OccupancyGrid& grid, const std::filesystem::path& yaml,
               const WriteOptions& options = {});

}  // namespace gridmerge
