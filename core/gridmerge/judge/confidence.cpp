#include "gridmerge/judge/confidence.hpp"

#include <array>
#include <cmath>

#include "gridmerge/base/logistic.hpp"

namespace gridmerge {
namespace {

using F = ConfidenceFigures;

constexpr std::array kTerms = {
    ConfidenceTerm{"log_rivals", &F::log_rivals, "natural logarithm of 1 and the other poses' plausibilities"},
    ConfidenceTerm{"spotless_rival", &F::spotless_rival, "unit of the evidence share of the strongest spotless rival"},
    ConfidenceTerm{"outranked", &F::outranked, "pose that has less support than another one of the method's"},
    ConfidenceTerm{"decoy_doubt", &F::decoy_doubt,
                   "unit that the logarithm of how much better the maps fit than in a mirror lacks of 0.5"},
    ConfidenceTerm{"log_deviations", &F::log_deviations, "natural logarithm of the deviations above random poses"},
    ConfidenceTerm{"log_both_far", &F::log_both_far, "natural logarithm of both_far_conflict_share, 0.005 added"},
    ConfidenceTerm{"furniture", &F::furniture, "unit of furniture_conflict_share"},
    ConfidenceTerm{"both_furniture", &F::both_furniture, "unit of elastic_both_furniture_conflict_share"},
    ConfidenceTerm{"log_elastic_evidence", &F::log_elastic_evidence, "natural logarithm of elastic_evidence_m [m]"},
    ConfidenceTerm{"log_overlap_share", &F::log_overlap_share, "natural logarithm of overlap_share"},
    ConfidenceTerm{"log_weak", &F::log_weak, "natural logarithm of the weakest direction's standard deviation [m]"},
    ConfidenceTerm{"weak_direction", &F::weak_direction, "unit that this logarithm exceeds -3 by"},
};

constexpr std::array kRivalTerms = {
    RivalTerm{"log_conflict", &RivalFigures::log_conflict, "unit of ln(conflict_share + 0.01)"},
    RivalTerm{"elastic_gain", &RivalFigures::elastic_gain,
              "unit of conflict share that goes away where the maps may bend"},
    RivalTerm{"log_overlap_share", &RivalFigures::log_overlap_share, "unit of ln(overlap_share)"},
};

}  // namespace

void ConfidenceWeights::describe(OptionList& list) {
  const auto add = [&](const std::string& key, double& weight, const std::string& meaning) {
    list.add(key, weight, -1e3, 1e3, {"", meaning, ""});
  };
  add("bias", bias, "Confidence: constant term of the logistic function.");
  for (const ConfidenceTerm& term : kTerms) {
    add("per_" + std::string(term.name), per.*term.figure, "Confidence: per " + std::string(term.meaning) + ".");
  }
  for (const RivalTerm& term : kRivalTerms) {
    add("rival_" + std::string(term.name), per_rival.*term.figure,
        "Plausibility of another pose: per " + std::string(term.meaning) + " more than the best pose has.");
  }
}

std::span<const ConfidenceTerm> confidence_terms() { return kTerms; }

std::span<const RivalTerm> rival_terms() { return kRivalTerms; }

double plausibility(const RivalFigures& rival, const RivalFigures& weights) {
  double sum = 0;
  for (const RivalTerm& term : kRivalTerms) {
    sum += weights.*term.figure * rival.*term.figure;
  }
  return odds(sum);
}

double log_rivals(const std::vector<RivalFigures>& rivals, const RivalFigures& weights) {
  double sum = 1;
  for (const RivalFigures& rival : rivals) {
    sum += plausibility(rival, weights);
  }
  return std::log(sum);
}

double confidence_of(const ConfidenceFigures& figures, const ConfidenceWeights& weights) {
  double sum = weights.bias;
  for (const ConfidenceTerm& term : kTerms) {
    sum += weights.per.*term.figure * figures.*term.figure;
  }
  return logistic(sum);
}

}  // namespace gridmerge
