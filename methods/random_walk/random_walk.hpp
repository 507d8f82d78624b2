#pragma once
/// The random walk, default profile: many adaptive walks at once, from coarse maps to fine ones.
///
/// After Carpin, Birk, Jucikas 2005 and Birk, Carpin 2006 (seed 2.2, Eq. 2.5-2.7); what is different and why stands in
/// this folder's README.
#include "gridmerge/align/merger.hpp"
#include "gridmerge/base/options.hpp"
#include "methods/random_walk/locked_distance.hpp"

namespace gridmerge {

struct RandomWalkOptions {
  int starts_per_wall = 150;
  int max_starts = 120000;
  int window_starts = 30000;
  int walks = 384;
  int steps = 48;
  int memory = 8;
  double worse_percent = 5;
  int candidates = 48;
  double niche_m = 0.6;
  double niche_deg = 4;
  int max_points = 1500;
  LockOptions lock;

  void describe(OptionList& list);
};

/// A method's score is -Delta at the finest level walked on.
class RandomWalkMerger final : public Merger {
 public:
  /// @throws std::invalid_argument listing every option out of range
  explicit RandomWalkMerger(RandomWalkOptions options);
  [[nodiscard]] MergerTraits traits() const override;
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override;

 private:
  RandomWalkOptions options_;
};

}  // namespace gridmerge
