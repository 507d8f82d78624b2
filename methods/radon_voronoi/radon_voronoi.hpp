#pragma once
/// Rotation from Radon transforms, translation from Voronoi diagrams; default profile.
///
/// After Saeedi, Paull, Trentini, Seto and Li 2012 and 2014 (seed 2.6); what is different and why stands in this
/// folder's README.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/base/options.hpp"
#include "methods/radon_voronoi/edge_votes.hpp"
#include "methods/radon_voronoi/voronoi.hpp"

namespace gridmerge {

struct RadonVoronoiOptions {
  double angle_step_deg = 1;
  double offset_step_m = 0.2;
  int rotations = 8;
  double likeness_percent = 15;
  int peaks_per_rotation = 120;
  int climbed = 48;
  int candidates = 24;
  double distinct_m = 0.6;
  double distinct_deg = 4;
  int max_points = 1500;
  voronoi::DiagramOptions diagram;
  voronoi::VoteOptions votes;
  WallFitOptions fit;

  void describe(OptionList& list);
};

/// An iteration is one rotation that was tried. Scores are WallFit's.
class RadonVoronoiMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit RadonVoronoiMerger(RadonVoronoiOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  RadonVoronoiOptions options_;
};

}  // namespace gridmerge
