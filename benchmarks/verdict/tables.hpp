#pragma once
/// What came of it, as Markdown.
#include <string>
#include <vector>

#include "verdict/fit.hpp"

namespace gridmerge::verdict_study {

/// Per kind and set, what the verdict did: right, wrong, missed, refused, false.
[[nodiscard]] std::string outcome_table(const std::vector<Row>& rows);

/// The weights side by side, and how far those of single folds stray.
[[nodiscard]] std::string weight_table(const ConfidenceWeights& built_in, const ConfidenceWeights& fitted,
                                       const WeightsByKey& folds);

/// For each degree of strictness and each kind: merges that are wrong, of those that could be, and right ones that were
/// missed; with the gates as they were when the rows were made.
[[nodiscard]] std::string strictness_table(const std::vector<Row>& rows, const std::vector<double>& confidence);

/// Rows whose truth is "same", by how much the maps overlap: how many are merged rightly and wrongly at each
/// strictness.
[[nodiscard]] std::string overlap_table(const std::vector<Row>& rows, const std::vector<double>& confidence);

/// Told and true, bin by bin, with the expected calibration error.
[[nodiscard]] std::string reliability_table(const std::vector<Row>& rows, const std::vector<double>& confidence);

}  // namespace gridmerge::verdict_study
