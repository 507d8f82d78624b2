#pragma once
/// Keypoints and RANSAC, default profile: the way most people merge maps today, as good as we can make it.
///
/// After J. Horner 2016 and the nodes that followed; what is different and why stands in this folder's README.
#include <string>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct FeaturesOptions {
  std::string detector = "both";
  int max_keypoints = 1500;
  double akaze_threshold = 0.0005;
  int neighbours = 3;
  int max_side_cells = 1600;
  int samples = 20000;
  double inlier_m = 0.3;
  double apart_m = 1;
  double turn_deg = 25;
  int hypotheses = 48;
  int candidates = 24;
  WallFitOptions fit;

  void describe(OptionList& list);
};

/// A method's score is the smooth fitness of the pose (WallFit).
class FeaturesMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit FeaturesMerger(FeaturesOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  FeaturesOptions options_;
};

}  // namespace gridmerge
