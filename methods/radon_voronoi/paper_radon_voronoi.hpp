#pragma once
/// Rotation from Radon transforms, translation from the edges of probabilistic Voronoi diagrams; paper profile.
///
/// As published by Saeedi, Paull, Trentini, Seto and Li 2012 and 2014 (seed 2.6). Kept as published to compare with.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct PaperRadonVoronoiOptions {
  double angle_step_deg = 1;
  double cell_m = 0.1;
  double mask_m = 0.3;
  int shortest_cells = 6;
  double most_blur_m = 0.5;
  int candidates = 8;

  void describe(OptionList& list);
};

/// An iteration is one rotation that was tried. Scores are the summed normalised correlations of the pairs of edges
/// that agree on a translation.
class PaperRadonVoronoiMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperRadonVoronoiMerger(PaperRadonVoronoiOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperRadonVoronoiOptions options_;
};

}  // namespace gridmerge
