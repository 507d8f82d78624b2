#pragma once
/// One run, from the maps to its row.
#include <memory>
#include <vector>

#include "cli/configuration.hpp"
#include "study/drawn_pair.hpp"
#include "study/plan.hpp"
#include "study/row.hpp"

namespace gridmerge::study {

struct RunResult {
  Row row;                        ///< all but the yardstick
  std::vector<CurvePoint> curve;  ///< where the study asks for it; a swarm has none
  double processor_share = 1;     ///< that the run had, 0..1; 1 where it had several threads
};

/// Everything that runs share, made once. Const, so for any number of threads.
class Laboratory {
 public:
  /// @param study  borrowed
  explicit Laboratory(const Study& study);

  [[nodiscard]] RunResult perform(const PlannedRun& run, const DrawnPair& pair) const;
  /// "genetic default on office/office-3, window none, seed 1"
  [[nodiscard]] std::string name_of(const PlannedRun& run) const;

 private:
  [[nodiscard]] Row asked(const PlannedRun& run, const DrawnPair& pair) const;
  void merge_two(const PlannedRun& run, const DrawnPair& pair, RunResult& result) const;
  void merge_many(const PlannedRun& run, const DrawnPair& pair, RunResult& result) const;

  const Study& study_;
  std::vector<std::unique_ptr<const cli::Configuration>> configurations_;  ///< by method of the study
  std::string version_, commit_, compiler_, cpu_;
};

}  // namespace gridmerge::study
