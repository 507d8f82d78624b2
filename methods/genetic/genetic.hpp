#pragma once
/// The genetic method, default profile: a population seeded by a sweep over all poses and evolved in niches.
///
/// After Li and Nashashibi 2013 (seed 2.4, 3.2); what is different and why stands in this folder's README.
#include "gridmerge/align/correlation_sweep.hpp"
#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/wall_fit.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct GeneticOptions {
  int population = 300;
  int generations = 16;
  int mutations = 4;
  std::string seeding = "sweep";
  double angle_step_deg = 2;
  double first_sigma_m = 0.2;
  double last_sigma_m = 0.03;
  double first_sigma_deg = 1.5;
  double last_sigma_deg = 0.15;
  double niche_m = 0.6;
  double niche_deg = 4;
  int candidates = 24;
  int max_points = 4000;
  WallFitOptions fit;

  void describe(OptionList& list);
};

class GeneticMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit GeneticMerger(GeneticOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  GeneticOptions options_;
};

}  // namespace gridmerge
