#pragma once
/// Map merging by Hough spectra, default profile: rotations from oriented Hough spectra, translations from X- and
/// Y-spectra by stretch, the best of them climbed.
///
/// After Carpin 2008 (seed 2.3); what is different and why stands in this folder's README.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct HoughSpectrumOptions {
  double angle_step_deg = 1;
  double normal_spread_deg = 15;
  int rotations = 12;
  double rotation_percent = 10;
  double flat_contrast = 5;
  double flat_step_deg = 3;
  double stretch_m = 2;
  double blur_m = 0.2;
  double background_m = 1;
  int translations = 100;
  int climbed = 96;
  double distinct_m = 0.6;
  double distinct_deg = 4;
  int candidates = 24;
  int max_points = 1500;
  WallFitOptions fit;

  void describe(OptionList& list);
};

class HoughSpectrumMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit HoughSpectrumMerger(HoughSpectrumOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  HoughSpectrumOptions options_;
};

}  // namespace gridmerge
