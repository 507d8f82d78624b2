#pragma once
/// Correlative matching over a whole lattice of poses: the best pose on it is proved to be the best.
///
/// After Olson 2009 and Hess et al. 2016; what is different and why stands in this folder's README.
#include "gridmerge/align/lattice_scores.hpp"
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct CorrelativeOptions {
  double angle_step_deg = 2;
  int finest_level = 2;
  int max_cells = 540;
  bool both_ways = true;
  bool climb = true;
  int candidates = 24;
  double distinct_m = 0.6;
  double distinct_deg = 4;
  WallFitOptions fit = {};

  void describe(OptionList& list);
};

/// Olson 2009: the source's walls in the target's smooth field, no penalty for free space, the lattice's poses as they
/// are.
struct PaperCorrelativeOptions : CorrelativeOptions {
  PaperCorrelativeOptions() {
    angle_step_deg = 1;
    finest_level = 1;
    both_ways = false;
    climb = false;
    fit.free_space_penalty = 0;
  }
};

class CorrelativeMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit CorrelativeMerger(CorrelativeOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  CorrelativeOptions options_;
};

/// What has been shown of a lattice.
struct LatticeProof {
  std::int64_t best_score = 0;     ///< PoseLattice::score: no pose that the lattice holds has a higher one; at least 0
  LatticePose best;                ///< of the poses with that score, the first; none where it is 0
  double poses = 0;                ///< on the lattice
  double rounding = 0;             ///< of the transforms: what they could not tell apart was added up in whole numbers
  int added_up = 0;                ///< poses that were
  std::vector<LatticePeak> peaks;  ///< local maxima over translation, for every angle; scores within the rounding
  /// Local maxima that are not among the peaks score no higher than this.
  double left_out_below = 0;
  bool stopped = false;  ///< nothing is proved
};

/// Searches the whole lattice.
/// @param peaks_per_angle  so many at the most, the highest
[[nodiscard]] LatticeProof search_lattice(const PoseLattice& lattice, int peaks_per_angle, const RunContext& context);

}  // namespace gridmerge
