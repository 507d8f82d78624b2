#pragma once
/// What the confidence is a logistic function of: a few figures of the best pose, of its rivals, and of chance.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/base/options.hpp"

namespace gridmerge {

/// Each is 0 where nothing is known.
struct ConfidenceFigures {
  // Beside the other poses.
  double log_rivals = 0;      ///< gridmerge::log_rivals of the other poses
  double spotless_rival = 0;  ///< evidence of the strongest other pose with less than 3 % conflict, as a share to 1
  double outranked = 0;       ///< 1 where another pose of the method's has more support (far_more_plausible)
  double decoy_doubt = 0;     ///< what DecoyLevel::log_ratio lacks of 0.5
  double log_deviations = 0;  ///< ln of how many standard deviations above random poses, at least 0.1
  // Walls in free space.
  double log_both_far = 0;    ///< ln of Figures::both_far_conflict_share, 0.005 added: the first of it says most
  double furniture = 0;       ///< Figures::furniture_conflict_share
  double both_furniture = 0;  ///< Figures::elastic_both_furniture_conflict_share
  // How much there is in common.
  double log_elastic_evidence = 0;  ///< ln of Figures::elastic_evidence_m, at least 1 m
  double log_overlap_share = 0;     ///< ln of the overlap's share of the smaller map, at least 1 %
  // How well the walls fix the pose.
  double log_weak = 0;        ///< ln of the pose's standard deviation at the source, in the direction fixed least [m]
  double weak_direction = 0;  ///< how far log_weak exceeds -3 (5 cm)
};

/// What another pose has more than the best one.
struct RivalFigures {
  double log_conflict = 0;       ///< ln of Figures::conflict_share, 0.01 added
  double elastic_gain = 0;       ///< conflict_share that goes away where the maps may bend
  double log_overlap_share = 0;  ///< ln of Figures::overlap_share, at least 1 %
};

/// One weight for each figure, and a constant; the defaults are those of configs/learned/verdict.yaml.
struct ConfidenceWeights {
  double bias = 0;
  ConfidenceFigures per;
  RivalFigures per_rival;

  /// bias, per_NAME of each ConfidenceTerm, rival_NAME of each RivalTerm.
  void describe(OptionList& list);
};

/// A figure by name.
struct ConfidenceTerm {
  const char* name;
  double ConfidenceFigures::*figure;
  const char* meaning;  ///< one phrase, with the unit
};
/// All of them, in the order of ConfidenceFigures.
[[nodiscard]] std::span<const ConfidenceTerm> confidence_terms();

struct RivalTerm {
  const char* name;
  double RivalFigures::*figure;
  const char* meaning;  ///< one phrase, with the unit
};
/// All of them, in the order of RivalFigures.
[[nodiscard]] std::span<const RivalTerm> rival_terms();

/// How plausible a pose is beside the best one: the exponential of its weighted figures.
[[nodiscard]] double plausibility(const RivalFigures& rival, const RivalFigures& weights);

/// ln(1 + sum of the plausibilities): 0 where nothing rivals the best pose. Its exponential is by how much the best
/// pose's share of belief shrinks for the others', as in a softmax over all of them.
[[nodiscard]] double log_rivals(const std::vector<RivalFigures>& rivals, const RivalFigures& weights);

/// The logistic function of the weighted figures, 0..1.
[[nodiscard]] double confidence_of(const ConfidenceFigures& figures, const ConfidenceWeights& weights);

}  // namespace gridmerge
