#include "verdict/fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "gridmerge/base/random.hpp"

namespace gridmerge::verdict_study {
namespace {

constexpr double kMostConflict = 0.4;  // a little more than a merge may have

double logistic(double sum) { return 1 / (1 + std::exp(-sum)); }

std::set<std::string> parts_of(const std::string& places) {
  std::set<std::string> parts;
  std::istringstream stream(places);
  for (std::string part; std::getline(stream, part, '+');) {
    parts.insert(part);
  }
  return parts;
}

}  // namespace

SevenFigures figures_of(const Row& row) {
  const auto both = [&](const std::string& name) {
    return row.figure("source_" + name) + row.figure("target_" + name);
  };
  const double same_side_m = both("same_side_m");
  const double near_m = both("in_free_m") - both("far_in_free_m");
  SevenFigures figures;
  figures << std::log(std::max(1.0, same_side_m)), near_m > 0 ? near_m / (near_m + same_side_m) : 0,
      row.figure("far_conflict_share"), row.lead, std::log(std::max(1.0, row.figure("overlap_area_m2"))),
      row.figure("mutual_information_bit"), row.figure("overlap_share");
  return figures;
}

double confidence_of(const Row& row, const VerdictOptions& weights) {
  if (row.figure("evidence_m") <= 0) {
    return 0;
  }
  const SevenFigures figures = figures_of(row);
  double sum = weights.bias;
  for (std::size_t i = 1; i < kWeights.size(); ++i) {
    sum += weights.*kWeights[i].value * figures(static_cast<Eigen::Index>(i - 1));
  }
  return logistic(sum);
}

bool passes_gates(const Row& row, const VerdictOptions& gates) {
  return row.figure("evidence_m") > 0 &&
         row.figure("source_same_side_m") + row.figure("target_same_side_m") >= gates.min_same_side_m &&
         row.figure("conflict_share") <= gates.max_conflict_share && row.lead >= gates.min_lead &&
         row.deviations >= gates.min_deviations;
}

bool is_fitted(const Row& row) {
  return row.figure("evidence_m") > 0 && row.figure("conflict_share") < kMostConflict &&
         row.lead >= VerdictOptions{}.min_lead;
}

VerdictOptions fit_weights(const std::vector<Row>& rows, const std::vector<double>& importance, double ridge) {
  constexpr int kIterations = 60;
  constexpr double kSmallStep = 1e-10;
  constexpr Eigen::Index kCount = 8;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_fitted(rows[i]) && importance[i] > 0) {
      used.push_back(i);
    }
  }
  const auto count = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixXd figures(count, kCount - 1);
  Eigen::VectorXd right(count);
  Eigen::VectorXd share(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::size_t row = used[static_cast<std::size_t>(i)];
    figures.row(i) = figures_of(rows[row]).transpose();
    right(i) = rows[row].right ? 1 : 0;
    share(i) = importance[row];
  }
  VerdictOptions result;
  if (count == 0) {
    return result;
  }
  const Eigen::RowVectorXd mean = figures.colwise().mean();
  const Eigen::RowVectorXd deviation =
      (figures.rowwise() - mean).colwise().norm().cwiseMax(1e-9) / std::sqrt(static_cast<double>(count));
  Eigen::MatrixXd scaled = Eigen::MatrixXd::Ones(count, kCount);
  scaled.rightCols(kCount - 1) = (figures.rowwise() - mean).array().rowwise() / deviation.array();

  Eigen::VectorXd pull = Eigen::VectorXd::Constant(kCount, ridge);
  pull(0) = 1e-6;  // free, but defined where all rows agree
  Eigen::VectorXd w = Eigen::VectorXd::Zero(kCount);
  const auto loss = [&](const Eigen::VectorXd& at) {
    const Eigen::ArrayXd sum = (scaled * at).array();
    // -log p of what is true, without overflow
    const Eigen::ArrayXd each = sum.cwiseMax(0) - sum * right.array() + (-sum.abs()).exp().log1p();
    return (share.array() * each).sum() + 0.5 * (pull.array() * at.array().square()).sum();
  };
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::VectorXd p = (scaled * w).unaryExpr(&logistic);
    const Eigen::VectorXd curve = share.array() * p.array() * (1 - p.array());
    const Eigen::VectorXd slope =
        scaled.transpose() * (share.array() * (right - p).array()).matrix() - pull.cwiseProduct(w);
    Eigen::MatrixXd hessian = scaled.transpose() * curve.asDiagonal() * scaled;
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
  result.bias = w(0);
  for (std::size_t i = 1; i < kWeights.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i - 1);
    result.*kWeights[i].value = w(column + 1) / deviation(column);
    result.bias -= w(column + 1) * mean(column) / deviation(column);
  }
  return result;
}

WeightsByKey fit_without(const std::vector<Row>& rows, const std::vector<double>& importance,
                         const std::vector<std::string>& keys,
                         const std::function<bool(const std::string&, const std::string&)>& related) {
  WeightsByKey weights;
  for (const std::string& key : std::set<std::string>(keys.begin(), keys.end())) {
    std::vector<double> others = importance;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      others[i] = related(keys[i], key) ? 0 : importance[i];
    }
    weights[key] = fit_weights(rows, others);
  }
  return weights;
}

std::vector<double> confidence_of(const std::vector<Row>& rows, const std::vector<std::string>& keys,
                                  const WeightsByKey& weights) {
  std::vector<double> confidence;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    confidence.push_back(confidence_of(rows[i], weights.at(keys[i])));
  }
  return confidence;
}

std::vector<std::string> chance_keys(const std::vector<Row>& rows, int folds, std::uint64_t seed) {
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    keys.push_back(std::to_string(RandomStream(seed, "verdict/fold", i).below(static_cast<std::uint32_t>(folds))));
  }
  return keys;
}

std::vector<std::string> place_keys(const std::vector<Row>& rows) {
  std::vector<std::string> keys;
  std::transform(rows.begin(), rows.end(), std::back_inserter(keys), [](const Row& row) { return row.places; });
  return keys;
}

bool share_a_place(const std::string& first, const std::string& second) {
  const std::set<std::string> others = parts_of(second);
  const std::set<std::string> parts = parts_of(first);
  return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) { return others.contains(part); });
}

double log_loss(const std::vector<Row>& rows, const std::vector<double>& importance,
                const std::vector<double>& confidence) {
  double sum = 0;
  double all = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_fitted(rows[i])) {
      sum -= importance[i] * std::log(std::max(1e-12, rows[i].right ? confidence[i] : 1 - confidence[i]));
      all += importance[i];
    }
  }
  return all > 0 ? sum / all : 0;
}

}  // namespace gridmerge::verdict_study
