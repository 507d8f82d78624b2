#include "gridmerge/select/bids.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gridmerge/base/logistic.hpp"

namespace gridmerge {
namespace {

/// How tight a fence is: 1 for none of its freedom, 0 for no fence at all.
double tightness(double radius_m, double angle_deg) { return 1 / (1 + radius_m / 5 + angle_deg / 30); }

double value_of(const NamedValues& values, std::string_view name) {
  const auto found = std::find_if(values.begin(), values.end(), [&](const auto& one) { return one.first == name; });
  if (found == values.end()) {
    throw std::invalid_argument("there is no feature called " + std::string(name));
  }
  return found->second;
}

NamedValues inputs_of(const SceneFeatures& target, const SceneFeatures& source, double prior) {
  const auto log_least = [](double a, double b) { return std::log(std::max(1.0, std::min(a, b))); };
  const double occupied = target.occupied_cells + source.occupied_cells;
  const double known_m2 = target.known_area_m2 + source.known_area_m2;
  return {{"bias", 1},
          {"straightness", std::min(target.straightness, source.straightness)},
          {"directions", std::min(4.0, 0.5 * (target.directions + source.directions))},
          {"clutter", std::max(target.clutter, source.clutter)},
          {"self_similarity", std::max(target.self_similarity, source.self_similarity)},
          {"log_least_occupied", log_least(target.occupied_cells, source.occupied_cells)},
          {"log_least_known", log_least(target.known_area_m2, source.known_area_m2)},
          {"log_occupied", std::log(std::max(1.0, occupied))},
          {"log_known", std::log(std::max(1.0, known_m2))},
          {"probabilistic", target.ternary && source.ternary ? 0.0 : 1.0},
          {"prior", prior}};
}

}  // namespace

BidInputs::BidInputs(const SceneFeatures& target, const SceneFeatures& source, const std::optional<PosePrior>& prior)
    : named_(inputs_of(
          target, source,
          prior && prior->radius_m && prior->angle_rad ? tightness(*prior->radius_m, degrees(*prior->angle_rad)) : 0)) {
}

std::vector<FeatureText> BidInputs::texts() {
  return {{"bias", "", "always 1"},
          {"straightness", "", "of the less straight map"},
          {"directions", "", "mean of both maps, at most 4"},
          {"clutter", "", "of the more cluttered map"},
          {"self_similarity", "", "of the more self-similar map"},
          {"log_least_occupied", "", "natural logarithm of the occupied cells of the map that has fewer"},
          {"log_least_known", "", "natural logarithm of the known area [m2] of the smaller map"},
          {"log_occupied", "", "natural logarithm of the occupied cells of both"},
          {"log_known", "", "natural logarithm of the known area [m2] of both"},
          {"probabilistic", "", "1 where a cell of either map says how likely it is occupied"},
          {"prior", "", "1 / (1 + radius / 5 m + angle / 30 deg) of a prior's fence; 0 without one"}};
}

std::vector<std::string> BidInputs::names() {
  std::vector<std::string> names;
  for (const FeatureText& text : texts()) {
    names.push_back(text.name);
  }
  return names;
}

double WeightedSum::of(const NamedValues& inputs) const {
  double sum = 0;
  for (const auto& [name, weight] : weights) {
    sum += weight * value_of(inputs, name);
  }
  return sum;
}

NamedValues second_chance_inputs(double confidence, bool is_ambiguous) {
  const double odds = log_odds(confidence);
  return {{"bias", 1}, {"log_odds", odds}, {"above_half", std::max(0.0, odds)}, {"ambiguous", is_ambiguous ? 1 : 0}};
}

std::vector<std::string> second_chance_names() {
  std::vector<std::string> names;
  for (const auto& [name, value] : second_chance_inputs(0, false)) {
    names.push_back(name);
  }
  return names;
}

std::optional<Bid> bid_of(const BidBook& book, std::string_view method, const BidInputs& inputs) {
  const auto model =
      std::find_if(book.methods.begin(), book.methods.end(), [&](const BidModel& one) { return one.method == method; });
  if (model == book.methods.end()) {
    return std::nullopt;
  }
  return Bid{.success = logistic(model->success.of(inputs.named())),
             .seconds = std::exp(model->log_seconds.of(inputs.named()))};
}

}  // namespace gridmerge
