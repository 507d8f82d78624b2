#include "gridmerge/judge/verdict.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace gridmerge {
namespace {

std::string fixed(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

double same_side_m(const Figures& f) { return f.source_in_target.same_side_m + f.target_in_source.same_side_m; }
double in_free_m(const Figures& f) { return f.source_in_target.in_free_m + f.target_in_source.in_free_m; }
double far_in_free_m(const Figures& f) { return f.source_in_target.far_in_free_m + f.target_in_source.far_in_free_m; }

/// The logistic function of the figures, for a given lead (0..1).
double confidence_of(const Figures& f, double lead, const VerdictOptions& o) {
  if (f.evidence_m <= 0) {
    return 0;
  }
  // Walls that stand a little off a wall are drift, or a bent map; those far from any are another place.
  const double near_m = in_free_m(f) - far_in_free_m(f);
  const double near_conflict = near_m / (near_m + same_side_m(f));
  const double sum = o.bias + o.per_log_same_side * std::log(std::max(1.0, same_side_m(f))) +
                     o.per_near_conflict * near_conflict + o.per_far_conflict * f.far_conflict_share +
                     o.per_lead * lead + o.per_log_overlap * std::log(std::max(1.0, f.overlap_area_m2)) +
                     o.per_mutual_information * f.mutual_information_bit + o.per_overlap_share * f.overlap_share;
  return 1 / (1 + std::exp(-sum));
}

/// What the covariance says in words, where a direction is not fixed.
void add_weak_direction(const PoseEstimate& estimate, const VerdictOptions& o, std::vector<std::string>& reasons) {
  if (!estimate.covariance) {
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(estimate.covariance->topLeftCorner<2, 2>());
  const double deviation = std::sqrt(std::max(0.0, solver.eigenvalues()(1)));
  if (deviation > o.weak_direction_m) {
    const Eigen::Vector2d way = solver.eigenvectors().col(1);
    double heading = degrees(std::atan2(way(1), way(0)));
    heading += heading < 0 ? 180 : 0;
    reasons.push_back("the walls hardly fix the pose along " + fixed(heading, 0) + " deg: standard deviation " +
                      fixed(deviation, 2) + " m");
  }
}

}  // namespace

std::string to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMerged:
      return "merged";
    case Outcome::kAmbiguous:
      return "ambiguous";
    case Outcome::kNoOverlap:
      return "no_overlap";
    case Outcome::kDeclined:
      return "declined";
    case Outcome::kStopped:
      return "stopped";
  }
  return "declined";
}

void VerdictOptions::describe(OptionList& list) {
  list.add("min_same_side_m", min_same_side_m, 0, 1e6,
           {"m", "Least length of wall, both ways, seen from the same side in both maps.",
            "Lower it for very small places; little then speaks for a merge."})
      .add("min_lead", min_lead, 0, 1,
           {"", "Least lead in evidence over the best distinct other pose, as a share.",
            "Lower it and look-alike places get merged wrongly."})
      .add("max_conflict_share", max_conflict_share, 0, 1,
           {"", "Greatest share of walls in the other's free space, of those in the overlap.",
            "Raise it where things moved between the two visits."})
      .add("min_deviations", min_deviations, 0, 1e6,
           {"", "How many standard deviations above random poses the evidence must stand at the least.", ""})
      .add("min_confidence", min_confidence, 0, 1,
           {"", "Least confidence of a merge.", "A wrong merge is far worse than a missed one: think before lowering."})
      .add("spotless_conflict_share", spotless_conflict_share, 0, 1,
           {"",
            "Another pose with no more conflict than this, and enough in common to be merged alone, is a doubt however "
            "far the best one leads.",
            "A symmetric hall seen from two ends has such a pose; 0 allows it none."})
      .add("spotless_evidence_share", spotless_evidence_share, 0, 1,
           {"", "Such a pose that is not the strongest other one must have this share of the best one's evidence.",
            "Raise it where large maps are left apart for a pose that only brushes them."})
      .add("bias", bias, -1e3, 1e3, {"", "Confidence: constant term of the logistic function.", ""})
      .add("per_log_same_side", per_log_same_side, -1e3, 1e3,
           {"", "Confidence: per natural logarithm of the wall seen from the same side [m].", ""})
      .add("per_near_conflict", per_near_conflict, -1e3, 1e3,
           {"", "Confidence: per unit of the share of walls in free space within three tolerances of a wall.", ""})
      .add("per_far_conflict", per_far_conflict, -1e3, 1e3, {"", "Confidence: per unit of far_conflict_share.", ""})
      .add("per_lead", per_lead, -1e3, 1e3, {"", "Confidence: per unit of lead.", ""})
      .add("per_log_overlap", per_log_overlap, -1e3, 1e3,
           {"", "Confidence: per natural logarithm of the area known in both [m2].", ""})
      .add("per_mutual_information", per_mutual_information, -1e3, 1e3,
           {"", "Confidence: per bit of mutual information a cell.", ""})
      .add("per_overlap_share", per_overlap_share, -1e3, 1e3,
           {"", "Confidence: per unit of overlap_share (of the smaller map).", ""})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses farther apart than this, at the source's centre, are different answers.",
            "Raise it for maps so bent that one pose cannot be told from the next."})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "Poses turned apart by more are different answers.", ""})
      .add("weak_direction_m", weak_direction_m, 0, 100,
           {"m", "A direction less certain than this (standard deviation) is named among the reasons.", ""});
}

std::size_t strongest_rival(const std::vector<Hypothesis>& ranked) {
  std::size_t rival = ranked.size();
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (rival == ranked.size() || ranked[i].figures.evidence_m > ranked[rival].figures.evidence_m) {
      rival = i;
    }
  }
  return rival;
}

bool is_spotless(const Hypothesis& hypothesis, const VerdictOptions& options) {
  return hypothesis.figures.conflict_share < options.spotless_conflict_share;
}

Verdict judge(const std::vector<Hypothesis>& ranked, const RandomLevel& random_level, const VerdictOptions& o,
              bool surveyed) {
  Verdict v;
  if (ranked.empty()) {
    v.reasons.push_back("no pose lays walls on walls without laying more of them into free space");
    return v;
  }
  const Figures& best = ranked.front().figures;
  const std::size_t rival_at = strongest_rival(ranked);
  const double other = rival_at < ranked.size() ? std::max(0.0, ranked[rival_at].figures.evidence_m) : 0;
  v.lead_m = std::max(0.0, best.evidence_m - other);
  v.lead = best.evidence_m > 0 ? v.lead_m / best.evidence_m : 0;
  v.deviations = random_level.deviation_m > 0 ? (best.evidence_m - random_level.mean_m) / random_level.deviation_m : 0;
  v.confidence = confidence_of(best, v.lead, o);
  // How sure one could be if no other pose came near: what is missing then is missing in the maps.
  const double unrivalled = confidence_of(best, 1, o);

  const std::string agreeing = fixed(same_side_m(best), 1) + " m of wall agree, " + fixed(in_free_m(best), 1) +
                               " m stand in the other's free space (" + percent(best.conflict_share) + "), over " +
                               fixed(best.overlap_area_m2, 0) + " m2 known in both";
  const std::string leading = ranked.size() > 1
                                  ? "the strongest other pose has " +
                                        percent(best.evidence_m > 0 ? other / best.evidence_m : 1) + " of the evidence"
                                  : "no other pose was put forward";
  const std::string standing =
      "the evidence stands " + fixed(v.deviations, 1) + " standard deviations above random poses";
  // What speaks against overlap at all, and what speaks only against this pose.
  std::vector<std::string> nothing;
  std::vector<std::string> doubts;
  bool rivalled = false;
  if (best.evidence_m <= 0) {
    nothing.push_back("more walls stand in free space than on walls: " + fixed(in_free_m(best), 1) + " m against " +
                      fixed(same_side_m(best), 1) + " m");
  } else if (same_side_m(best) < o.min_same_side_m) {
    nothing.push_back("too little in common: " + fixed(same_side_m(best), 1) + " m of wall agree, at least " +
                      fixed(o.min_same_side_m, 1) + " m wanted");
  }
  if (v.deviations < o.min_deviations) {
    nothing.push_back("no better than chance: " + fixed(v.deviations, 1) +
                      " standard deviations above random poses, at least " + fixed(o.min_deviations, 1) + " wanted");
  }
  if (best.conflict_share > o.max_conflict_share) {
    nothing.push_back("too much conflict: " + percent(best.conflict_share) +
                      " of the walls stand in the other's free space, at most " + percent(o.max_conflict_share) +
                      " wanted");
  }
  if (v.confidence < o.min_confidence && unrivalled < o.min_confidence) {
    nothing.push_back("too little speaks for an overlap: confidence " + fixed(v.confidence, 2) + ", and " +
                      fixed(unrivalled, 2) + " if no other pose came near; " + fixed(o.min_confidence, 2) + " wanted");
  }
  if (v.lead < o.min_lead) {
    rivalled = true;
    doubts.push_back("another pose fits about as well: " + leading);
  } else if (v.confidence < o.min_confidence && nothing.empty()) {
    doubts.push_back("not sure enough while another pose fits as well as it does: " + leading + "; confidence " +
                     fixed(v.confidence, 2) + " of " + fixed(o.min_confidence, 2) + " wanted");
  }
  // Laid over each other as far as they go, two halves of a symmetric hall agree in more than where they really meet. A
  // lead says nothing then: a pose without conflict cannot be ruled out. It need not be the strongest of the others,
  // but of the weaker ones some have no conflict only because they hardly overlap.
  const auto spotless = std::find_if(ranked.begin() + 1, ranked.end(), [&](const Hypothesis& one) {
    const bool strong =
        &one == &ranked[rival_at] || one.figures.evidence_m >= o.spotless_evidence_share * best.evidence_m;
    return strong && is_spotless(one, o) && same_side_m(one.figures) >= o.min_same_side_m &&
           confidence_of(one.figures, 1, o) >= o.min_confidence;
  });
  if (spotless != ranked.end()) {
    rivalled = true;
    doubts.push_back("another pose fits without conflict: " + fixed(same_side_m(spotless->figures), 1) +
                     " m of wall agree there as well");
  }
  if (!surveyed) {
    doubts.push_back("the search was cut short: other poses that fit as well may have been overlooked");
  }
  if (!nothing.empty()) {
    v.outcome = Outcome::kNoOverlap;
  } else if (!doubts.empty()) {
    v.outcome = Outcome::kAmbiguous;
  } else {
    v.outcome = Outcome::kMerged;
  }
  v.reasons = nothing;
  v.reasons.insert(v.reasons.end(), doubts.begin(), doubts.end());
  v.reasons.push_back(agreeing);
  v.reasons.push_back(leading);
  v.reasons.push_back(standing);
  add_weak_direction(ranked.front().target_from_source, o, v.reasons);
  if (v.outcome != Outcome::kMerged) {
    // What is not merged must not look sure of itself; of two poses that fit alike, one is right at the best.
    const double most = !nothing.empty() || rivalled ? 0.5 : 1;
    v.confidence = std::min(v.confidence, most * o.min_confidence);
  }
  return v;
}

}  // namespace gridmerge
