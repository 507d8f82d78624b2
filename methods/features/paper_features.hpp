#pragma once
/// Keypoints and RANSAC, paper profile: what the map merging node of ROS does (J. Horner 2016), but for a rigid pose.
#include <string>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct PaperFeaturesOptions {
  std::string detector = "orb";
  int max_keypoints = 1500;
  double akaze_threshold = 0.001;
  double ratio = 0.7;
  int min_matches = 6;
  int samples = 2000;
  double inlier_cells = 3;
  double confidence = 1;

  void describe(OptionList& list);
};

/// One pose or none. A method's score is its number of inliers.
class PaperFeaturesMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperFeaturesMerger(PaperFeaturesOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperFeaturesOptions options_;
};

}  // namespace gridmerge
