#include "gridmerge/judge/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const RandomLevel kChance{.mean_m = -20, .deviation_m = 10, .poses = 48};

/// A pose of which that much wall was seen from the same side, and stands in free space, over that much common ground.
Hypothesis hypothesis(double same_side_m, double in_free_m, double overlap_m2 = 100) {
  Hypothesis one;
  Figures& f = one.figures;
  f.source_in_target.same_side_m = 0.6 * same_side_m;
  f.target_in_source.same_side_m = 0.4 * same_side_m;
  f.source_in_target.in_free_m = in_free_m;
  f.source_in_target.far_in_free_m = 0.5 * in_free_m;
  f.evidence_m = same_side_m - 1.75 * in_free_m;
  f.conflict_share = in_free_m > 0 ? in_free_m / (in_free_m + same_side_m) : 0;
  f.far_conflict_share = in_free_m > 0 ? 0.5 * in_free_m / (0.5 * in_free_m + same_side_m) : 0;
  f.both_far_conflict_share = f.far_conflict_share;
  f.furniture_conflict_share = 0.05;
  f.fittings_conflict_share = 0.05;
  f.same_side_share = 0.9;
  f.elastic_evidence_m = f.evidence_m;
  f.elastic_conflict_share = 0.7 * f.conflict_share;
  f.elastic_both_furniture_conflict_share = 0;
  f.elastic_roughness_m = 0.05;
  f.overlap_area_m2 = overlap_m2;
  f.overlap_share = 0.5;
  f.mutual_information_bit = 0.1;
  one.target_from_source.covariance = 1e-4 * PoseCovariance::Identity();
  return one;
}

/// A survey that found these maps to fit far better than in a mirror.
Verdict judged(const std::vector<Hypothesis>& ranked, const RandomLevel& random, const VerdictOptions& options,
               bool surveyed = true) {
  return judge(ranked, {.random = random, .decoy = DecoyLevel{.own = 300, .decoy = 60}, .surveyed = surveyed}, options);
}

/// The confidence is always 1, so that each other gate can be seen to decide alone.
VerdictOptions always_confident() {
  VerdictOptions options;
  options.weights.bias = 1000;
  return options;
}

TEST(Verdict, MergesWhatNothingSpeaksAgainst) {
  const Verdict v = judged({hypothesis(80, 1), hypothesis(20, 4)}, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kMerged);
  EXPECT_GE(v.confidence, VerdictOptions{}.needed_confidence());
  EXPECT_THAT(v.reasons, Contains(HasSubstr("80.0 m of wall agree, 1.0 m stand in the other's free space (1 %)")));
  EXPECT_THAT(v.reasons, Contains(HasSubstr("100 m2 known in both")));
  EXPECT_NEAR(v.lead_m, 78.25 - 13, 1e-9);
  EXPECT_NEAR(v.lead, (78.25 - 13) / 78.25, 1e-9);
  EXPECT_NEAR(v.deviations, 9.825, 1e-9);
}

TEST(StrongestRival, HasTheMostEvidenceOfAllOthers) {
  EXPECT_EQ(strongest_rival({hypothesis(80, 1), hypothesis(20, 4), hypothesis(60, 4), hypothesis(10, 0)}), 2U);
  EXPECT_EQ(strongest_rival({hypothesis(80, 1)}), 1U);
  EXPECT_EQ(strongest_rival({}), 0U);
}

TEST(Verdict, LeadsOverTheStrongestRivalWhereverItIsRanked) {
  const Verdict v = judged({hypothesis(80, 1), hypothesis(20, 1), hypothesis(60, 2)}, kChance, always_confident());
  EXPECT_NEAR(v.lead_m, 78.25 - 56.5, 1e-9);
}

TEST(Verdict, LeadsByAllItHasWhereThereIsNoRival) {
  const Verdict alone = judged({hypothesis(80, 1)}, kChance, always_confident());
  EXPECT_EQ(alone.outcome, Outcome::kMerged);
  EXPECT_EQ(alone.lead, 1);
  const Verdict worthless_rival = judged({hypothesis(80, 1), hypothesis(1, 30)}, kChance, always_confident());
  EXPECT_EQ(worthless_rival.lead, 1);
}

TEST(Verdict, FindsNoOverlapWithoutAnyPose) {
  const Verdict v = judged({}, {}, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_EQ(v.confidence, 0);
  EXPECT_THAT(v.reasons, Not(IsEmpty()));
}

TEST(Verdict, FindsNoOverlapWhereMoreWallsStandInFreeSpace) {
  const Verdict v = judged({hypothesis(50, 40)}, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_EQ(v.confidence, 0);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("free space"), HasSubstr("50.0 m"), HasSubstr("40.0 m")));
}

TEST(Verdict, FindsNoOverlapWhereTooLittleIsInCommon) {
  VerdictOptions options = always_confident();
  options.min_same_side_m = 12;
  options.min_evidence_m = 0;
  EXPECT_EQ(judged({hypothesis(12.1, 0)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict v = judged({hypothesis(11.9, 0)}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("too little in common"), HasSubstr("11.9 m"), HasSubstr("12.0 m")));
}

TEST(Verdict, FindsNoOverlapWhereHardlyMoreAgreesThanConflicts) {
  VerdictOptions options = always_confident();
  options.max_conflict_share = 1;
  options.min_evidence_m = 10;
  EXPECT_EQ(judged({hypothesis(46.5, 20)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict v = judged({hypothesis(43.5, 20)}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_LE(v.confidence, 0.5);  // whatever the figures of the confidence say
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("less what conflicts"), HasSubstr("8.5 m"), HasSubstr("10.0 m")));
}

TEST(Verdict, FindsNoOverlapWhereChanceWouldDoAsWell) {
  VerdictOptions options = always_confident();
  options.min_deviations = 3;
  const RandomLevel level{.mean_m = 10, .deviation_m = 20, .poses = 48};
  EXPECT_EQ(judged({hypothesis(71, 0)}, level, options).outcome, Outcome::kMerged);
  const Verdict v = judged({hypothesis(69, 0)}, level, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("3.0"), HasSubstr("standard deviations above random poses")));
}

TEST(Verdict, DoesNotMergeWhereNothingIsKnownOfChance) {
  EXPECT_NE(judged({hypothesis(80, 1)}, RandomLevel{}, always_confident()).outcome, Outcome::kMerged);
}

TEST(Verdict, FindsNoOverlapWhereThereIsTooMuchConflict) {
  VerdictOptions options = always_confident();
  options.max_conflict_share = 0.2;
  EXPECT_EQ(judged({hypothesis(81, 19)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict v = judged({hypothesis(79, 21)}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("too much conflict"), HasSubstr("21 %"), HasSubstr("20 %")));
}

TEST(Verdict, IsAmbiguousWhereARivalFitsAsWell) {
  const Verdict equal = judged({hypothesis(80, 1), hypothesis(80, 1)}, kChance, always_confident());
  EXPECT_EQ(equal.outcome, Outcome::kAmbiguous);
  EXPECT_EQ(equal.lead, 0);
  EXPECT_THAT(equal.reasons.front(), AllOf(HasSubstr("another pose"), HasSubstr("100 % of the evidence")));
  const VerdictOptions options = always_confident();
  // Evidence of 93.5 and of 90.5, worth 3.5 % less for its conflict; both with more of it than a spotless rival.
  EXPECT_EQ(judged({hypothesis(100, 0), hypothesis(97, 2)}, kChance, options).outcome, Outcome::kAmbiguous);
  EXPECT_EQ(judged({hypothesis(100, 0), hypothesis(94, 2)}, kChance, options).outcome, Outcome::kMerged);
}

/// Two ends of a symmetric hall: laid over each other they agree in more than where they really meet.
TEST(Verdict, DoubtsAnyLeadOverARivalWithoutConflict) {
  const VerdictOptions options = always_confident();
  const Verdict v = judged({hypothesis(200, 0, 300), hypothesis(110, 0, 150)}, kChance, options);
  EXPECT_GT(v.lead, 0.4);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_TRUE(v.vetoed);
  EXPECT_LE(v.confidence, 0.5);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("without conflict"), HasSubstr("55 % of the evidence")));
  EXPECT_EQ(judged({hypothesis(200, 0, 300), hypothesis(110, 4, 150)}, kChance, options).outcome, Outcome::kMerged);
  // A pose that only brushes the other map has no conflict either.
  EXPECT_EQ(judged({hypothesis(200, 0, 300), hypothesis(80, 0, 150)}, kChance, options).outcome, Outcome::kMerged);
}

TEST(Verdict, DoubtsALeadOverAWeakerRivalWithoutConflictToo) {
  const Verdict v =
      judged({hypothesis(200, 0, 300), hypothesis(140, 4, 300), hypothesis(110, 0, 150)}, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("without conflict"), HasSubstr("55 % of the evidence")));
}

/// It lies on more of the other map, and so on more free space.
TEST(Verdict, ARivalWithMoreEvidenceAndFarMoreConflictIsNoDoubt) {
  const Verdict v = judged({hypothesis(80, 1), hypothesis(130, 28)}, kChance, always_confident());
  EXPECT_EQ(v.lead, 0);
  EXPECT_EQ(v.outcome, Outcome::kMerged);
  EXPECT_EQ(judged({hypothesis(80, 1), hypothesis(82, 2)}, kChance, always_confident()).outcome, Outcome::kAmbiguous);
}

TEST(Verdict, ARivalThatFitsAsWellIsTheLessOfADoubtTheMoreConflicts) {
  const Hypothesis best = hypothesis(80, 1);
  Hypothesis rival = hypothesis(50, 1);
  rival.figures.elastic_evidence_m = 0.98 * best.figures.elastic_evidence_m;
  for (const double conflict_share : {0.0, 0.03}) {
    rival.figures.elastic_conflict_share = conflict_share;
    EXPECT_EQ(judged({best, rival}, kChance, always_confident()).outcome, Outcome::kAmbiguous) << conflict_share;
  }
  for (const double conflict_share : {0.06, 0.3}) {  // 0.98 * 0.94^2.5 < 0.9 * 0.99^2.5
    rival.figures.elastic_conflict_share = conflict_share;
    EXPECT_EQ(judged({best, rival}, kChance, always_confident()).outcome, Outcome::kMerged) << conflict_share;
  }
}

/// Drift takes evidence from the right pose of a bent map; where the maps may bend, it has it back.
TEST(Verdict, WhichPoseFitsAsWellIsAskedOfMapsThatMayBend) {
  const Hypothesis best = hypothesis(80, 1);
  Hypothesis rival = hypothesis(82, 2);
  rival.figures.elastic_evidence_m = 0.85 * best.figures.elastic_evidence_m;
  EXPECT_EQ(judged({best, rival}, kChance, always_confident()).outcome, Outcome::kMerged);
  rival = hypothesis(50, 1);
  rival.figures.elastic_evidence_m = 0.95 * best.figures.elastic_evidence_m;
  const Verdict v = judged({best, rival}, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("fits about as well"), HasSubstr("with 95 % of the evidence")));
  VerdictOptions no_lead = always_confident();
  no_lead.min_lead = 0;  // whatever the other one has
  rival.figures.elastic_evidence_m = 2 * best.figures.elastic_evidence_m;
  EXPECT_EQ(judged({best, rival}, kChance, no_lead).outcome, Outcome::kMerged);
}

TEST(Verdict, ListsEveryPoseThatFitsAsWell) {
  std::vector<Hypothesis> ranked(6, hypothesis(80, 0));
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    ranked[i].target_from_source.pose = {1.0 * static_cast<double>(i), 2, radians(60.0 * static_cast<double>(i))};
  }
  const Verdict v = judged(ranked, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("at x 1.00 m, y 2.00 m, theta 60.0 deg, with 100 %"),
                                       HasSubstr("theta 180.0 deg"), HasSubstr("and 1 more")));
}

TEST(Verdict, NeverMergesWhereRivalsMayHaveBeenOverlooked) {
  EXPECT_EQ(judged({hypothesis(80, 1)}, kChance, always_confident(), true).outcome, Outcome::kMerged);
  const Verdict v = judged({hypothesis(80, 1)}, kChance, always_confident(), false);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), HasSubstr("overlooked"));
}

TEST(Verdict, HasNoLeadOverABetterRival) {
  const Verdict v = judged({hypothesis(60, 0), hypothesis(80, 0)}, kChance, always_confident());
  EXPECT_EQ(v.lead, 0);
  EXPECT_EQ(v.lead_m, 0);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
}

TEST(Verdict, ConfidenceDecidesBetweenDoubtAndNothing) {
  VerdictOptions options;
  OptionList list = option_list(options);
  for (const OptionField& field : list.fields()) {
    if (field.key.starts_with("per_") || field.key.starts_with("rival_")) {
      ASSERT_EQ(list.set(field.key, "0"), "");
    }
  }
  options.min_lead = 0;
  options.spotless_conflict_share = 0;
  options.weights.bias = -5.7;
  options.weights.per.log_elastic_evidence = 2;
  options.weights.per.log_rivals = -1.5;
  // With 78 m of evidence 1 / (1 + exp(5.7 - 2 ln 78)) = 0.95; the rival, as plausible, takes 1.5 ln 2 of the log odds.
  options.min_confidence = 0.9;
  EXPECT_EQ(judged({hypothesis(80, 1)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict half = judged({hypothesis(80, 0), hypothesis(40, 0)}, kChance, options);
  EXPECT_NEAR(half.confidence, 0.883, 1e-3);
  EXPECT_EQ(half.outcome, Outcome::kAmbiguous);  // it is the rival that is in the way
  options.min_confidence = 0.96;
  const Verdict never = judged({hypothesis(80, 1)}, kChance, options);
  EXPECT_EQ(never.outcome, Outcome::kAmbiguous);  // even without a rival
  EXPECT_THAT(never.reasons.front(), AllOf(HasSubstr("not sure enough"), HasSubstr("confidence 0.95 of 0.96 wanted")));
  options.weights.bias = -10;
  const Verdict nothing = judged({hypothesis(80, 1)}, kChance, options);
  EXPECT_EQ(nothing.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(nothing.reasons.front(), AllOf(HasSubstr("too little speaks for an overlap"), HasSubstr("0.96 wanted")));
}

TEST(Verdict, NeverMergesWhereAGateIsBroken) {
  RandomStream random(1, "figures");
  int merged = 0;
  for (int i = 0; i < 20000; ++i) {
    const Hypothesis best = hypothesis(random.uniform(0, 120), random.uniform(0, 12), random.uniform(0, 200));
    const Hypothesis rival = hypothesis(random.uniform(0, 120), random.uniform(0, 30));
    const RandomLevel level{random.uniform(-80, 30), random.uniform(0, 40), 48};
    std::vector<Hypothesis> ranked{best, rival};
    if (rival.figures.evidence_m > best.figures.evidence_m) {
      std::swap(ranked[0], ranked[1]);
    }
    VerdictOptions o = always_confident();
    o.spotless_conflict_share = 0;  // that gate looks at the rival, and has a test of its own
    const Verdict v = judged(ranked, level, o);
    const Figures& f = ranked.front().figures;
    const double same_side_m = f.source_in_target.same_side_m + f.target_in_source.same_side_m;
    const Figures& g = ranked.back().figures;
    const auto elastic_support_m = [](const Figures& one) {
      return std::max(0.0, one.elastic_evidence_m) * std::pow(1 - one.elastic_conflict_share, 2.5);
    };
    const bool rivalled =
        g.evidence_m > 0.3 * f.evidence_m && elastic_support_m(g) > (1 - o.min_lead) * elastic_support_m(f);
    const bool broken = f.evidence_m < o.min_evidence_m || same_side_m < o.min_same_side_m || rivalled ||
                        f.conflict_share > o.max_conflict_share || v.deviations < o.min_deviations;
    ASSERT_EQ(v.vetoed, broken);
    ASSERT_EQ(v.outcome == Outcome::kMerged, !broken && v.confidence >= o.needed_confidence());
    ASSERT_THAT(v.reasons, Not(IsEmpty()));
    ASSERT_GE(v.confidence, 0);
    ASSERT_LE(v.confidence, 1);
    ASSERT_GE(v.lead, 0);
    ASSERT_LE(v.lead, 1);
    ASSERT_TRUE(std::isfinite(v.deviations));
    if (v.outcome != Outcome::kMerged) {
      ASSERT_LE(v.confidence, o.needed_confidence());
    }
    merged += v.outcome == Outcome::kMerged ? 1 : 0;
  }
  EXPECT_GT(merged, 200);
  EXPECT_LT(merged, 18000);
}

/// Another storey: the same walls, everything between them elsewhere.
Hypothesis other_storey() {
  Hypothesis one = hypothesis(150, 12);
  one.figures.furniture_conflict_share = 0.9;
  one.figures.elastic_both_furniture_conflict_share = 0.6;
  one.figures.both_far_conflict_share = 0.05;
  one.figures.overlap_share = 0.9;
  one.target_from_source.covariance = 1e-6 * PoseCovariance::Identity();
  return one;
}
const RandomLevel kFurnishedChance{.mean_m = -20, .deviation_m = 35, .poses = 48};

TEST(Verdict, WallsThatAgreeAroundOtherFurnitureAreADoubtAndNoMissingOverlap) {
  const Verdict v = judged({other_storey()}, kFurnishedChance, {});
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("90 % of the furniture"), HasSubstr("another storey")));
  EXPECT_LE(v.confidence, VerdictOptions{}.needed_confidence());
}

TEST(Verdict, OtherFurnitureIsNotBlamedForWhatTheWallsLack) {
  Hypothesis poor = other_storey();
  poor.figures.elastic_evidence_m = 5;
  poor.figures.overlap_share = 0.05;
  const Verdict v = judged({poor}, kFurnishedChance, {});
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons, Not(Contains(HasSubstr("storey"))));
}

TEST(Confidence, LearnedWeightsPointTheRightWay) {
  const ConfidenceWeights weights = VerdictOptions::learned_weights();
  using F = ConfidenceFigures;
  for (const auto& [figure, sign] : {std::pair{&F::log_elastic_evidence, 1},
                                     {&F::spotless_rival, -1},
                                     {&F::decoy_doubt, -1},
                                     {&F::log_rivals, -1},
                                     {&F::log_both_far, -1},
                                     {&F::furniture, -1},
                                     {&F::both_furniture, -1}}) {
    EXPECT_GT(sign * (weights.per.*figure), 0);
  }
  EXPECT_LT(weights.per_rival.log_conflict, 0);
  EXPECT_GT(weights.per_rival.log_overlap_share, 0);
}

/// A flat seen twice, as the drawn ones are; then what speaks against it.
TEST(Confidence, IsHighForAClearPoseAndLowForADoubtfulOne) {
  const ConfidenceFigures clear{.log_rivals = 0.1,
                                .spotless_rival = 0.1,
                                .decoy_doubt = 0,
                                .log_deviations = 1.3,
                                .log_both_far = -5.3,
                                .furniture = 0.05,
                                .both_furniture = 0,
                                .log_elastic_evidence = 4.6,
                                .log_overlap_share = -0.2,
                                .log_weak = -4,
                                .weak_direction = 0};
  const ConfidenceWeights weights = VerdictOptions::learned_weights();
  EXPECT_GT(confidence_of(clear, weights), 0.9);
  ConfidenceFigures doubtful = clear;
  doubtful.decoy_doubt = 0.6;
  doubtful.log_elastic_evidence = 2.5;
  doubtful.log_rivals = 1.2;
  doubtful.furniture = 0.4;
  doubtful.both_furniture = 0.1;
  doubtful.log_both_far = -3.1;
  EXPECT_LT(confidence_of(doubtful, weights), 0.5);
}

TEST(Confidence, IsALogisticFunctionOfItsTerms) {
  ConfidenceWeights weights;
  weights.bias = 0.5;
  weights.per.log_elastic_evidence = 2;
  weights.per.furniture = -3;
  ConfidenceFigures figures;
  figures.log_elastic_evidence = 0.4;
  figures.furniture = 0.1;
  EXPECT_NEAR(confidence_of(figures, weights), 1 / (1 + std::exp(-(0.5 + 0.8 - 0.3))), 1e-12);
  std::vector<std::string> names;
  for (const ConfidenceTerm& term : confidence_terms()) {
    names.emplace_back(term.name);
  }
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_EQ(sizeof(ConfidenceFigures), names.size() * sizeof(double));  // none is forgotten
}

TEST(Rivals, AddUpToADoubt) {
  const RivalFigures weights{.log_conflict = -1, .elastic_gain = 5, .log_overlap_share = 2};
  const RivalFigures equal;
  EXPECT_EQ(log_rivals({}, weights), 0);
  EXPECT_NEAR(log_rivals({equal}, weights), std::log(2), 1e-12);
  EXPECT_NEAR(log_rivals({equal, equal}, weights), std::log(3), 1e-12);
  const RivalFigures cleaner{.log_conflict = -0.5, .elastic_gain = 0.1, .log_overlap_share = 0.3};
  EXPECT_NEAR(plausibility(cleaner, weights), std::exp(0.5 + 0.5 + 0.6), 1e-9);
  EXPECT_TRUE(std::isfinite(log_rivals({{.log_conflict = -1e9}}, weights)));
  EXPECT_EQ(plausibility({.log_conflict = -1e9}, weights), std::exp(12));  // no more doubt than that can be had
  EXPECT_EQ(sizeof(RivalFigures), rival_terms().size() * sizeof(double));  // none is forgotten
}

TEST(Rivals, ArePlausibleByWhatTheyHaveMoreThanTheBestPose) {
  Hypothesis rival = hypothesis(40, 4);
  rival.figures.overlap_share = 0.25;
  VerdictOptions options;
  options.weights.per_rival = {.log_conflict = -1, .elastic_gain = 10, .log_overlap_share = 1};
  const Verdict v = judged({hypothesis(80, 1), rival, hypothesis(1, 30)}, kChance, options);
  ASSERT_EQ(v.rivals.size(), 1U);  // more speaks against the other one than for it
  EXPECT_NEAR(v.rivals[0].log_conflict, std::log(4 / 44.0 + 0.01) - std::log(1 / 81.0 + 0.01), 1e-9);
  EXPECT_NEAR(v.rivals[0].elastic_gain, 0.3 * (4 / 44.0 - 1 / 81.0), 1e-9);
  EXPECT_NEAR(v.rivals[0].log_overlap_share, std::log(0.5), 1e-9);
  EXPECT_NEAR(v.figures.log_rivals, log_rivals(v.rivals, options.weights.per_rival), 1e-12);
  EXPECT_THAT(v.reasons, Contains(HasSubstr("all together are 0.14 times as plausible as this one")));
}

/// With as much evidence, that which overlaps more with no more conflict is the greater doubt.
TEST(Rivals, LowerTheConfidenceTheMoreThePoseOfTheirsIsPlausible) {
  Hypothesis brushing = hypothesis(30, 5);
  brushing.figures.overlap_share = 0.1;
  Hypothesis covering = hypothesis(21.5, 0.15);
  covering.figures.evidence_m = brushing.figures.evidence_m;
  covering.figures.overlap_share = 0.6;
  const ConfidenceWeights weights = VerdictOptions::learned_weights();
  const auto told = [&](const Hypothesis& rival) {
    ConfidenceFigures figures = judged({hypothesis(80, 4), rival}, kChance, {}).figures;
    figures.spotless_rival = 0;
    return confidence_of(figures, weights);
  };
  EXPECT_LT(told(covering), told(brushing));
}

TEST(Rivals, TheMostPlausibleIsNamed) {
  Hypothesis best = hypothesis(60, 8);
  Hypothesis brushing = hypothesis(30, 3);
  brushing.figures.overlap_share = 0.1;
  Hypothesis covering = hypothesis(28, 2);
  covering.figures.overlap_share = 0.9;
  covering.target_from_source.pose = {7, 0, 0};
  VerdictOptions options;
  options.weights.bias += 1.5;
  options.min_confidence = 0.9999;
  const Verdict v = judged({best, brushing, covering}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("while another pose fits"), HasSubstr("at x 7.00 m")));
}

/// However plausible, and however much evidence it has where the maps may bend: that is the best one's own.
TEST(Rivals, APoseThatBendsIntoTheBestOneIsNone) {
  Hypothesis best = hypothesis(80, 1);
  best.figures.elastic_layout = {{0, {2, 2}, 10}, {1, {6, 2}, 10}, {3, {10, 2}, 10}};
  Hypothesis rival = hypothesis(50, 1);
  rival.figures.elastic_evidence_m = best.figures.elastic_evidence_m;
  const auto with_its_patches_at = [&](std::vector<LaidPatch> layout) {
    rival.figures.elastic_layout = std::move(layout);
    return judged({best, rival}, kChance, always_confident());
  };
  const Verdict bent = with_its_patches_at({{0, {2.1, 1.9}, 4}, {2, {6, 2}, 3}, {3, {10, 2.2}, 4}});
  EXPECT_EQ(bent.outcome, Outcome::kMerged);
  EXPECT_TRUE(bent.rivals.empty());
  for (const std::vector<LaidPatch>& elsewhere :
       {std::vector<LaidPatch>{{0, {2.4, 2}, 4}, {1, {6.4, 2}, 4}, {3, {10.4, 2}, 4}},  // beside it all the same
        std::vector<LaidPatch>{{0, {2, 2}, 3}, {1, {7, 2}, 5}, {3, {10, 3}, 5}},        // most of its walls elsewhere
        std::vector<LaidPatch>{{4, {2, 2}, 5}}, std::vector<LaidPatch>{}}) {            // other patches, none at all
    const Verdict v = with_its_patches_at(elsewhere);
    EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
    EXPECT_EQ(v.rivals.size(), 1U);
  }
}

TEST(Rivals, OneThatIsFarMorePlausibleShouldHaveBeenFirst) {
  VerdictOptions options;
  options.weights.per_rival = {.log_conflict = 0, .elastic_gain = 0, .log_overlap_share = 1};
  const auto overlapping = [](double share) {
    Hypothesis one = hypothesis(60, 2);
    one.figures.overlap_share = share;
    return one;
  };
  EXPECT_EQ(far_more_plausible({}, options), 0U);
  EXPECT_EQ(far_more_plausible({overlapping(0.1)}, options), 0U);
  EXPECT_EQ(far_more_plausible({overlapping(0.1), overlapping(0.29)}, options), 0U);  // 2.9 times
  EXPECT_EQ(far_more_plausible({overlapping(0.1), overlapping(0.35), overlapping(0.5), overlapping(0.4)}, options), 2U);
  Hypothesis found = overlapping(0.5);
  found.proposed = false;  // the pipeline's own is no method's answer
  EXPECT_EQ(far_more_plausible({overlapping(0.1), found, overlapping(0.4)}, options), 2U);
  Hypothesis poor = overlapping(0.5);
  poor.figures.elastic_evidence_m *= 0.45;
  EXPECT_EQ(far_more_plausible({overlapping(0.1), poor}, options), 0U);
  Hypothesis first = overlapping(0.1);
  Hypothesis bending = overlapping(0.5);
  first.figures.elastic_layout = bending.figures.elastic_layout = {{0, {1, 1}, 9}};
  EXPECT_EQ(far_more_plausible({first, bending}, options), 0U);
}

/// It was put first for its plausibility, not for its support: that is a doubt.
TEST(Rivals, AMethodsOtherPoseWithMoreSupportIsADoubt) {
  Hypothesis best = hypothesis(60, 2);
  best.figures.support_m = 40;
  Hypothesis other = hypothesis(50, 3);
  const auto outranked = [&](double support_m, bool proposed) {
    other.figures.support_m = support_m;
    other.proposed = proposed;
    return judged({best, hypothesis(20, 3), other}, kChance, {}).figures.outranked;
  };
  EXPECT_EQ(outranked(39, true), 0);
  EXPECT_EQ(outranked(41, true), 1);
  EXPECT_EQ(outranked(41, false), 0);  // the pipeline's own is no method's answer
  EXPECT_LT(VerdictOptions::learned_weights().per.outranked, 0);
}

TEST(Rivals, ThoseFarDownTheListAreNotAskedFor) {
  std::vector<Hypothesis> ranked(kCompared + 5, hypothesis(10, 0.5));
  ranked.front() = hypothesis(80, 1);
  EXPECT_EQ(judged(ranked, kChance, {}).rivals.size(), kCompared - 1);
}

TEST(Strictness, GrowsFromEagerToCautious) {
  VerdictOptions options;
  double last = 1;
  for (const char* name : {"cautious", "normal", "eager"}) {
    options.strictness = name;
    EXPECT_LT(options.needed_confidence(), last) << name;
    EXPECT_NO_THROW(require_valid(options, "verdict"));
    last = options.needed_confidence();
  }
  options.min_confidence = 0.42;
  EXPECT_EQ(options.needed_confidence(), 0.42);
  options.strictness = "reckless";
  EXPECT_THROW(require_valid(options, "verdict"), std::invalid_argument);
}

TEST(Verdict, TellsInWordsWhichWayTheWallsDoNotFixThePose) {
  Hypothesis corridor = hypothesis(80, 1);
  const double along = radians(30);
  const Eigen::Vector2d way(std::cos(along), std::sin(along));
  PoseCovariance covariance = 1e-4 * PoseCovariance::Identity();
  covariance(2, 2) = 1e-8;
  covariance.topLeftCorner<2, 2>() += 4 * way * way.transpose();
  corridor.target_from_source.covariance = covariance;
  EXPECT_THAT(judged({corridor}, kChance, always_confident()).reasons,
              Contains(AllOf(HasSubstr("along 30 deg"), HasSubstr("2.00 m"))));
  corridor.target_from_source.covariance = 1e-4 * PoseCovariance::Identity();
  EXPECT_THAT(judged({corridor}, kChance, always_confident()).reasons, Not(Contains(HasSubstr("hardly fix"))));
}

// What a covariance says of the translation depends on where the origins lie: the same heading's doubt counts metres
// there.
TEST(Verdict, AsksHowWellAPoseIsFixedWhereTheSourceLiesAndNotAtItsOrigin) {
  const PoseCovariance at_centre = Eigen::Vector3d(4e-4, 1e-4, 1e-6).asDiagonal();
  for (const Point2 centre : {Point2{3, -2}, Point2{4000, 9000}}) {
    Hypothesis one = hypothesis(80, 1);
    one.target_from_source.pose = {1, 2, 0.7};
    const Point2 arm = one.target_from_source.pose * centre - one.target_from_source.pose.translation();
    Eigen::Matrix3d origin_by_centre = Eigen::Matrix3d::Identity();
    origin_by_centre(0, 2) = arm.y_m;
    origin_by_centre(1, 2) = -arm.x_m;
    one.target_from_source.covariance = origin_by_centre * at_centre * origin_by_centre.transpose();
    const Background background{.random = kChance, .decoy = {}, .source_centre = centre};
    const Verdict v = judge({one}, background, always_confident());
    EXPECT_EQ(v.outcome, Outcome::kMerged);
    EXPECT_NEAR(v.figures.log_weak, std::log(std::sqrt(4e-4 + 1e-6 * 20 * 20)), 1e-6);
  }
}

TEST(Verdict, OutcomesHaveStableNames) {
  EXPECT_EQ(to_string(Outcome::kMerged), "merged");
  EXPECT_EQ(to_string(Outcome::kAmbiguous), "ambiguous");
  EXPECT_EQ(to_string(Outcome::kNoOverlap), "no_overlap");
  EXPECT_EQ(to_string(Outcome::kDeclined), "declined");
  EXPECT_EQ(to_string(Outcome::kStopped), "stopped");
}

}  // namespace
}  // namespace gridmerge
