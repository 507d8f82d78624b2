#include "gridmerge/judge/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  f.overlap_area_m2 = overlap_m2;
  f.overlap_share = 0.5;
  f.mutual_information_bit = 0.3;
  return one;
}

/// The confidence is always 1, so that each other gate can be seen to decide alone.
VerdictOptions always_confident() {
  VerdictOptions options;
  options.bias = 1000;
  return options;
}

TEST(Verdict, MergesWhatNothingSpeaksAgainst) {
  const Verdict v = judge({hypothesis(80, 1), hypothesis(20, 4)}, kChance, {});
  EXPECT_EQ(v.outcome, Outcome::kMerged);
  EXPECT_GE(v.confidence, VerdictOptions{}.min_confidence);
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
  const Verdict v = judge({hypothesis(80, 1), hypothesis(20, 1), hypothesis(60, 2)}, kChance, {});
  EXPECT_NEAR(v.lead_m, 78.25 - 56.5, 1e-9);
  // A rival with more evidence than the first: ranked lower for its conflict, and a doubt.
  const Verdict passed = judge({hypothesis(80, 1), hypothesis(120, 15)}, kChance, always_confident());
  EXPECT_EQ(passed.lead, 0);
  EXPECT_EQ(passed.outcome, Outcome::kAmbiguous);
}

TEST(Verdict, LeadsByAllItHasWhereThereIsNoRival) {
  const Verdict alone = judge({hypothesis(80, 1)}, kChance, {});
  EXPECT_EQ(alone.outcome, Outcome::kMerged);
  EXPECT_EQ(alone.lead, 1);
  const Verdict worthless_rival = judge({hypothesis(80, 1), hypothesis(1, 30)}, kChance, {});
  EXPECT_EQ(worthless_rival.lead, 1);
}

TEST(Verdict, FindsNoOverlapWithoutAnyPose) {
  const Verdict v = judge({}, {}, {});
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_EQ(v.confidence, 0);
  EXPECT_THAT(v.reasons, Not(IsEmpty()));
}

TEST(Verdict, FindsNoOverlapWhereMoreWallsStandInFreeSpace) {
  const Verdict v = judge({hypothesis(50, 40)}, kChance, always_confident());
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_EQ(v.confidence, 0);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("free space"), HasSubstr("50.0 m"), HasSubstr("40.0 m")));
}

TEST(Verdict, FindsNoOverlapWhereTooLittleIsInCommon) {
  VerdictOptions options = always_confident();
  options.min_same_side_m = 12;
  EXPECT_EQ(judge({hypothesis(12.1, 0)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict v = judge({hypothesis(11.9, 0)}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("too little in common"), HasSubstr("11.9 m"), HasSubstr("12.0 m")));
}

TEST(Verdict, FindsNoOverlapWhereChanceWouldDoAsWell) {
  VerdictOptions options = always_confident();
  options.min_deviations = 3;
  const RandomLevel level{.mean_m = 10, .deviation_m = 20, .poses = 48};
  EXPECT_EQ(judge({hypothesis(71, 0)}, level, options).outcome, Outcome::kMerged);
  const Verdict v = judge({hypothesis(69, 0)}, level, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("3.0"), HasSubstr("standard deviations above random poses")));
}

TEST(Verdict, DoesNotMergeWhereNothingIsKnownOfChance) {
  EXPECT_NE(judge({hypothesis(80, 1)}, RandomLevel{}, always_confident()).outcome, Outcome::kMerged);
}

TEST(Verdict, FindsNoOverlapWhereThereIsTooMuchConflict) {
  VerdictOptions options = always_confident();
  options.max_conflict_share = 0.2;
  EXPECT_EQ(judge({hypothesis(81, 19)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict v = judge({hypothesis(79, 21)}, kChance, options);
  EXPECT_EQ(v.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("too much conflict"), HasSubstr("21 %"), HasSubstr("20 %")));
}

TEST(Verdict, IsAmbiguousWhereARivalFitsAsWell) {
  const Verdict equal = judge({hypothesis(80, 1), hypothesis(80, 1)}, kChance, {});
  EXPECT_EQ(equal.outcome, Outcome::kAmbiguous);
  EXPECT_EQ(equal.lead, 0);
  EXPECT_THAT(equal.reasons.front(), AllOf(HasSubstr("another pose"), HasSubstr("100 % of the evidence")));
  VerdictOptions options = always_confident();
  options.min_lead = 0.1;
  // Evidence of 91 and of 89, both with more conflict than a spotless rival.
  EXPECT_EQ(judge({hypothesis(100, 0), hypothesis(94.5, 2)}, kChance, options).outcome, Outcome::kAmbiguous);
  EXPECT_EQ(judge({hypothesis(100, 0), hypothesis(92.5, 2)}, kChance, options).outcome, Outcome::kMerged);
}

/// Two ends of a symmetric hall: laid over each other they agree in more than where they really meet.
TEST(Verdict, DoubtsAnyLeadOverARivalWithoutConflict) {
  const Verdict v = judge({hypothesis(200, 0, 300), hypothesis(80, 0, 150)}, kChance, {});
  EXPECT_GT(v.lead, 0.5);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("without conflict"), HasSubstr("80.0 m")));
  EXPECT_EQ(judge({hypothesis(200, 0, 300), hypothesis(80, 4, 150)}, kChance, {}).outcome, Outcome::kMerged);
  EXPECT_EQ(judge({hypothesis(200, 0, 300), hypothesis(5, 0, 3)}, kChance, {}).outcome, Outcome::kMerged);
}

TEST(Verdict, DoubtsALeadOverAWeakerRivalWithoutConflictToo) {
  const Verdict v = judge({hypothesis(200, 0, 300), hypothesis(140, 4, 300), hypothesis(80, 0, 150)}, kChance, {});
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), AllOf(HasSubstr("without conflict"), HasSubstr("80.0 m")));
  // A pose that only brushes the other map has no conflict either.
  EXPECT_EQ(judge({hypothesis(200, 0, 300), hypothesis(140, 4, 300), hypothesis(40, 0, 150)}, kChance, {}).outcome,
            Outcome::kMerged);
}

TEST(Verdict, NeverMergesWhereRivalsMayHaveBeenOverlooked) {
  EXPECT_EQ(judge({hypothesis(80, 1)}, kChance, {}, true).outcome, Outcome::kMerged);
  const Verdict v = judge({hypothesis(80, 1)}, kChance, {}, false);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(v.reasons.front(), HasSubstr("overlooked"));
}

TEST(Verdict, HasNoLeadOverABetterRival) {
  const Verdict v = judge({hypothesis(60, 0), hypothesis(80, 0)}, kChance, {});
  EXPECT_EQ(v.lead, 0);
  EXPECT_EQ(v.lead_m, 0);
  EXPECT_EQ(v.outcome, Outcome::kAmbiguous);
}

TEST(Verdict, ConfidenceDecidesBetweenDoubtAndNothing) {
  VerdictOptions options;
  OptionList list = option_list(options);
  for (const OptionField& field : list.fields()) {
    if (field.key.starts_with("per_")) {
      ASSERT_EQ(list.set(field.key, "0"), "");
    }
  }
  options.min_lead = 0;
  options.spotless_conflict_share = 0;
  options.bias = -1;
  options.per_lead = 4;
  // With all of the lead: 1 / (1 + exp(-3)) = 0.95; with half of it 0.73.
  options.min_confidence = 0.9;
  EXPECT_EQ(judge({hypothesis(80, 1)}, kChance, options).outcome, Outcome::kMerged);
  const Verdict half = judge({hypothesis(80, 0), hypothesis(40, 0)}, kChance, options);
  EXPECT_NEAR(half.confidence, 0.731, 1e-3);
  EXPECT_EQ(half.outcome, Outcome::kAmbiguous);  // it is the rival that is in the way
  options.min_confidence = 0.96;
  const Verdict never = judge({hypothesis(80, 1)}, kChance, options);
  EXPECT_EQ(never.outcome, Outcome::kNoOverlap);  // even without a rival
  EXPECT_THAT(never.reasons.front(), AllOf(HasSubstr("confidence 0.95"), HasSubstr("0.96 wanted")));
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
    VerdictOptions o;
    o.spotless_conflict_share = 0;  // that gate looks at the rival, and has a test of its own
    const Verdict v = judge(ranked, level, o);
    const Figures& f = ranked.front().figures;
    const double same_side_m = f.source_in_target.same_side_m + f.target_in_source.same_side_m;
    const bool broken = f.evidence_m <= 0 || same_side_m < o.min_same_side_m || v.lead < o.min_lead ||
                        f.conflict_share > o.max_conflict_share || v.deviations < o.min_deviations ||
                        v.confidence < o.min_confidence;
    ASSERT_EQ(v.outcome == Outcome::kMerged, !broken);
    ASSERT_THAT(v.reasons, Not(IsEmpty()));
    ASSERT_GE(v.confidence, 0);
    ASSERT_LE(v.confidence, 1);
    ASSERT_GE(v.lead, 0);
    ASSERT_LE(v.lead, 1);
    ASSERT_TRUE(std::isfinite(v.deviations));
    if (v.outcome == Outcome::kAmbiguous) {
      ASSERT_LE(v.confidence, o.min_confidence);
    } else if (v.outcome == Outcome::kNoOverlap) {
      ASSERT_LE(v.confidence, 0.5 * o.min_confidence);
    }
    merged += broken ? 0 : 1;
  }
  EXPECT_GT(merged, 200);
  EXPECT_LT(merged, 18000);
}

/// The confidence itself, before a verdict caps it.
double confidence(const Figures& figures, double rival_m) {
  VerdictOptions open;
  open.min_same_side_m = 0;
  open.min_lead = 0;
  open.max_conflict_share = 1;
  open.min_deviations = 0;
  open.min_confidence = 0;
  Hypothesis best;
  best.figures = figures;
  return judge({best, hypothesis(rival_m, 0)}, {-1e6, 1, 48}, open).confidence;
}

TEST(Verdict, ConfidenceRisesWithEverythingThatSpeaksForAPose) {
  RandomStream random(2, "figures");
  for (int i = 0; i < 2000; ++i) {
    const double same_side_m = random.uniform(5, 100);
    const double in_free_m = random.uniform(0, 4);
    const double overlap_m2 = random.uniform(1, 200);
    const double rival_m = random.uniform(0, 5);
    const Figures f = hypothesis(same_side_m, in_free_m, overlap_m2).figures;
    if (f.evidence_m <= rival_m) {
      continue;
    }
    const double base = confidence(f, rival_m);
    ASSERT_GE(confidence(hypothesis(1.1 * same_side_m, in_free_m, overlap_m2).figures, rival_m), base);
    ASSERT_LE(confidence(hypothesis(same_side_m, in_free_m + 0.5, overlap_m2).figures, rival_m), base);
    ASSERT_GE(confidence(hypothesis(same_side_m, in_free_m, 1.2 * overlap_m2).figures, rival_m), base);
    ASSERT_LE(confidence(f, rival_m + 0.1 * (f.evidence_m - rival_m)), base);
    Figures other = f;
    other.overlap_share += 0.2;
    ASSERT_GE(confidence(other, rival_m), base);
    other = f;
    other.mutual_information_bit += 0.1;
    ASSERT_GE(confidence(other, rival_m), base);
    ASSERT_GE(base, 0);
    ASSERT_LE(base, 1);
  }
}

TEST(Verdict, TellsInWordsWhichWayTheWallsDoNotFixThePose) {
  Hypothesis corridor = hypothesis(80, 1);
  const double along = radians(30);
  const Eigen::Vector2d way(std::cos(along), std::sin(along));
  PoseCovariance covariance = 1e-4 * PoseCovariance::Identity();
  covariance.topLeftCorner<2, 2>() += 4 * way * way.transpose();
  corridor.target_from_source.covariance = covariance;
  EXPECT_THAT(judge({corridor}, kChance, {}).reasons, Contains(AllOf(HasSubstr("along 30 deg"), HasSubstr("2.00 m"))));
  corridor.target_from_source.covariance = 1e-4 * PoseCovariance::Identity();
  EXPECT_THAT(judge({corridor}, kChance, {}).reasons, Not(Contains(HasSubstr("hardly fix"))));
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
