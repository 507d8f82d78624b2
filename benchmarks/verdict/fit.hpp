#pragma once
/// The weights of the verdict's confidence, fitted to rows, and how well a confidence keeps its word.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gridmerge/judge/verdict.hpp"
#include "statistics/reliability.hpp"
#include "verdict/rows.hpp"

namespace gridmerge::verdict_study {

/// What the confidence of a row's pose is with these weights, whatever the gates say.
[[nodiscard]] double confidence_of(const Row& row, const ConfidenceWeights& weights);

/// Does the row tell anything of the weights? Not where there is no pose, or more speaks against it than for it.
[[nodiscard]] bool is_fitted(const Row& row);

/// Weights of the logistic function (statistics::fit_rivalled_logistic) by which `right` is foretold.
/// @param importance  of each row, >= 0; rows that are not is_fitted do not count
[[nodiscard]] ConfidenceWeights fit_weights(const std::vector<Row>& rows, const std::vector<double>& importance,
                                            double ridge = 1);

/// For each key, the weights fitted to the rows whose keys are not related to it.
using WeightsByKey = std::map<std::string, ConfidenceWeights>;
[[nodiscard]] WeightsByKey fit_without(const std::vector<Row>& rows, const std::vector<double>& importance,
                                       const std::vector<std::string>& keys,
                                       const std::function<bool(const std::string&, const std::string&)>& related);
/// The confidence of each row by the weights of its key: cross-validation.
[[nodiscard]] std::vector<double> confidence_of(const std::vector<Row>& rows, const std::vector<std::string>& keys,
                                                const WeightsByKey& weights);

/// Key: one of `folds` by chance.
[[nodiscard]] std::vector<std::string> chance_keys(const std::vector<Row>& rows, int folds, std::uint64_t seed);
/// Key: the row's places; related are those that share one.
[[nodiscard]] std::vector<std::string> place_keys(const std::vector<Row>& rows);
[[nodiscard]] bool share_a_place(const std::string& first, const std::string& second);

using statistics::ReliabilityBin;
[[nodiscard]] std::vector<ReliabilityBin> reliability(const std::vector<Row>& rows,
                                                      const std::vector<double>& confidence);
[[nodiscard]] double calibration_error(const std::vector<Row>& rows, const std::vector<double>& confidence);

}  // namespace gridmerge::verdict_study
