#pragma once
/// From figures to a verdict: is the best pose to be believed, how sure is that, and why.
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/covariance.hpp"
#include "gridmerge/judge/confidence.hpp"
#include "gridmerge/judge/decoy_level.hpp"
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
  /// All of them for the first one; Evaluator::rival_figures of the next, kCompared in all; of the others,
  /// wall_figures.
  Figures figures;
  double method_score = 0;
  bool proposed = true;  ///< by the method; false: a rival that the pipeline found
};

/// So many poses of a list are held against each other.
inline constexpr std::size_t kCompared = 8;

struct VerdictOptions {
  // How sure a merge must be.
  std::string strictness = "normal";
  double min_confidence = 0;
  // Gates: none may be broken in a merge, however sure it looks.
  double min_same_side_m = 20;
  double min_evidence_m = 30;
  double min_lead = 0.1;
  double max_conflict_share = 0.33;
  double min_deviations = 1.5;
  double spotless_conflict_share = 0.01;
  double spotless_evidence_share = 0.5;
  double weak_direction_m = 0.5;
  // When poses count as different answers.
  double distinct_m = 1.0;
  double distinct_deg = 6;
  // The confidence: what its figures weigh. Fitted by benchmarks/verdict; configs/learned/verdict.yaml says how.
  ConfidenceWeights weights = learned_weights();

  void describe(OptionList& list);
  /// min_confidence where that is set, else the strictness's own.
  [[nodiscard]] double needed_confidence() const;
  [[nodiscard]] static ConfidenceWeights learned_weights();
};

/// A degree of strictness, by name.
struct Strictness {
  const char* name;
  double min_confidence;
};
/// cautious, normal, eager. How often each merges wrongly, and misses: docs/verdict.md.
[[nodiscard]] std::vector<Strictness> degrees_of_strictness();

struct Verdict {
  Outcome outcome = Outcome::kNoOverlap;
  double confidence = 0;             ///< 0..1: how likely the first hypothesis is right (0.5 m, 3 degrees)
  double lead = 0;                   ///< 1 - (most evidence of another distinct pose) / (evidence of the first), 0..1
  double lead_m = 0;                 ///< the same as a difference [m of wall]
  double deviations = 0;             ///< how many standard deviations the evidence stands above random poses'
  double decoy = 0;                  ///< DecoyLevel::log_ratio
  bool vetoed = false;               ///< a gate is broken: not merged, however high the confidence
  ConfidenceFigures figures;         ///< what the confidence was computed from
  std::vector<RivalFigures> rivals;  ///< ... and what its log_rivals was
  std::vector<std::string> reasons;  ///< in words, with figures; the decisive one first; never empty
};

/// What the best pose is held against beside its rivals.
struct Background {
  RandomLevel random;
  std::optional<DecoyLevel> decoy;  ///< none: nobody looked
  /// Nobody has overlooked a rival; false: never merged.
  bool surveyed = true;
  /// Of the source's known cells, in its map frame: how well a pose is fixed is asked there.
  Point2 source_centre{};
};

/// The index of the hypothesis other than the first that has the most evidence; ranked.size() where there is none.
[[nodiscard]] std::size_t strongest_rival(const std::vector<Hypothesis>& ranked);

/// The index of the pose that a method put forward and that is far more plausible than the first, as rivals are
/// weighed, with half of its evidence or more where the maps may bend; 0 where there is none. Support ranks well what
/// overlaps alike; it is slow to believe that a map is bent.
[[nodiscard]] std::size_t far_more_plausible(const std::vector<Hypothesis>& ranked, const VerdictOptions& options);

/// @param ranked  the hypothesis to judge, then the others; no two closer than the verdict's
///                distinct_m and distinct_deg
[[nodiscard]] Verdict judge(const std::vector<Hypothesis>& ranked, const Background& background,
                            const VerdictOptions& options);

}  // namespace gridmerge
