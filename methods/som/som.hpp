#pragma once
/// The neural method, default profile: cluster points learnt by a self-organising map, turned by their normals, moved
/// by their votes.
///
/// After Saeedi, Paull, Trentini, Li 2011 (seed 2.5); what is different and why stands in this folder's README.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/cluster_points.hpp"

namespace gridmerge {

struct SomOptions {
  ClusterOptions clusters;
  double blur_deg = 3;
  double tuning_deg = 3;
  double flank_deg = 4;
  int turns = 8;
  double facing_deg = 20;
  double vote_cell_m = 0.3;
  double post_m = 1;
  double post_share = 0.6;
  double post_turn_deg = 2;
  int posts = 600;
  int peaks_per_turn = 200;
  int starts = 100;
  int icp_steps = 4;
  double match_reach_m = 0.6;
  double along_share = 0.1;
  int climbed = 40;
  int candidates = 24;
  double distinct_m = 0.6;
  double distinct_deg = 4;
  int max_points = 3000;
  WallFitOptions fit;

  void describe(OptionList& list);
};

class SomMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit SomMerger(SomOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  SomOptions options_;
};

}  // namespace gridmerge
