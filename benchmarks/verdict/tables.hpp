#pragma once
/// What came of it, as Markdown.
#include <string>
#include <vector>

#include "verdict/fit.hpp"

namespace gridmerge::verdict_study {

/// Per kind and set, what the built-in verdict did: right, wrong, missed, refused, false.
[[nodiscard]] std::string outcome_table(const std::vector<Row>& rows);

/// The weights side by side, and how far those of single folds stray.
[[nodiscard]] std::string weight_table(const VerdictOptions& built_in, const VerdictOptions& fitted,
                                       const WeightsByKey& folds);

/// A confidence for every row, by some weights.
struct Judgement {
  std::string name;
  std::vector<double> confidence;
  double log_loss = 0;
};

/// In all: log loss, and at each threshold how many right and how many wrong answers pass, with the verdict's gates.
[[nodiscard]] std::string summary_table(const std::vector<Row>& rows, const std::vector<Judgement>& judgements);
/// The same per kind and set, for one of them; without those where nothing is right and nothing passes.
[[nodiscard]] std::string threshold_table(const std::vector<Row>& rows, const Judgement& judgement);

}  // namespace gridmerge::verdict_study
