#pragma once
/// Regressions that a person can read: weights, one an input.
#include <Eigen/Core>

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

/// Least squares of values on inputs, with the same scaling and ridge.
[[nodiscard]] Weights fit_linear(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& values, double ridge);

}  // namespace gridmerge::statistics
