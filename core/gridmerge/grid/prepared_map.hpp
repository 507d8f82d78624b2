#pragma once
/// A map made ready for aligning: cropped to what is known, brought to a chosen resolution, with everything that
/// methods and the Evaluator ask of it computed once.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

enum class CellState : std::uint8_t { kUnseen = 0, kOpen = 1, kWall = 2 };

struct PrepareOptions {
  double finest_resolution_m = 0.05;
  int occupied_percent = 65;
  int free_percent = 25;

  void describe(OptionList& list);
};

/// A point of the local frame, in single precision: a map is rarely wider than a few hundred metres.
struct Point2f {
  float x_m = 0;
  float y_m = 0;
};

/// An occupied cell with what its neighbourhood tells of the surface it belongs to. Both vectors are unit vectors, or
/// zero where that is not clear.
struct WallPoint {
  Point2f at;              ///< cell centre, local frame
  Point2f free_normal;     ///< towards the free space it was seen from; zero as well where it was seen from both sides
  Point2f surface_normal;  ///< across the wall, of either sign
};

/// One resolution of a map. Row-major from the lower left, in the map's local frame.
struct MapLevel {
  int width = 0;
  int height = 0;
  double resolution_m = 0;
  Point2 lower_left;  ///< outer corner of cell (0, 0), local frame
  std::vector<CellState> state;
  std::vector<float> wall_distance_m;  ///< cell centre to nearest occupied cell's centre; kFarFromWalls if none

  [[nodiscard]] bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height;
  }
  [[nodiscard]] std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  /// The cell that holds a point of the local frame. The point must lie within the level.
  [[nodiscard]] CellIndex cell_at(Point2f at) const {
    return {static_cast<int>((at.x_m - lower_left.x_m) / resolution_m),
            static_cast<int>((at.y_m - lower_left.y_m) / resolution_m)};
  }
};

inline constexpr float kFarFromWalls = 1e6F;

/// Const after construction, so shared by any number of threads. Holds no reference to the grid it was made from.
///
/// The *local frame*: axes along the map's cells, origin at the centre of the known cells. Rotations about that centre
/// move the map least, and single precision is enough there however far off the map's own origin lies.
class PreparedMap {
 public:
  static constexpr int kLevels = 5;

  /// @param grid  a valid grid (check_grid)
  /// @param resolution_m  side of a cell of level 0; not finer than the grid's own resolution
  /// @param num_threads  does not change the result
  /// @throws std::invalid_argument if the options or the resolution are out of range
  PreparedMap(const OccupancyGrid& grid, double resolution_m, const PrepareOptions& options = {}, int num_threads = 1);

  /// The map as a mirror along the local x axis shows it: a place as large, with walls as many and as straight, that is
  /// not there. Its local frame stands for its map frame as well.
  /// @param finest_level  levels finer than that are left empty, and so is the occupancy then
  [[nodiscard]] PreparedMap mirrored(int finest_level = 0) const;

  [[nodiscard]] const Pose2& map_from_local() const { return map_from_local_; }
  [[nodiscard]] double resolution_m() const { return resolution_m_; }
  /// Level 0 is the finest; each next one has cells twice as wide. Level 0 alone where nothing is known.
  [[nodiscard]] const MapLevel& level(int k) const { return levels_[static_cast<std::size_t>(k)]; }
  /// Row by row from below, each from the left.
  [[nodiscard]] const std::vector<WallPoint>& walls() const { return walls_; }
  /// Radius round the local origin within which all known cells lie [m].
  [[nodiscard]] double radius_m() const { return radius_m_; }
  [[nodiscard]] double known_area_m2() const { return known_area_m2_; }
  [[nodiscard]] std::size_t known_cells() const { return known_cells_; }
  /// Occupancy in percent of each cell of level 0, -1 unknown.
  [[nodiscard]] const std::vector<std::int8_t>& occupancy() const { return occupancy_; }
  [[nodiscard]] Point2 centre_in_map() const { return map_from_local_.translation(); }

 private:
  PreparedMap() = default;

  Pose2 map_from_local_;
  double resolution_m_ = 0;
  double radius_m_ = 0;
  double known_area_m2_ = 0;
  std::size_t known_cells_ = 0;
  std::vector<std::int8_t> occupancy_;
  std::vector<MapLevel> levels_;
  std::vector<WallPoint> walls_;
};

/// The resolution at which two maps are compared: the coarsest of theirs and `finest_resolution_m`.
[[nodiscard]] double common_resolution_m(const OccupancyGrid& a, const OccupancyGrid& b, const PrepareOptions& options);

/// Between local frames, from between map frames, and back.
[[nodiscard]] Pose2 to_local(const Pose2& target_from_source, const PreparedMap& target, const PreparedMap& source);
[[nodiscard]] Pose2 from_local(const Pose2& local_from_local, const PreparedMap& target, const PreparedMap& source);

}  // namespace gridmerge
