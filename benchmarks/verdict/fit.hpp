#pragma once
/// The weights of the verdict's confidence, fitted to rows.
#include <Eigen/Core>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "gridmerge/judge/verdict.hpp"
#include "verdict/rows.hpp"

namespace gridmerge::verdict_study {

/// An option of the verdict that is a weight.
struct Weight {
  const char* key;
  double VerdictOptions::*value;
};
/// The bias, then those of the figures, in the order of figures_of.
inline constexpr std::array<Weight, 8> kWeights = {{
    {"bias", &VerdictOptions::bias},
    {"per_log_same_side", &VerdictOptions::per_log_same_side},
    {"per_near_conflict", &VerdictOptions::per_near_conflict},
    {"per_far_conflict", &VerdictOptions::per_far_conflict},
    {"per_lead", &VerdictOptions::per_lead},
    {"per_log_overlap", &VerdictOptions::per_log_overlap},
    {"per_mutual_information", &VerdictOptions::per_mutual_information},
    {"per_overlap_share", &VerdictOptions::per_overlap_share},
}};

/// The seven figures that the confidence is a logistic function of.
using SevenFigures = Eigen::Matrix<double, 7, 1>;
[[nodiscard]] SevenFigures figures_of(const Row& row);

/// What the verdict's confidence is with these weights, before its gates.
[[nodiscard]] double confidence_of(const Row& row, const VerdictOptions& weights);
/// The gates of the verdict beside the confidence.
[[nodiscard]] bool passes_gates(const Row& row, const VerdictOptions& gates);

/// Does the row tell anything of the weights? No, if a gate decides it in any case, or nearly so.
[[nodiscard]] bool is_fitted(const Row& row);

/// Weights of the logistic function by Newton's method: least of log loss + ridge / 2 * |w|^2, the figures scaled to
/// mean 0 and deviation 1, the bias free. The other options keep their defaults.
/// @param importance  of each row, >= 0; rows that are not is_fitted do not count
[[nodiscard]] VerdictOptions fit_weights(const std::vector<Row>& rows, const std::vector<double>& importance,
                                         double ridge = 0.3);

/// For each key, the weights fitted to the rows whose keys are not related to it.
using WeightsByKey = std::map<std::string, VerdictOptions>;
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

/// Mean of -log(probability given to what is true) over the rows that are fitted, by importance.
[[nodiscard]] double log_loss(const std::vector<Row>& rows, const std::vector<double>& importance,
                              const std::vector<double>& confidence);

}  // namespace gridmerge::verdict_study
