#include "selector/learn.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "statistics/logistic.hpp"

namespace gridmerge::selector_study {
namespace {

using study::Row;

/// Rows of inputs (without the bias) and what came of them.
struct Sample {
  std::vector<std::vector<double>> inputs;
  std::vector<double> outcome;

  void add(std::vector<double> input, double value) {
    inputs.push_back(std::move(input));
    outcome.push_back(value);
  }
  [[nodiscard]] Eigen::MatrixXd matrix(std::size_t columns) const {
    Eigen::MatrixXd all(static_cast<Eigen::Index>(inputs.size()), static_cast<Eigen::Index>(columns));
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      for (std::size_t k = 0; k < columns; ++k) {
        all(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = inputs[i][k];
      }
    }
    return all;
  }
  [[nodiscard]] Eigen::VectorXd values() const {
    return Eigen::Map<const Eigen::VectorXd>(outcome.data(), static_cast<Eigen::Index>(outcome.size()));
  }
};

/// A number that a person can read; more digits say nothing.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

WeightedSum weighted(const statistics::Weights& weights, const std::vector<std::string>& names) {
  WeightedSum sum;
  sum.weights.emplace_back("bias", rounded(weights.bias));
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const double weight = rounded(weights.per_input(static_cast<Eigen::Index>(i))); weight != 0) {
      sum.weights.emplace_back(names[i], weight);
    }
  }
  return sum;
}

WeightedSum logistic_sum(const Sample& sample, const std::vector<std::string>& names, double ridge) {
  const Eigen::VectorXd even = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(sample.outcome.size()));
  return weighted(statistics::fit_logistic(sample.matrix(names.size()), sample.values(), even, ridge), names);
}

std::vector<double> without_bias(const BidInputs& inputs) {
  std::vector<double> values;
  for (std::size_t i = 1; i < inputs.named().size(); ++i) {
    values.push_back(inputs.named()[i].second);
  }
  return values;
}

std::vector<std::string> input_names() {
  std::vector<std::string> names;
  for (const FeatureText& text : BidInputs::texts()) {
    names.push_back(text.name);
  }
  names.erase(names.begin());
  return names;
}

double log_odds(double chance) {
  const double p = std::clamp(chance, 1e-4, 1 - 1e-4);
  return std::log(p / (1 - p));
}

WeightedSum learn_second_chance(const std::vector<Row>& rows, double ridge) {
  std::map<std::string, std::vector<const Row*>> by_pair;
  for (const Row& row : rows) {
    if (is_learned_from(row)) {
      by_pair[row.set + "\n" + row.pair + "\n" + row.window + "\n" + std::to_string(row.seed)].push_back(&row);
    }
  }
  Sample sample;
  for (const auto& [pair, runs] : by_pair) {
    for (const Row* first : runs) {
      for (const Row* second : runs) {
        if (first->method != second->method && first->status != "merged") {
          sample.add({log_odds(first->confidence), first->status == "ambiguous" ? 1.0 : 0.0},
                     second->result == "right" ? 1 : 0);
        }
      }
    }
  }
  return logistic_sum(sample, {"log_odds", "ambiguous"}, ridge);
}

}  // namespace

bool is_learned_from(const Row& row) {
  return row.robots == 2 && row.profile == "default" && row.options.empty() && row.method != "auto" &&
         row.truth != "unknown" && row.status != "declined" && row.align_s > 0;
}

BidInputs inputs_of(const Row& row) {
  std::optional<PosePrior> prior;
  if (std::isfinite(row.window_m) && std::isfinite(row.window_deg)) {
    prior = PosePrior{.target_from_source = {}, .radius_m = row.window_m, .angle_rad = radians(row.window_deg)};
  }
  return {row.target, row.source, prior};
}

BidBook learn(const std::vector<Row>& rows, double ridge) {
  std::vector<std::string> methods;
  std::map<std::string, Sample> success;
  std::map<std::string, Sample> log_seconds;
  for (const Row& row : rows) {
    if (!is_learned_from(row)) {
      continue;
    }
    if (std::find(methods.begin(), methods.end(), row.method) == methods.end()) {
      methods.push_back(row.method);
    }
    const std::vector<double> inputs = without_bias(inputs_of(row));
    log_seconds[row.method].add(inputs, std::log(row.align_s));
    if (row.truth == "same") {
      success[row.method].add(inputs, row.result == "right" ? 1 : 0);
    }
  }
  const std::vector<std::string> names = input_names();
  BidBook book;
  for (const std::string& method : methods) {
    const Sample& times = log_seconds[method];
    book.methods.push_back(
        {.method = method,
         .success = logistic_sum(success[method], names, ridge),
         .log_seconds = weighted(statistics::fit_linear(times.matrix(names.size()), times.values(), ridge), names)});
  }
  book.second_chance = learn_second_chance(rows, ridge);
  return book;
}

}  // namespace gridmerge::selector_study
