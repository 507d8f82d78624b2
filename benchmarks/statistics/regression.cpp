#include "statistics/regression.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "gridmerge/base/logistic.hpp"

namespace gridmerge::statistics {
namespace {

/// Inputs of mean 0 and deviation 1, and the way back.
struct Scaled {
  Eigen::MatrixXd inputs;  ///< a column of ones first
  Eigen::RowVectorXd mean;
  Eigen::RowVectorXd deviation;

  explicit Scaled(const Eigen::MatrixXd& raw)
      : inputs(Eigen::MatrixXd::Ones(raw.rows(), raw.cols() + 1)),
        mean(raw.colwise().mean()),
        deviation((raw.rowwise() - mean).colwise().norm().cwiseMax(1e-9) / std::sqrt(static_cast<double>(raw.rows()))) {
    inputs.rightCols(raw.cols()) = (raw.rowwise() - mean).array().rowwise() / deviation.array();
  }

  /// Of the raw inputs, from those of the scaled ones. An input that never changes has no weight.
  [[nodiscard]] Weights unscaled(const Eigen::VectorXd& w) const {
    Weights weights;
    weights.per_input = Eigen::VectorXd::Zero(mean.size());
    weights.bias = w(0);
    for (Eigen::Index i = 0; i < mean.size(); ++i) {
      weights.per_input(i) = deviation(i) > 1e-6 ? w(i + 1) / deviation(i) : 0;
      weights.bias -= weights.per_input(i) * mean(i);
    }
    return weights;
  }

  /// The ridge on every weight but the bias, which is only kept defined where all rows agree.
  [[nodiscard]] Eigen::VectorXd pull(double ridge) const {
    Eigen::VectorXd all = Eigen::VectorXd::Constant(inputs.cols(), ridge);
    all(0) = 1e-6;
    return all;
  }
};

}  // namespace

Weights fit_logistic(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& labels, const Eigen::VectorXd& importance,
                     double ridge) {
  constexpr int kIterations = 60;
  constexpr double kSmallStep = 1e-10;
  if (inputs.rows() == 0) {
    return {.bias = 0, .per_input = Eigen::VectorXd::Zero(inputs.cols())};
  }
  const Scaled scaled(inputs);
  const Eigen::VectorXd pull = scaled.pull(ridge);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(scaled.inputs.cols());
  const auto loss = [&](const Eigen::VectorXd& at) {
    const Eigen::ArrayXd sum = (scaled.inputs * at).array();
    // -log p of what is true, without overflow
    const Eigen::ArrayXd each = sum.cwiseMax(0) - sum * labels.array() + (-sum.abs()).exp().log1p();
    return (importance.array() * each).sum() + 0.5 * (pull.array() * at.array().square()).sum();
  };
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd p = (scaled.inputs * w).unaryExpr(&logistic);
    const Eigen::VectorXd curve = importance.array() * p.array() * (1 - p.array());
    const Eigen::VectorXd slope =
        scaled.inputs.transpose() * (importance.array() * (labels - p).array()).matrix() - pull.cwiseProduct(w);
    Eigen::MatrixXd hessian = scaled.inputs.transpose() * curve.asDiagonal() * scaled.inputs;
    hessian.diagonal() += pull;
    Eigen::VectorXd step = hessian.ldlt().solve(slope);
    while (loss(w + step) > loss(w) && step.norm() > kSmallStep) {
      step *= 0.5;
    }
    w += step;
    if (step.norm() <= kSmallStep) {
      break;
    }
  }
  return scaled.unscaled(w);
}

Weights fit_linear(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& values, double ridge) {
  if (inputs.rows() == 0) {
    return {.bias = 0, .per_input = Eigen::VectorXd::Zero(inputs.cols())};
  }
  const Scaled scaled(inputs);
  Eigen::MatrixXd normal = scaled.inputs.transpose() * scaled.inputs;
  normal.diagonal() += scaled.pull(ridge);
  return scaled.unscaled(normal.ldlt().solve(scaled.inputs.transpose() * values));
}

}  // namespace gridmerge::statistics
