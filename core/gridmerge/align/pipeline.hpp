#pragma once
/// The whole way from two maps to a verdict: prepare -> propose -> refine -> judge. (Fusing is the caller's next step.)
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/align/chooser.hpp"
#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/refine.hpp"
#include "gridmerge/judge/verdict.hpp"

namespace gridmerge {

struct PipelineOptions {
  bool refine = true;          ///< off: the method's poses as they come
  int refined_candidates = 8;  ///< of the candidates, by evidence, so many are refined
  int hypotheses = 8;          ///< listed in the result
  PrepareOptions prepare;
  RefineOptions refinement;
  EvaluatorOptions evaluator;
  VerdictOptions verdict;

  void describe(OptionList& list);  ///< the pipeline's own; each part describes itself
};

/// Wall-clock time of each step [s].
struct StepSeconds {
  double prepare = 0;
  double choose = 0;  ///< which method; 0 where there is no choice
  double propose = 0;
  double refine = 0;
  double judge = 0;
  double align = 0;  ///< the whole
};

struct Alignment {
  Outcome outcome = Outcome::kDeclined;
  double confidence = 0;
  std::vector<std::string> reasons;    ///< never empty
  std::vector<std::string> remarks;    ///< the method's own, on its search
  std::vector<Hypothesis> hypotheses;  ///< distinct, best first; empty where there is no pose at all
  Verdict verdict;                     ///< lead, deviations: zero where nothing was judged
  RandomLevel random_level;
  StepSeconds seconds;
  Population carry;  ///< for the next epoch
  int iterations = 0;
  std::vector<Attempt> attempts;   ///< the methods in the order tried; with one method, one
  std::vector<std::string> story;  ///< of the choice of method, in words; empty where there was none
  bool stopped = false;            ///< ended early; the answer is the best so far
};

struct AlignInput {
  const OccupancyGrid& target;  ///< borrowed; the answer is in its frame
  const OccupancyGrid& source;
  std::optional<PosePrior> prior;
  const Population* carried = nullptr;
};

/// Maps that cannot be aligned are answered with an Outcome and a reason, never with an exception.
/// @throws std::invalid_argument for a grid that breaks its own rules (check_grid) or options out of range
[[nodiscard]] Alignment align(const AlignInput& input, const Merger& method, const PipelineOptions& options,
                              const RunContext& context);

/// The same on maps that are already prepared, at one resolution: for whoever aligns a map with many others.
[[nodiscard]] Alignment align_prepared(const AlignRequest& request, const Merger& method,
                                       const PipelineOptions& options, const RunContext& context);

/// With a choice of methods: one after the other, until what they have found together is merged or the Choice has had
/// enough. The poses of all are judged as one set, so a method tried later can only add rivals or find a better pose.
[[nodiscard]] Alignment align(const AlignInput& input, const Chooser& methods, const PipelineOptions& options,
                              const RunContext& context);
[[nodiscard]] Alignment align_prepared(const AlignRequest& request, const Chooser& methods,
                                       const PipelineOptions& options, const RunContext& context);

}  // namespace gridmerge
