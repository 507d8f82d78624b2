#pragma once
/// Map merging by Hough spectra, paper profile: as published by Carpin 2008 (seed 2.3).
///
/// Kept as published to compare with: one best translation for each rotation, ranked by the acceptance index.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct PaperHoughSpectrumOptions {
  double angle_step_deg = 1;
  int rotations = 4;
  bool robust = false;

  void describe(OptionList& list);
};

/// Scores are the acceptance index, Eq. 2.8.
class PaperHoughSpectrumMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperHoughSpectrumMerger(PaperHoughSpectrumOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperHoughSpectrumOptions options_;
};

}  // namespace gridmerge
