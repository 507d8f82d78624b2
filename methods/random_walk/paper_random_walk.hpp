#pragma once
/// The random walk, paper profile: one adaptive walk over Delta at full resolution, as Carpin, Birk, Jucikas 2005 and
/// Birk, Carpin 2006 have it (seed 2.2). Kept as published to compare with.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct PaperRandomWalkOptions {
  int samples = 1500;
  double c_lock = 0.1;
  double first_sigma_cells = 20;
  double first_sigma_deg = 10;
  double floor_percent = 5;
  int memory = 10;
  double worse_percent = 5;
  int max_side_cells = 1000;

  void describe(OptionList& list);
};

/// Starts at the prior's pose; without one, anywhere. Scores are -Delta, psi in cells.
class PaperRandomWalkMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperRandomWalkMerger(PaperRandomWalkOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperRandomWalkOptions options_;
};

}  // namespace gridmerge
