#pragma once
/// The genetic method, paper profile: as published by Li and Nashashibi 2013 and built in the thesis (seed 3.2).
///
/// Kept as published to compare with: it needs a window that holds the answer, and a small one at that
/// (docs/thesis.md).
#include <string>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge {

struct PaperGeneticOptions {
  /// A robot's pose, as a person writes it.
  struct KnownPose {
    double x_m = 0;
    double y_m = 0;
    double theta_deg = 0;
  };

  int population = 300;
  std::string start = "prior";
  double window_m = 0;
  double window_percent = 100;
  double window_deg = 180;
  int iterations_per_epoch = 60;
  int epochs = 1;
  std::string epoch_policy = "continue";
  int best_mutations = 100;
  bool mutate_by_fitness = false;
  double mutation_cells = 20;
  double mutation_deg = 4;
  KnownPose target_local;
  KnownPose target_global;
  KnownPose source_local;
  KnownPose source_global;

  void describe(OptionList& list);
};

/// Scores are Eq. 3.5 with occupancies of 0..1: on maps that know only free and occupied, the number of cells hit.
///
/// One call is `epochs` epochs on the same maps. A caller whose maps grow runs one epoch a call, hands the carried
/// population on and gives each call a seed of its own, else every epoch draws the same numbers.
class PaperGeneticMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit PaperGeneticMerger(PaperGeneticOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  PaperGeneticOptions options_;
};

}  // namespace gridmerge
