#include "gridmerge/judge/verdict.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "gridmerge/base/number_text.hpp"

namespace gridmerge {
namespace {

std::string percent(double share) { return fixed(100 * share, 0) + " %"; }

double same_side_m(const Figures& f) { return f.source_in_target.same_side_m + f.target_in_source.same_side_m; }
double in_free_m(const Figures& f) { return f.source_in_target.in_free_m + f.target_in_source.in_free_m; }

/// The direction in which a pose is known least.
struct WeakDirection {
  double deviation_m = 0;
  double heading_deg = 0;  ///< 0 .. 180
};

/// At the source, not at its frame's origin, which may lie anywhere: the covariance is carried to the centre of its
/// known cells, and the heading's share added as it is 20 m off that.
std::optional<WeakDirection> weak_direction(const PoseEstimate& estimate, const Background& background) {
  constexpr double kLever_m = 20;
  if (!estimate.covariance) {
    return std::nullopt;
  }
  const Point2 arm = estimate.pose * background.source_centre - estimate.pose.translation();
  Eigen::Matrix<double, 2, 3> point_by_pose;
  point_by_pose << 1, 0, -arm.y_m, 0, 1, arm.x_m;
  const Eigen::Matrix2d at_centre = point_by_pose * *estimate.covariance * point_by_pose.transpose();
  if (!at_centre.allFinite()) {
    return std::nullopt;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(at_centre);
  const Eigen::Vector2d way = solver.eigenvectors().col(1);
  const double heading = degrees(std::atan2(way(1), way(0)));
  const double turned = (*estimate.covariance)(2, 2) * kLever_m * kLever_m;
  return WeakDirection{std::sqrt(std::max(0.0, solver.eigenvalues()(1)) + std::max(0.0, turned)),
                       heading < 0 ? heading + 180 : heading};
}

double log_far(double both_far_conflict_share) { return std::log(both_far_conflict_share + 0.005); }

double log_conflict(const Figures& f) { return std::log(f.conflict_share + 0.01); }
double elastic_gain(const Figures& f) { return f.conflict_share - f.elastic_conflict_share; }
double log_overlap_share(const Figures& f) { return std::log(std::max(0.01, f.overlap_share)); }

/// What the elastic evidence is worth with what conflicts all the same: a pose with more of both only lies on more.
double elastic_support_m(const Figures& f) {
  constexpr double kPower = 2.5;
  return std::max(0.0, f.elastic_evidence_m) * std::pow(1 - f.elastic_conflict_share, kPower);
}

/// The best pose alone, as if no other came near.
ConfidenceFigures unrivalled_figures(const Hypothesis& one, const Background& background,
                                     const std::optional<WeakDirection>& weak, double deviations) {
  constexpr double kDecoyDoubt = 0.5;
  constexpr double kWeak = -3;       // ln of 5 cm
  constexpr double kFinest = 0.005;  // [m]
  constexpr double kNotKnown = 10;   // [m] what the refinement says of a direction that is not fixed at all
  const Figures& f = one.figures;
  ConfidenceFigures c;
  c.decoy_doubt = std::max(0.0, kDecoyDoubt - (background.decoy ? background.decoy->log_ratio() : 0));
  c.log_deviations = std::log(std::max(0.1, deviations));
  c.log_both_far = log_far(f.both_far_conflict_share);
  c.furniture = f.furniture_conflict_share;
  c.both_furniture = f.elastic_both_furniture_conflict_share;
  c.log_elastic_evidence = std::log(std::max(1.0, f.elastic_evidence_m));
  c.log_overlap_share = log_overlap_share(f);
  c.log_weak = std::log(std::max(kFinest, weak ? weak->deviation_m : kNotKnown));
  c.weak_direction = std::max(0.0, c.log_weak - kWeak);
  return c;
}

/// Of two poses, once the maps are bent: they lay most of the walls that agree at the one in the same place. They are
/// one answer then, however far apart they begin: a pose a metre beside the right one bends into it patch by patch.
bool bends_into(const Figures& one, const Figures& best) {
  constexpr double kSamePlace = 0.3;  // [m]
  double all_m = 0;
  double same_m = 0;
  auto there = best.elastic_layout.begin();
  for (const LaidPatch& patch : one.elastic_layout) {
    all_m += patch.same_side_m;
    while (there != best.elastic_layout.end() && there->patch < patch.patch) {
      ++there;
    }
    if (there != best.elastic_layout.end() && there->patch == patch.patch &&
        std::hypot(there->at.x_m - patch.at.x_m, there->at.y_m - patch.at.y_m) < kSamePlace) {
      same_m += patch.same_side_m;
    }
  }
  return same_m > 0.5 * all_m;
}

/// Another pose, and how plausible it is beside the best one.
struct Rival {
  const Hypothesis* pose = nullptr;
  RivalFigures figures;
  double plausibility = 0;
};

std::vector<Rival> rivals_of(const std::vector<Hypothesis>& ranked, const RivalFigures& weights) {
  std::vector<Rival> rivals;
  for (std::size_t i = 1; i < std::min(ranked.size(), kCompared); ++i) {
    const Figures& best = ranked.front().figures;
    const Figures& f = ranked[i].figures;
    if (f.evidence_m <= 0 || bends_into(f, best)) {
      continue;
    }
    const RivalFigures more = {.log_conflict = log_conflict(f) - log_conflict(best),
                               .elastic_gain = elastic_gain(f) - elastic_gain(best),
                               .log_overlap_share = log_overlap_share(f) - log_overlap_share(best)};
    rivals.push_back({&ranked[i], more, plausibility(more, weights)});
  }
  return rivals;
}

/// The same beside the other poses.
ConfidenceFigures rivalled_figures(ConfidenceFigures c, const std::vector<Hypothesis>& ranked, double log_rivals) {
  constexpr double kSpotless = 0.03;
  const double best_m = std::max(1e-6, ranked.front().figures.evidence_m);
  c.log_rivals = log_rivals;
  const bool outranked = std::any_of(ranked.begin() + 1, ranked.end(), [&](const Hypothesis& other) {
    return other.proposed && other.figures.support_m > ranked.front().figures.support_m;
  });
  c.outranked = outranked ? 1 : 0;
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    if (ranked[i].figures.conflict_share < kSpotless) {
      c.spotless_rival = std::max(c.spotless_rival, std::min(1.0, ranked[i].figures.evidence_m / best_m));
    }
  }
  return c;
}

/// As if nothing were known of what stands between the walls.
ConfidenceFigures unfurnished_figures(ConfidenceFigures c) {
  c.furniture = 0.5;
  c.both_furniture = 0;
  c.log_both_far = log_far(0);
  return c;
}

/// Enough in common, and hardly a wall in free space: such a pose cannot be ruled out.
bool is_spotless(const Figures& f, const VerdictOptions& o) {
  return f.conflict_share < o.spotless_conflict_share && same_side_m(f) >= o.min_same_side_m;
}

/// What the covariance says in words, where a direction is not fixed; none: all are.
std::optional<std::string> not_fixed(const std::optional<WeakDirection>& weak, const VerdictOptions& o) {
  if (!weak || weak->deviation_m <= o.weak_direction_m) {
    return std::nullopt;
  }
  return "the walls hardly fix the pose along " + fixed(weak->heading_deg, 0) + " deg: standard deviation " +
         fixed(weak->deviation_m, 2) + " m";
}

using Evidence = double Figures::*;

/// Where a pose lies, and how its evidence compares.
std::string in_words(const Hypothesis& one, const Hypothesis& best, Evidence evidence) {
  const Pose2& pose = one.target_from_source.pose;
  const double best_m = best.figures.*evidence;
  return "x " + fixed(pose.x_m, 2) + " m, y " + fixed(pose.y_m, 2) + " m, theta " + fixed(degrees(pose.theta_rad), 1) +
         " deg, with " + percent(best_m > 0 ? one.figures.*evidence / best_m : 1) + " of the evidence";
}

/// "at A; at B; and 2 more"
std::string in_words(const std::vector<const Hypothesis*>& poses, const Hypothesis& best,
                     Evidence evidence = &Figures::evidence_m) {
  constexpr std::size_t kMost = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, poses.size()); ++i) {
    text += (i == 0 ? "at " : "; at ") + in_words(*poses[i], best, evidence);
  }
  return poses.size() > kMost ? text + "; and " + std::to_string(poses.size() - kMost) + " more" : text;
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

std::vector<Strictness> degrees_of_strictness() { return {{"cautious", 0.97}, {"normal", 0.8}, {"eager", 0.7}}; }

double VerdictOptions::needed_confidence() const {
  if (min_confidence > 0) {
    return min_confidence;
  }
  const std::vector<Strictness> degrees = degrees_of_strictness();
  const auto found =
      std::find_if(degrees.begin(), degrees.end(), [&](const Strictness& one) { return strictness == one.name; });
  return found == degrees.end() ? 1 : found->min_confidence;  // require_valid has refused any other word
}

// configs/learned/verdict.yaml; a test holds the two together.
ConfidenceWeights VerdictOptions::learned_weights() {
  return {.bias = 5.0044,
          .per = {.log_rivals = -2.9008,
                  .spotless_rival = -2.6621,
                  .outranked = -1.732,
                  .decoy_doubt = -3.3722,
                  .log_deviations = -1.7142,
                  .log_both_far = -0.9135,
                  .furniture = -3.0178,
                  .both_furniture = -5.1685,
                  .log_elastic_evidence = 1.0779,
                  .log_overlap_share = 0.9851,
                  .log_weak = 1.5855,
                  .weak_direction = -2.4826},
          .per_rival = {.log_conflict = -0.9823, .elastic_gain = 11.9339, .log_overlap_share = 1.1685}};
}

void VerdictOptions::describe(OptionList& list) {
  std::vector<std::string> names;
  std::string degrees;
  for (const Strictness& one : degrees_of_strictness()) {
    names.emplace_back(one.name);
    degrees += (degrees.empty() ? "" : ", ") + names.back() + " " + fixed(one.min_confidence, 2);
  }
  list.add(
          "strictness", strictness, names,
          {"", "How sure a merge must be: least confidence " + degrees + ".",
           "cautious where a wrong merge crashes something; eager where a person looks at every merge. docs/verdict.md "
           "has the measured rates."})
      .add("min_confidence", min_confidence, 0, 1,
           {"", "Least confidence of a merge; 0: that of the strictness.",
            "A wrong merge is far worse than a missed one: think before lowering."})
      .add("min_same_side_m", min_same_side_m, 0, 1e6,
           {"m", "Least length of wall, both ways, seen from the same side in both maps.",
            "Lower it for very small places; little then speaks for a merge."})
      .add("min_evidence_m", min_evidence_m, 0, 1e6,
           {"m", "Least evidence: walls that agree less those in the other's free space, as weighed by the evaluator.",
            "Lower it for very small places; of the merges with less than 30 m one in four was wrong "
            "(docs/verdict.md)."})
      .add("min_lead", min_lead, 0, 1,
           {"",
            "Least lead over any other pose, in evidence of maps that may bend, which is worth the less the more "
            "conflicts; a share; 0 asks for none.",
            "Lower it and look-alike places get merged wrongly."})
      .add("max_conflict_share", max_conflict_share, 0, 1,
           {"", "Greatest share of walls in the other's free space, of those in the overlap.",
            "Raise it where things moved between the two visits."})
      .add("min_deviations", min_deviations, 0, 1e6,
           {"", "How many standard deviations above random poses the evidence must stand at the least.", ""})
      .add("spotless_conflict_share", spotless_conflict_share, 0, 1,
           {"",
            "Another pose with no more conflict than this, and enough wall in common, is a doubt however far the best "
            "one leads.",
            "A symmetric hall seen from two ends has such a pose; 0 allows it none."})
      .add("spotless_evidence_share", spotless_evidence_share, 0, 1,
           {"", "Such a pose must have this share of the best one's evidence.",
            "Raise it where large maps are left apart for a pose that only brushes them."})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses farther apart than this, at the source's centre, are different answers.",
            "Raise it for maps so bent that one pose cannot be told from the next."})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "Poses turned apart by more are different answers.", ""})
      .add(
          "weak_direction_m", weak_direction_m, 0, 100,
          {"m",
           "Greatest standard deviation of the refined pose, at the source, in the direction that the walls fix least.",
           "A corridor, or one wall, leaves it sliding; raise it where that does not matter."});
  weights.describe(list);
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

std::size_t far_more_plausible(const std::vector<Hypothesis>& ranked, const VerdictOptions& o) {
  constexpr double kFarMore = 3;          // times
  constexpr double kEvidenceShare = 0.5;  // of the first one's: a pose with little of anything conflicts little, too
  std::size_t found = 0;
  double most = kFarMore;
  for (const Rival& rival : rivals_of(ranked, o.weights.per_rival)) {
    const bool may = rival.pose->proposed && rival.pose->figures.elastic_evidence_m >=
                                                 kEvidenceShare * ranked.front().figures.elastic_evidence_m;
    if (may && rival.plausibility > most) {
      most = rival.plausibility;
      found = static_cast<std::size_t>(rival.pose - ranked.data());
    }
  }
  return found;
}

Verdict judge(const std::vector<Hypothesis>& ranked, const Background& background, const VerdictOptions& o) {
  Verdict v;
  v.decoy = background.decoy ? background.decoy->log_ratio() : 0;
  if (ranked.empty()) {
    v.reasons.push_back("no pose lays walls on walls without laying more of them into free space");
    return v;
  }
  const Hypothesis& first = ranked.front();
  const Figures& best = first.figures;
  const std::size_t rival_at = strongest_rival(ranked);
  const double other = rival_at < ranked.size() ? std::max(0.0, ranked[rival_at].figures.evidence_m) : 0;
  const RandomLevel& random = background.random;
  v.lead_m = std::max(0.0, best.evidence_m - other);
  v.lead = best.evidence_m > 0 ? v.lead_m / best.evidence_m : 0;
  v.deviations = random.deviation_m > 0 ? (best.evidence_m - random.mean_m) / random.deviation_m : 0;
  const std::optional<WeakDirection> weak = weak_direction(first.target_from_source, background);
  const ConfidenceFigures alone = unrivalled_figures(first, background, weak, v.deviations);
  const std::vector<Rival> rivals = rivals_of(ranked, o.weights.per_rival);
  std::transform(rivals.begin(), rivals.end(), std::back_inserter(v.rivals),
                 [](const Rival& rival) { return rival.figures; });
  v.figures = rivalled_figures(alone, ranked, log_rivals(v.rivals, o.weights.per_rival));
  v.confidence = best.evidence_m > 0 ? confidence_of(v.figures, o.weights) : 0;
  // How sure one could be if no other pose came near: what is missing then is missing in the maps.
  const double unrivalled = best.evidence_m > 0 ? confidence_of(alone, o.weights) : 0;
  const double needed = o.needed_confidence();
  constexpr double kPlausible = 0.5;    // of a pose alone: below, nothing is worth a doubt
  constexpr double kRefurnished = 0.2;  // of the furniture
  // The walls would do, but what stands between them is elsewhere: another storey of the building, or a rearranged one.
  const bool refurnished = best.evidence_m > 0 && best.furniture_conflict_share > kRefurnished && unrivalled < needed &&
                           confidence_of(unfurnished_figures(alone), o.weights) >= std::max(kPlausible, needed);

  const std::string agreeing = fixed(same_side_m(best), 1) + " m of wall agree, " + fixed(in_free_m(best), 1) +
                               " m stand in the other's free space (" + percent(best.conflict_share) + "), over " +
                               fixed(best.overlap_area_m2, 0) + " m2 known in both";
  const std::string leading =
      ranked.size() > 1 ? "the strongest other pose has " + percent(best.evidence_m > 0 ? other / best.evidence_m : 1) +
                              " of the evidence; all together are " + fixed(std::expm1(v.figures.log_rivals), 2) +
                              " times as plausible as this one"
                        : "no other pose was put forward";
  const std::string standing =
      "the evidence stands " + fixed(v.deviations, 1) + " standard deviations above random poses" +
      (background.decoy ? ", and the maps fit " + fixed(std::exp(v.decoy), 2) + " times as well as in a mirror" : "");
  // What speaks against overlap at all, and what speaks only against this pose.
  std::vector<std::string> nothing;
  std::vector<std::string> doubts;
  if (best.evidence_m <= 0) {
    nothing.push_back("more walls stand in free space than on walls: " + fixed(in_free_m(best), 1) + " m against " +
                      fixed(same_side_m(best), 1) + " m");
  } else if (same_side_m(best) < o.min_same_side_m) {
    nothing.push_back("too little in common: " + fixed(same_side_m(best), 1) + " m of wall agree, at least " +
                      fixed(o.min_same_side_m, 1) + " m wanted");
  } else if (best.evidence_m < o.min_evidence_m) {
    nothing.push_back("too little in common: what agrees less what conflicts is " + fixed(best.evidence_m, 1) +
                      " m, at least " + fixed(o.min_evidence_m, 1) + " m wanted");
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
  v.vetoed = !nothing.empty();
  // A rival that fits about as well is a doubt. Asked where the maps may bend: there the right pose has the evidence
  // that drift took from it, and a wrong one gains little.
  std::vector<const Hypothesis*> as_good;
  // Laid over each other as far as they go, two halves of a symmetric hall agree in more than where they really meet. A
  // lead says nothing then: a pose without conflict cannot be ruled out. Of the weak ones some have no conflict only
  // because they hardly overlap.
  std::vector<const Hypothesis*> spotless;
  for (std::size_t i = 1; i < ranked.size(); ++i) {
    const Hypothesis& one = ranked[i];
    const Figures& f = one.figures;
    if (o.min_lead > 0 && i < kCompared && elastic_support_m(f) > (1 - o.min_lead) * elastic_support_m(best) &&
        !bends_into(f, best)) {
      as_good.push_back(&one);
    }
    if (is_spotless(f, o) && f.evidence_m >= o.spotless_evidence_share * best.evidence_m) {
      spotless.push_back(&one);
    }
  }
  const bool rivalled = !as_good.empty() || !spotless.empty();
  // Where the best and another fit without conflict, as in a bare corridor, which of them is in doubt, not the overlap.
  if (unrivalled < std::min(kPlausible, needed) && !(rivalled && is_spotless(best, o)) && !refurnished) {
    nothing.push_back("too little speaks for an overlap: confidence " + fixed(v.confidence, 2) + ", and " +
                      fixed(unrivalled, 2) + " if no other pose came near; " + fixed(needed, 2) + " wanted");
  }
  if (!as_good.empty()) {
    doubts.push_back("another pose fits about as well when the maps may bend: " +
                     in_words(as_good, first, &Figures::elastic_evidence_m));
  } else if (v.confidence < needed && nothing.empty()) {
    const std::string wanted = "confidence " + fixed(v.confidence, 2) + " of " + fixed(needed, 2) + " wanted, " +
                               fixed(unrivalled, 2) + " if no other pose came near";
    if (refurnished) {
      doubts.push_back("the walls agree, but " + percent(best.furniture_conflict_share) +
                       " of the furniture stands where the other map is free: another storey, or much was moved; " +
                       wanted);
    } else if (!rivals.empty()) {
      const auto most_plausible = std::max_element(
          rivals.begin(), rivals.end(), [](const Rival& a, const Rival& b) { return a.plausibility < b.plausibility; });
      doubts.push_back("not sure enough while another pose fits as well as it does: " +
                       in_words({most_plausible->pose}, first) + "; " + wanted);
    } else {
      doubts.push_back("not sure enough: " + wanted);
    }
  }
  if (!spotless.empty()) {
    doubts.push_back("another pose fits without conflict: " + in_words(spotless, first));
  }
  const std::optional<std::string> loose = not_fixed(weak, o);
  if (loose) {
    doubts.push_back(*loose);
  }
  if (!background.surveyed) {
    doubts.push_back("the search was cut short: other poses that fit as well may have been overlooked");
  }
  v.vetoed = v.vetoed || rivalled || loose.has_value() || !background.surveyed;
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
  if (v.outcome != Outcome::kMerged) {
    // What is not merged must not look sure of itself; of two poses that fit alike, one is right at the best, and a
    // gate that says that nothing fits has seen what the confidence may not have.
    v.confidence = std::min(v.confidence, rivalled || !nothing.empty() ? std::min(0.5, needed) : needed);
  }
  return v;
}

}  // namespace gridmerge
