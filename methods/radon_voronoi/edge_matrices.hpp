#pragma once
/// The edges of a Voronoi diagram as small matrices, and their 2-D cross-correlation: how the published method finds
/// the translation.
#include <cstdint>
#include <vector>

#include "methods/radon_voronoi/radon.hpp"
#include "methods/radon_voronoi/voronoi.hpp"

namespace gridmerge::voronoi {

/// An edge on the lattice of cells that both maps share once the source is turned: cell (c, r) of it covers
/// [c, c+1) x [r, r+1) cells from the target's local origin.
struct EdgeMatrix {
  int low_column = 0;
  int low_row = 0;
  int width = 0;
  int height = 0;
  std::vector<float> value;  ///< row-major from the lower left: how sure it is that the edge runs there
  double norm = 0;           ///< root of the sum of squares
  int cells = 0;             ///< that the edge was made of
};

/// How a map's edges become matrices.
struct EdgeRaster {
  double cell_m = 0.1;
  int shortest_cells = 6;  ///< edges of fewer cells are left out
  double most_blur_m = 0;  ///< what the rotation's uncertainty may blur an edge by, at the most
};

/// Every edge of a diagram, turned; the uncertainty of the turn blurs it the more the farther out it lies.
[[nodiscard]] std::vector<EdgeMatrix> edge_matrices(const Diagram& diagram, const radon::Rotation& rotation,
                                                    const EdgeRaster& raster);

/// The shift of b at which it lies best on a.
struct EdgeMatch {
  double columns = 0;
  double rows = 0;
  double likeness = 0;  ///< normalised correlation, 0..1
};
[[nodiscard]] EdgeMatch cross_correlate(const EdgeMatrix& a, const EdgeMatrix& b);

}  // namespace gridmerge::voronoi
