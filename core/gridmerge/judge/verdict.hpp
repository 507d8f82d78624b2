#pragma once
/// From figures to a verdict: is the best pose to be believed, how sure is that, and why.
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/covariance.hpp"
#include "gridmerge/judge/evaluator.hpp"

namespace gridmerge {

enum class Outcome {
  kMerged,     ///< the best pose is to be believed
  kAmbiguous,  ///< something fits, but another pose fits about as well, or too little speaks for it
  kNoOverlap,  ///< nothing fits better than chance would have it
  kDeclined,   ///< these maps cannot be aligned at all (empty, no walls), or the method objects
  kStopped,    ///< stopped before any pose was found
};

/// "merged", "ambiguous", "no_overlap", "declined", "stopped": stable, as in JSON.
[[nodiscard]] std::string to_string(Outcome outcome);

/// A pose with what the Evaluator says of it.
struct Hypothesis {
  PoseEstimate target_from_source;  ///< between map frames
  Figures figures;  ///< all of them for the first one, its strongest rival, and those without conflict; else the walls'
  double method_score = 0;
  bool proposed = true;  ///< by the method; false: a rival that the pipeline found
};

struct VerdictOptions {
  // Gates: none may be broken in a merge.
  double min_same_side_m = 10;
  double min_lead = 0.08;
  double max_conflict_share = 0.33;
  double min_deviations = 1.5;
  double min_confidence = 0.9;
  double spotless_conflict_share = 0.01;
  double spotless_evidence_share = 0.25;
  // The confidence: a logistic function of seven figures (docs/verdict.md says how the weights were found).
  double bias = -11.7;
  double per_log_same_side = 0.58;
  double per_near_conflict = -18.4;
  double per_far_conflict = -38;
  double per_lead = 4.8;
  double per_log_overlap = 2.24;
  double per_mutual_information = 14;
  double per_overlap_share = 4.3;
  // When poses count as different answers.
  double distinct_m = 1.0;
  double distinct_deg = 6;
  // What is said of the covariance.
  double weak_direction_m = 0.5;

  void describe(OptionList& list);
};

struct Verdict {
  Outcome outcome = Outcome::kNoOverlap;
  double confidence = 0;             ///< 0..1 that the first hypothesis is right
  double lead = 0;                   ///< 1 - (most evidence of another distinct pose) / (evidence of the first), 0..1
  double lead_m = 0;                 ///< the same as a difference [m of wall]
  double deviations = 0;             ///< how many standard deviations the evidence stands above random poses'
  std::vector<std::string> reasons;  ///< in words, with figures; the decisive one first; never empty
};

/// The index of the hypothesis other than the first that has the most evidence; ranked.size() where there is none.
[[nodiscard]] std::size_t strongest_rival(const std::vector<Hypothesis>& ranked);

/// Whether its walls hardly stand in free space anywhere: if it has enough in common, it cannot be ruled out.
[[nodiscard]] bool is_spotless(const Hypothesis& hypothesis, const VerdictOptions& options);

/// @param ranked  the hypothesis to judge, then the others, most support first; no two closer than the verdict's
///                distinct_m and distinct_deg
/// @param surveyed  nobody has overlooked a rival; false: never merged
[[nodiscard]] Verdict judge(const std::vector<Hypothesis>& ranked, const RandomLevel& random_level,
                            const VerdictOptions& options, bool surveyed = true);

}  // namespace gridmerge
