#include <gtest/gtest.h>

#include <cmath>

#include "gridmerge/base/logistic.hpp"
#include "gridmerge/base/random.hpp"
#include "statistics/regression.hpp"
#include "statistics/reliability.hpp"

namespace gridmerge::statistics {
namespace {

/// Inputs by chance, and labels that a known logistic function gives.
struct Drawn {
  Eigen::MatrixXd inputs;
  Eigen::VectorXd labels;
};

Drawn drawn(int rows, double bias, const Eigen::VectorXd& weights) {
  RandomStream random(1, "logistic");
  Drawn all{Eigen::MatrixXd(rows, weights.size()), Eigen::VectorXd(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      all.inputs(i, k) = 3 + 2 * random.normal();
    }
    all.labels(i) = random.uniform() < logistic(bias + all.inputs.row(i).dot(weights)) ? 1 : 0;
  }
  return all;
}

TEST(Logistic, FindsTheWeightsThatMadeTheLabels) {
  const Eigen::Vector2d weights(0.8, -0.5);
  const Drawn data = drawn(20000, -1, weights);
  const Weights fit = fit_logistic(data.inputs, data.labels, Eigen::VectorXd::Ones(20000), 1);
  EXPECT_NEAR(fit.per_input(0), 0.8, 0.05);
  EXPECT_NEAR(fit.per_input(1), -0.5, 0.05);
  EXPECT_NEAR(fit.bias, -1, 0.15);
}

TEST(Logistic, ARowOfImportanceTwoCountsAsTwo) {
  const Drawn data = drawn(300, 0.2, Eigen::Vector2d(0.5, -0.4));
  Eigen::VectorXd importance = Eigen::VectorXd::Ones(300);
  importance.head(100).setConstant(2);
  Eigen::MatrixXd twice(400, 2);
  twice << data.inputs, data.inputs.topRows(100);
  Eigen::VectorXd labels(400);
  labels << data.labels, data.labels.head(100);
  // The scaling sees the copies, so the ridge must not matter.
  const Weights one = fit_logistic(data.inputs, data.labels, importance, 1e-9);
  const Weights other = fit_logistic(twice, labels, Eigen::VectorXd::Ones(400), 1e-9);
  EXPECT_NEAR(one.bias, other.bias, 1e-4);
  EXPECT_NEAR((one.per_input - other.per_input).norm(), 0, 1e-4);
}

TEST(Logistic, StaysFiniteWhereTheLabelsPartCleanlyOrAllAgree) {
  Eigen::MatrixXd inputs(4, 1);
  inputs << 0, 1, 2, 3;
  const Weights parted = fit_logistic(inputs, Eigen::Vector4d(0, 0, 1, 1), Eigen::Vector4d::Ones(), 1);
  EXPECT_TRUE(std::isfinite(parted.bias));
  EXPECT_GT(parted.per_input(0), 0);
  const Weights agreed = fit_logistic(inputs, Eigen::Vector4d::Ones(), Eigen::Vector4d::Ones(), 1);
  EXPECT_GT(logistic(agreed.bias), 0.9);
  EXPECT_EQ(fit_logistic(Eigen::MatrixXd(0, 3), Eigen::VectorXd(0), Eigen::VectorXd(0), 1).per_input.size(), 3);
}

TEST(Logistic, AnInputThatNeverChangesHasNoWeight) {
  Eigen::MatrixXd inputs(4, 2);
  inputs << 7, 0, 7, 1, 7, 2, 7, 3;
  const Weights fit = fit_logistic(inputs, Eigen::Vector4d(0, 1, 0, 1), Eigen::Vector4d::Ones(), 1);
  EXPECT_EQ(fit.per_input(0), 0);
}

/// Each observation has up to six others beside it, which have more or less of two things.
TEST(RivalledLogistic, FindsTheWeightsThatMadeTheLabels) {
  RandomStream random(3, "rivals");
  constexpr Eigen::Index kRows = 20000;
  const Eigen::Vector2d per_rival(0.8, -0.5);
  Eigen::MatrixXd inputs(kRows, 1);
  Eigen::VectorXd labels(kRows);
  std::vector<Eigen::MatrixXd> rivals;
  for (Eigen::Index i = 0; i < kRows; ++i) {
    inputs(i, 0) = 2 + random.normal();
    rivals.emplace_back(static_cast<Eigen::Index>(random.below(7)), 2);
    double all = 1;
    for (Eigen::Index k = 0; k < rivals.back().rows(); ++k) {
      rivals.back().row(k) << random.uniform(-4, 2), random.uniform(-2, 4);
      all += std::exp(rivals.back().row(k).dot(per_rival));
    }
    labels(i) = random.uniform() < logistic(-0.5 + 1.2 * inputs(i, 0) - 1.5 * std::log(all)) ? 1 : 0;
  }
  const RivalledWeights fit = fit_rivalled_logistic(inputs, rivals, labels, Eigen::VectorXd::Ones(kRows), 1);
  EXPECT_NEAR(fit.weights.bias, -0.5, 0.15);
  EXPECT_NEAR(fit.weights.per_input(0), 1.2, 0.06);
  EXPECT_NEAR(fit.per_log_rivals, -1.5, 0.15);
  EXPECT_NEAR(fit.per_rival(0), 0.8, 0.08);
  EXPECT_NEAR(fit.per_rival(1), -0.5, 0.08);
}

TEST(RivalledLogistic, IsThePlainOneWhereNothingCompetes) {
  const Drawn data = drawn(500, 0.4, Eigen::Vector2d(0.3, -0.2));
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(500);
  const std::vector<Eigen::MatrixXd> nobody(500, Eigen::MatrixXd(0, 3));
  const Weights plain = fit_logistic(data.inputs, data.labels, ones, 1);
  const RivalledWeights fit = fit_rivalled_logistic(data.inputs, nobody, data.labels, ones, 1);
  EXPECT_NEAR(fit.weights.bias, plain.bias, 1e-6);
  EXPECT_TRUE(fit.weights.per_input.isApprox(plain.per_input, 1e-6));
  EXPECT_NEAR(fit.per_log_rivals, 0, 1e-6);
  EXPECT_TRUE(fit.per_rival.isZero(1e-6));
}

TEST(Linear, FindsTheLine) {
  Eigen::MatrixXd inputs(5, 2);
  inputs << 0, 1, 1, 0, 2, 2, 3, 1, 4, 5;
  const Eigen::VectorXd values = (2 + 3 * inputs.col(0).array() - inputs.col(1).array()).matrix();
  const Weights fit = fit_linear(inputs, values, 1e-9);
  EXPECT_NEAR(fit.bias, 2, 1e-4);
  EXPECT_NEAR(fit.per_input(0), 3, 1e-4);
  EXPECT_NEAR(fit.per_input(1), -1, 1e-4);
}

TEST(CalibrationError, IsZeroForAFrequencyAndLargeForABoast) {
  Eigen::VectorXd confidence(10);
  confidence.setConstant(0.8);
  Eigen::VectorXd labels(10);
  labels << 1, 1, 1, 1, 1, 1, 1, 1, 0, 0;
  EXPECT_NEAR(expected_calibration_error(confidence, labels), 0, 1e-12);
  confidence.setConstant(1);
  EXPECT_NEAR(expected_calibration_error(confidence, labels), 0.2, 1e-12);
  EXPECT_EQ(expected_calibration_error(Eigen::VectorXd(0), Eigen::VectorXd(0)), 0);
}

TEST(CalibrationError, BinsDoNotMakeUpForEachOther) {
  Eigen::Vector4d confidence(0.25, 0.25, 0.75, 0.75);
  Eigen::Vector4d labels(1, 1, 0, 0);
  EXPECT_NEAR(expected_calibration_error(confidence, labels), 0.75, 1e-12);
}

}  // namespace
}  // namespace gridmerge::statistics
