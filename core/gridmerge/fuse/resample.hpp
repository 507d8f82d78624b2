#pragma once
/// A placed map on the cells of another grid: what the fusion rules and the overlay picture look at.
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// A map and where its map frame lies in the merged one. The grid is borrowed, never null.
struct PlacedMap {
  const OccupancyGrid* grid = nullptr;
  Pose2 merged_from_map;
};

/// @throws std::invalid_argument naming `owner`, if there is no grid, it is malformed (see check_grid) or the pose is
/// not finite
void check_placed_map(const PlacedMap& map, const std::string& owner);

/// Above it a cell is more likely a wall than not [percent].
inline constexpr std::int8_t kUndecided = 50;

struct Bounds {
  Point2 low;
  Point2 high;
};

/// The smallest box, upright in `frame`, round all known cells of a map; none if it knows nothing.
[[nodiscard]] std::optional<Bounds> known_bounds(const PlacedMap& map, const Pose2& frame_from_merged);

/// A rectangle of cells.
struct CellBox {
  CellIndex first;
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Tiles that cover a grid: small enough that what is read into one stays in the cache, square so that the cells under
/// a turned one lie close together.
[[nodiscard]] std::vector<CellBox> tiles(const GridGeometry& geometry);

/// Reads a placed map in the cells of another grid.
///
/// - A map that differs by whole cells only (to a thousandth of a cell) is copied.
/// - Else each cell looks up the source cell under its centre: no holes, and nothing is left out but a fringe of half a
///   cell. Where the source is finer, a cell is the mean of the known source cells centred in it.
/// - Walls come on top, and win over free space within a cell: every source wall is drawn, from cell centre to the
///   centres of its neighbours. So a wall of one cell stays connected at any turn and any resolution (side by side
///   where it was side by side, corner to corner where it was so), and no obstacle falls between two samples. The
///   price: a wall may grow by half a cell.
///
/// Const and reentrant. The map must outlive it.
class Resampler {
 public:
  Resampler(const PlacedMap& map, const GridGeometry& onto);

  /// Fills `cells` (row-major, box.width * box.height) with -1..100; the box may reach beyond both grids.
  /// @return whether any of them is known
  bool read(const CellBox& box, std::span<std::int8_t> cells) const;

 private:
  class Canvas;
  [[nodiscard]] CellBox source_cells_under(const CellBox& box) const;
  void copy(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const;
  void look_up(const CellBox& box, std::span<std::int8_t> cells) const;
  void average(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const;
  void draw_walls(const CellBox& box, const CellBox& source, std::span<std::int8_t> cells) const;
  [[nodiscard]] std::int8_t wall_at(int column, int row) const;

  const OccupancyGrid* grid_;
  Eigen::Affine2d merged_from_source_;  // between cell coordinates, of which a cell covers [column, column + 1)
  Eigen::Affine2d source_from_merged_;
  std::optional<CellIndex> whole_cells_;  // merged from source, where the maps differ by whole cells only
  bool source_is_finer_;
};

/// The whole of `onto` read from one map.
[[nodiscard]] OccupancyGrid resample(const PlacedMap& map, const GridGeometry& onto, int num_threads = 1);

}  // namespace gridmerge
