#pragma once
/// The neural method, paper profile: as published by Saeedi, Paull, Trentini, Li 2011, in the form of the seed's 2.5.
///
/// Where the text leaves it open, this folder's README says what is done.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"
#include "methods/som/self_organising_map.hpp"

namespace gridmerge {

struct PaperSomOptions {
  double segment_m = 4;
  double wall_per_neuron_m = 0.5;
  som::KohonenOptions learning;
  double blur_deg = 2;
  double tuning_deg = 3;
  int turns = 4;
  double facing_deg = 10;
  int trials = 2000;
  int kept = 20;
  int icp_steps = 15;
  double match_reach_m = 1;

  void describe(OptionList& list);
};

class PaperSomMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperSomMerger(PaperSomOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperSomOptions options_;
};

}  // namespace gridmerge
