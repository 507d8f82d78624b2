#pragma once
/// Regressions that a person can read: weights, one an input.
#include <Eigen/Core>
#include <vector>

namespace gridmerge::statistics {

/// A constant, and a weight for each input.
struct Weights {
  double bias = 0;
  Eigen::VectorXd per_input;
};

/// P(label) = 1 / (1 + exp(-(bias + per_input . inputs))), by Newton's method: least of the log loss + ridge / 2 *
/// |w|^2, the inputs scaled to mean 0 and deviation 1, the bias free. All zero without rows.
/// @param inputs      one row an observation
/// @param labels      0 or 1
/// @param importance  of each row, >= 0
[[nodiscard]] Weights fit_logistic(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& labels,
                                   const Eigen::VectorXd& importance, double ridge);

/// Weights of observations that others compete with.
struct RivalledWeights {
  Weights weights;
  double per_log_rivals = 0;
  Eigen::VectorXd per_rival;  ///< of what each of the others has more
};

/// P(label) = logistic(bias + per_input . inputs + per_log_rivals * ln(1 + sum of odds(per_rival . rival))), by
/// Fisher's scoring, from per_log_rivals = -1 and all else 0: least of the same loss as fit_logistic's, with the ridge
/// on per_log_rivals, too, and on per_rival, the rivals scaled to a mean square of 1. The loss may have more than one
/// valley. Without rows all is zero, and per_rival empty.
/// @param rivals  of each observation one row a rival; as many columns everywhere
[[nodiscard]] RivalledWeights fit_rivalled_logistic(const Eigen::MatrixXd& inputs,
                                                    const std::vector<Eigen::MatrixXd>& rivals,
                                                    const Eigen::VectorXd& labels, const Eigen::VectorXd& importance,
                                                    double ridge);

/// Least squares of values on inputs, with the same scaling and ridge.
[[nodiscard]] Weights fit_linear(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& values, double ridge);

}  // namespace gridmerge::statistics
