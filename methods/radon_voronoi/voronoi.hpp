#pragma once
/// The generalised Voronoi diagram (GVD) of a map's free space: the cells that have two walls nearest, thinned to lines
/// one cell wide, cut at their vertices into edges.
#include <cstdint>
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/base/view.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge::voronoi {

/// Distance and index of the nearest marked cell, exact, for every cell of a width x height grid [cells]; Felzenszwalb
/// and Huttenlocher 2012, in linear time. Nothing marked: distance kFarFromWalls, index -1.
struct NearestMarked {
  std::vector<float> distance_cells;
  std::vector<std::int32_t> index;
};
[[nodiscard]] NearestMarked nearest_marked(const std::vector<std::uint8_t>& marked, int width, int height);

/// Whether taking a cell away leaves as many pieces and holes as before. Bit k of `neighbours` is the neighbour in
/// direction k eighths of a turn; foreground is 8-connected.
[[nodiscard]] bool is_simple(std::uint8_t neighbours);

/// Takes cells away in the order of `height`, lowest first, as long as no piece is cut, lost or filled: what is left
/// has the shape of the foreground, lies on the ridges of `height` and is one cell wide. Cells of `anchor` stay unless
/// they only thicken a line. Linear time but for ties in height. Cells on the rim of the grid must be background.
[[nodiscard]] std::vector<std::uint8_t> thinned(std::vector<std::uint8_t> foreground, const std::vector<float>& height,
                                                const std::vector<std::uint8_t>& anchor, int width);

/// Thinning by mathematical morphology: layer after layer off a binary image, deaf to distances (Guo, Hall 1989). Cells
/// on the rim of the grid must be background.
[[nodiscard]] std::vector<std::uint8_t> morphologically_thinned(std::vector<std::uint8_t> foreground, int width);

struct DiagramOptions {
  double cell_m = 0.1;
  double speck_m = 0.3;
  double detail_m = 0.6;
  double opening_deg = 60;
  double spur_m = 0.5;
  double mask_m = 0.3;

  void describe(OptionList& list);
};

/// A cell of the skeleton.
struct RidgePoint {
  Point2f at;              ///< local frame
  float clearance_m = 0;   ///< distance to the nearest walls
  float along_rad = 0;     ///< direction of the line, of either sign: in [0, pi)
  float weight = 0;        ///< 0..1: how sure it is that the cell is free, and that no unseen wall is nearer
  std::int32_t edge = -1;  ///< -1: within the mask of a vertex
};

/// Where at least three branches meet.
struct Vertex {
  Point2f at;
  float clearance_m = 0;
  float weight = 0;
  std::vector<float> branch_rad;  ///< directions in which the branches leave
};

struct Diagram {
  std::vector<RidgePoint> ridge;
  std::vector<Vertex> vertices;
  int edges = 0;
  double cell_m = 0;
};

[[nodiscard]] Diagram diagram(const PreparedMap& map, const DiagramOptions& options);

/// As published: the free cells as a binary image, thinned by morphology; every branch that this leaves counts, and a
/// cell's weight is how sure it is that it is free.
/// @param cell_m, mask_m  as in DiagramOptions
[[nodiscard]] Diagram morphological_diagram(const PreparedMap& map, double cell_m, double mask_m);

[[nodiscard]] View diagram_view(const Diagram& diagram, MapView::Map map);

}  // namespace gridmerge::voronoi
