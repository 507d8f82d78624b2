#include "statistics/regression.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

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

/// A sum for each observation, as a function of the parameters, and its slope by each of them.
using Sums = std::function<Eigen::VectorXd(const Eigen::VectorXd& parameters, Eigen::MatrixXd* slopes)>;

/// Parameters with the least of sum(importance * -log p of what is true) + sum(pull * parameter^2) / 2, p the logistic
/// function of the sums: by Fisher's scoring, which is Newton's method where the sums are linear.
Eigen::VectorXd least_log_loss(const Sums& sums, Eigen::VectorXd w, const Eigen::VectorXd& labels,
                               const Eigen::VectorXd& importance, const Eigen::VectorXd& pull) {
  constexpr int kIterations = 200;
  constexpr double kSmallStep = 1e-10;
  const auto loss = [&](const Eigen::VectorXd& at) {
    const Eigen::ArrayXd sum = sums(at, nullptr).array();
    // -log p of what is true, without overflow
    const Eigen::ArrayXd each = sum.cwiseMax(0) - sum * labels.array() + (-sum.abs()).exp().log1p();
    return (importance.array() * each).sum() + 0.5 * (pull.array() * at.array().square()).sum();
  };
  for (int i = 0; i < kIterations; ++i) {
    Eigen::MatrixXd slopes;
    const Eigen::VectorXd p = sums(w, &slopes).unaryExpr(&logistic);
    const Eigen::VectorXd curve = importance.array() * p.array() * (1 - p.array());
    const Eigen::VectorXd slope =
        slopes.transpose() * (importance.array() * (labels - p).array()).matrix() - pull.cwiseProduct(w);
    Eigen::MatrixXd hessian = slopes.transpose() * curve.asDiagonal() * slopes;
    hessian.diagonal() += pull;
    Eigen::VectorXd step = hessian.ldlt().solve(slope);
    const double before = loss(w);
    while (loss(w + step) > before && step.norm() > kSmallStep) {
      step *= 0.5;
    }
    w += step;
    if (step.norm() <= kSmallStep) {
      break;
    }
  }
  return w;
}

}  // namespace

Weights fit_logistic(const Eigen::MatrixXd& inputs, const Eigen::VectorXd& labels, const Eigen::VectorXd& importance,
                     double ridge) {
  if (inputs.rows() == 0) {
    return {.bias = 0, .per_input = Eigen::VectorXd::Zero(inputs.cols())};
  }
  const Scaled scaled(inputs);
  const Sums linear = [&](const Eigen::VectorXd& w, Eigen::MatrixXd* slopes) -> Eigen::VectorXd {
    if (slopes != nullptr) {
      *slopes = scaled.inputs;
    }
    return scaled.inputs * w;
  };
  return scaled.unscaled(
      least_log_loss(linear, Eigen::VectorXd::Zero(scaled.inputs.cols()), labels, importance, scaled.pull(ridge)));
}

RivalledWeights fit_rivalled_logistic(const Eigen::MatrixXd& inputs, const std::vector<Eigen::MatrixXd>& rivals,
                                      const Eigen::VectorXd& labels, const Eigen::VectorXd& importance, double ridge) {
  if (inputs.rows() == 0) {
    return {.weights = fit_logistic(inputs, labels, importance, ridge), .per_log_rivals = 0, .per_rival = {}};
  }
  const Scaled scaled(inputs);
  const Eigen::Index plain = scaled.inputs.cols();
  const Eigen::Index kinds = rivals.front().cols();
  Eigen::RowVectorXd scale = Eigen::RowVectorXd::Zero(kinds);
  double count = 0;
  for (const Eigen::MatrixXd& some : rivals) {
    scale += some.array().square().matrix().colwise().sum();
    count += static_cast<double>(some.rows());
  }
  scale = (scale / std::max(1.0, count)).cwiseSqrt().cwiseMax(1e-9);

  // Parameters: bias and weights of the inputs, per_log_rivals, per_rival.
  const Sums rivalled = [&](const Eigen::VectorXd& w, Eigen::MatrixXd* slopes) -> Eigen::VectorXd {
    const double per_log_rivals = w(plain);
    const Eigen::VectorXd per_rival = w.tail(kinds).array() / scale.transpose().array();
    Eigen::VectorXd sums = scaled.inputs * w.head(plain);
    if (slopes != nullptr) {
      slopes->resize(inputs.rows(), w.size());
      slopes->leftCols(plain) = scaled.inputs;
    }
    for (Eigen::Index i = 0; i < inputs.rows(); ++i) {
      const Eigen::MatrixXd& some = rivals[static_cast<std::size_t>(i)];
      const Eigen::VectorXd plausible = (some * per_rival).unaryExpr(&odds);
      const double all = 1 + plausible.sum();
      sums(i) += per_log_rivals * std::log(all);
      if (slopes != nullptr) {
        (*slopes)(i, plain) = std::log(all);
        slopes->row(i).tail(kinds) = per_log_rivals / all * (plausible.transpose() * some).array() / scale.array();
      }
    }
    return sums;
  };
  Eigen::VectorXd start = Eigen::VectorXd::Zero(plain + 1 + kinds);
  start(plain) = -1;
  Eigen::VectorXd pull = Eigen::VectorXd::Constant(start.size(), ridge);
  pull.head(plain) = scaled.pull(ridge);
  const Eigen::VectorXd w = least_log_loss(rivalled, start, labels, importance, pull);
  return {.weights = scaled.unscaled(w.head(plain)),
          .per_log_rivals = w(plain),
          .per_rival = w.tail(kinds).array() / scale.transpose().array()};
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
