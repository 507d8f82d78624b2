#pragma once
/// The fitness of every pose of a lattice, by fast Fourier transform: two cross-correlations an angle.
#include <functional>
#include <span>
#include <vector>

#include "gridmerge/align/pose_lattice.hpp"

namespace gridmerge {

/// Whether every translation has its own place on the torus of an angle's scores.
enum class Torus {
  kWhole,  ///< yes
  /// No: a translation that puts the moving map's centre beyond an edge of the fixed map shares its place with the one
  /// `size` cells back, beyond the opposite edge, and the scores of both are added. Half the work.
  kShared,
};

/// The scores of all translations at one angle, on a torus of `size` columns and rows: those left of the fixed map's
/// first column are found at the far end, rows likewise.
struct ScoreSurface {
  int angle = 0;
  int size = 0;
  int width = 0;  ///< of the fixed map [cells]
  int height = 0;
  int reach = 0;        ///< of the moving map [cells]
  double rounding = 0;  ///< no score here is farther than this from PoseLattice::score
  std::span<const float> score;

  [[nodiscard]] std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size) + static_cast<std::size_t>(column);
  }
  /// A place on the torus as a pose of the lattice; of those that share it, the farthest right and up.
  [[nodiscard]] LatticePose at(int column, int row) const {
    return {angle, column < width + reach ? column : column - size, row < height + reach ? row : row - size};
  }
};

struct LatticePeak {
  LatticePose at;
  float score = 0;
};

/// Local maxima of the surface that score above 0 and that `accept` takes, at most so many: the highest. No particular
/// order.
[[nodiscard]] std::vector<LatticePeak> surface_peaks(const ScoreSurface& surface, int at_most,
                                                     const std::function<bool(const LatticePose&)>& accept);

/// How the scores were found.
struct LatticeScores {
  double poses = 0;      ///< scored: angles times translations at which the maps could touch
  double rounding = 0;   ///< the greatest of any surface
  bool stopped = false;  ///< some angles were left out
};

/// Calls `visit(surface, worker)` once for every angle, from `num_threads` threads (`worker` as in parallel_for); the
/// surface lives for the call. Fewer calls where it is stopped.
///
/// The rounding is a bound, not an estimate: three transforms, each with a relative error of at most 7 u log2(n) in the
/// Euclidean norm (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, theorem 24.2; u = 2^-24).
LatticeScores score_lattice(const PoseLattice& lattice, const RunContext& context,
                            const std::function<void(const ScoreSurface&, std::size_t)>& visit,
                            Torus torus = Torus::kWhole);

}  // namespace gridmerge
