#include "selector/learn.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>

#include "statistics/regression.hpp"

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

// The regressions have a bias of their own.
std::vector<double> without_bias(const NamedValues& inputs) {
  std::vector<double> values;
  std::transform(inputs.begin() + 1, inputs.end(), std::back_inserter(values),
                 [](const auto& input) { return input.second; });
  return values;
}

std::vector<std::string> without_bias(std::vector<std::string> names) {
  names.erase(names.begin());
  return names;
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
          sample.add(without_bias(second_chance_inputs(first->confidence, first->status == "ambiguous")),
                     second->result == "right" ? 1 : 0);
        }
      }
    }
  }
  return logistic_sum(sample, without_bias(second_chance_names()), ridge);
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
    const std::vector<double> inputs = without_bias(inputs_of(row).named());
    log_seconds[row.method].add(inputs, std::log(row.align_s));
    if (row.truth == "same") {
      success[row.method].add(inputs, row.result == "right" ? 1 : 0);
    }
  }
  const std::vector<std::string> names = without_bias(BidInputs::names());
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
