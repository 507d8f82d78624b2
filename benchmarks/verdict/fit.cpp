#include "verdict/fit.hpp"

#include <algorithm>
#include <set>
#include <sstream>

#include "gridmerge/base/random.hpp"
#include "statistics/regression.hpp"

namespace gridmerge::verdict_study {
namespace {

std::set<std::string> parts_of(const std::string& places) {
  std::set<std::string> parts;
  std::istringstream stream(places);
  for (std::string part; std::getline(stream, part, '+');) {
    parts.insert(part);
  }
  return parts;
}

/// One vector of the rows' confidences and labels, as the statistics take them.
struct Told {
  Eigen::VectorXd confidence;
  Eigen::VectorXd right;

  Told(const std::vector<Row>& rows, const std::vector<double>& all)
      : confidence(static_cast<Eigen::Index>(rows.size())), right(confidence.size()) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      confidence(static_cast<Eigen::Index>(i)) = all[i];
      right(static_cast<Eigen::Index>(i)) = rows[i].right ? 1 : 0;
    }
  }
};

}  // namespace

double confidence_of(const Row& row, const ConfidenceWeights& weights) {
  ConfidenceFigures figures = row.figures;
  figures.log_rivals = log_rivals(row.rivals, weights.per_rival);
  return is_fitted(row) ? gridmerge::confidence_of(figures, weights) : 0;
}

bool is_fitted(const Row& row) { return row.evidence_m > 0; }

ConfidenceWeights fit_weights(const std::vector<Row>& rows, const std::vector<double>& importance, double ridge) {
  std::vector<ConfidenceTerm> terms;  // but log_rivals, which has weights in it
  std::copy_if(confidence_terms().begin(), confidence_terms().end(), std::back_inserter(terms),
               [](const ConfidenceTerm& term) { return term.figure != &ConfidenceFigures::log_rivals; });
  const auto rival_columns = rival_terms();
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_fitted(rows[i]) && importance[i] > 0) {
      used.push_back(i);
    }
  }
  if (used.empty()) {
    return {};
  }
  Eigen::MatrixXd figures(static_cast<Eigen::Index>(used.size()), static_cast<Eigen::Index>(terms.size()));
  Eigen::VectorXd right(figures.rows());
  Eigen::VectorXd weight(figures.rows());
  std::vector<Eigen::MatrixXd> rivals;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Row& row = rows[used[i]];
    for (std::size_t k = 0; k < terms.size(); ++k) {
      figures(at, static_cast<Eigen::Index>(k)) = row.figures.*terms[k].figure;
    }
    Eigen::MatrixXd others(static_cast<Eigen::Index>(row.rivals.size()),
                           static_cast<Eigen::Index>(rival_columns.size()));
    for (Eigen::Index r = 0; r < others.rows(); ++r) {
      for (Eigen::Index k = 0; k < others.cols(); ++k) {
        others(r, k) = row.rivals[static_cast<std::size_t>(r)].*rival_columns[static_cast<std::size_t>(k)].figure;
      }
    }
    rivals.push_back(std::move(others));
    right(at) = row.right ? 1 : 0;
    weight(at) = importance[used[i]];
  }
  const statistics::RivalledWeights fit = statistics::fit_rivalled_logistic(figures, rivals, right, weight, ridge);
  ConfidenceWeights weights;
  weights.bias = fit.weights.bias;
  weights.per.log_rivals = fit.per_log_rivals;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    weights.per.*terms[k].figure = fit.weights.per_input(static_cast<Eigen::Index>(k));
  }
  for (std::size_t k = 0; k < rival_columns.size(); ++k) {
    weights.per_rival.*rival_columns[k].figure = fit.per_rival(static_cast<Eigen::Index>(k));
  }
  return weights;
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

std::vector<ReliabilityBin> reliability(const std::vector<Row>& rows, const std::vector<double>& confidence) {
  const Told told(rows, confidence);
  return statistics::reliability(told.confidence, told.right);
}

double calibration_error(const std::vector<Row>& rows, const std::vector<double>& confidence) {
  const Told told(rows, confidence);
  return statistics::expected_calibration_error(told.confidence, told.right);
}

}  // namespace gridmerge::verdict_study
