#include "methods/genetic/genetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {

namespace {

using testing::IsEmpty;
using testing::Not;

/// Where drift has bent the maps, the truth at the start poses is not where they fit best.
struct Tolerance {
  double distance_m = 0.2;
  double angle_deg = 0.7;
};

bool right(const worlds::MapPair& pair, const Pose2& pose, const Tolerance& tolerance = {}) {
  const PoseDifference error = pose_error(pair, pose);
  return error.distance_m < tolerance.distance_m && degrees(error.angle_rad) < tolerance.angle_deg;
}

Alignment aligned(const worlds::MapPair& pair, std::uint64_t seed = 1) {
  return align({.target = pair.target, .source = pair.source, .prior = {}}, GeneticMerger({}), {},
               {.seed = seed, .num_threads = 2});
}

RunContext run(std::uint64_t seed, const StopToken& stop = {}, TraceSink* trace = nullptr) {
  return {.seed = seed, .num_threads = 1, .stop = stop, .trace = trace};
}

GeneticOptions uniform_seeding() {
  GeneticOptions options;
  options.seeding = "uniform";
  return options;
}

class GeneticOnKnownPairs : public testing::TestWithParam<KnownPair> {};

TEST_P(GeneticOnKnownPairs, IsRightWhereTheMapsSayItAndNeverMergesWhereTheyDoNot) {
  const KnownPair& known = GetParam();
  const bool bent = known.options.drift_m > 0;
  const Tolerance tolerance = bent ? Tolerance{.distance_m = 1, .angle_deg = 3} : Tolerance{};
  // A wrong merge is the worst of errors: where there is nothing to merge, more scenes are tried.
  const int scenes = known.overlaps && !known.ambiguous ? 1 : 2;
  for (int seed = 1; seed <= scenes; ++seed) {
    const worlds::MapPair pair = worlds::make_scene(known_pair(known.name, seed));
    const Alignment alignment = aligned(pair);
    const std::string told = "scene " + std::to_string(seed) + ": " + testing::PrintToString(alignment.reasons);
    if (!known.overlaps || known.ambiguous) {
      EXPECT_NE(alignment.outcome, Outcome::kMerged) << told;
    } else {
      EXPECT_EQ(alignment.outcome, Outcome::kMerged) << told;
      ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
      EXPECT_TRUE(right(pair, alignment.hypotheses.front().target_from_source.pose, tolerance)) << told;
    }
    if (known.ambiguous) {
      EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous) << told;
      EXPECT_GE(alignment.hypotheses.size(), 2U);
    }
  }
}

std::string pair_name(const testing::TestParamInfo<KnownPair>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, GeneticOnKnownPairs, testing::ValuesIn(known_pairs()), pair_name);

TEST(Genetic, IsRightForEverySeed) {
  const worlds::MapPair& pair = flat().pair;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Alignment alignment =
        align_prepared(flat().request(), GeneticMerger({}), {}, {.seed = seed, .num_threads = 2});
    EXPECT_EQ(alignment.outcome, Outcome::kMerged) << "seed " << seed;
    ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
    EXPECT_TRUE(right(pair, alignment.hypotheses.front().target_from_source.pose)) << "seed " << seed;
  }
}

TEST(Genetic, OtherSeedsDrawOtherNumbers) {
  const GeneticMerger method({});
  const Proposal first = method.propose(flat().request(), run(1));
  const Proposal other = method.propose(flat().request(), run(2));
  EXPECT_NE(first.carry.target_from_source, other.carry.target_from_source);
}

TEST(Genetic, RecordsEveryGeneration) {
  struct Recorder : TraceSink {
    std::vector<std::string> stages;
    std::vector<IterationRecord> records;
    void on_stage(const std::string& name) override { stages.push_back(name); }
    void on_iteration(const IterationRecord& record) override { records.push_back(record); }
  };
  const GeneticOptions options;
  Recorder recorder;
  const Proposal proposal = GeneticMerger(options).propose(flat().request(), run(3, {}, &recorder));
  EXPECT_THAT(recorder.stages, testing::ElementsAre("propose/sweep", "propose/evolve"));
  ASSERT_EQ(static_cast<int>(recorder.records.size()), options.generations);
  EXPECT_EQ(proposal.iterations, options.generations);
  for (std::size_t i = 0; i < recorder.records.size(); ++i) {
    const IterationRecord& record = recorder.records[i];
    EXPECT_EQ(record.stage, "propose/evolve");
    EXPECT_EQ(record.iteration, static_cast<int>(i));
    EXPECT_EQ(record.iterations, options.generations);
    EXPECT_GE(record.best_score, recorder.records[i == 0 ? 0 : i - 1].best_score) << "generation " << i;
    EXPECT_GE(record.best_score, record.mean_score);
    ASSERT_THAT(record.population, Not(IsEmpty()));
    EXPECT_LE(record.population.size(), static_cast<std::size_t>(options.population));
    EXPECT_EQ(record.population.front(), record.best_target_from_source);
  }
  EXPECT_EQ(recorder.records.back().best_score, proposal.candidates.front().method_score);
  EXPECT_LT(recorder.records.back().population.size(), recorder.records.front().population.size());
}

TEST(Genetic, ProposesDistinctNiches) {
  const GeneticOptions options;
  const Proposal proposal = GeneticMerger(options).propose(flat().request(), run(3));
  ASSERT_GT(proposal.candidates.size(), 4U);
  EXPECT_LE(proposal.candidates.size(), static_cast<std::size_t>(options.candidates));
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[k].target_from_source);
      EXPECT_TRUE(apart.distance_m >= options.niche_m - 1e-6 || apart.angle_rad >= radians(options.niche_deg) - 1e-6);
    }
  }
}

TEST(Genetic, TakesUpTheCarriedPopulation) {
  // Without a sweep and with hardly any chance, only what is carried can hold the truth.
  GeneticOptions options = uniform_seeding();
  options.population = 4;
  const GeneticMerger method(options);
  const Population carried{{flat().truth_off_by(0.1, -0.1, 1), flat().truth_off_by(5, 2, 100)}};
  EXPECT_FALSE(flat().found_by(method.propose(flat().request(), run(1))));
  const Proposal warm = method.propose(flat().request({}, &carried), run(1));
  EXPECT_TRUE(flat().found_by(warm));
  // And epoch by epoch it does not get worse.
  const Proposal next = method.propose(flat().request({}, &warm.carry), run(2));
  EXPECT_TRUE(flat().found_by(next));
  EXPECT_GE(next.candidates.front().method_score, warm.candidates.front().method_score - 1e-6);
}

TEST(Genetic, CarriesWhatItProposes) {
  const Proposal proposal = GeneticMerger({}).propose(flat().request(), run(1));
  ASSERT_EQ(proposal.carry.target_from_source.size(), proposal.candidates.size());
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    EXPECT_EQ(proposal.carry.target_from_source[i], proposal.candidates[i].target_from_source);
  }
}

TEST(Genetic, UniformSeedingFindsTheTruthInAWindow) {
  const GeneticMerger method(uniform_seeding());
  const PosePrior window{
      .target_from_source = flat().truth_off_by(0.6, -0.5, 10), .radius_m = 1.2, .angle_rad = radians(20)};
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Proposal proposal = method.propose(flat().request(window), run(seed));
    found += flat().found_by(proposal) ? 1 : 0;
    for (const Candidate& candidate : proposal.candidates) {
      const PoseDifference off =
          difference_at(flat().source.centre_in_map(), candidate.target_from_source, window.target_from_source);
      ASSERT_LE(off.distance_m, *window.radius_m + 1e-6);
      ASSERT_LE(off.angle_rad, *window.angle_rad + 1e-6);
    }
  }
  EXPECT_GE(found, 9) << "of 10 seeds";
}

TEST(Genetic, APriorWithoutAFenceIsOnlyAStart) {
  for (const Pose2& start : {flat().truth_off_by(0.2, 0.1, 2), flat().truth_off_by(7, -4, 150), Pose2{500, -300, 1}}) {
    const AlignRequest request =
        flat().request(PosePrior{.target_from_source = start, .radius_m = {}, .angle_rad = {}});
    const Alignment alignment = align_prepared(request, GeneticMerger({}), {}, run(1));
    EXPECT_EQ(alignment.outcome, Outcome::kMerged);
    ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
    EXPECT_TRUE(right(flat().pair, alignment.hypotheses.front().target_from_source.pose));
  }
}

TEST(Genetic, AGoodStartMakesUpForChance) {
  // Without a sweep, a start near the truth is what it lives on.
  GeneticOptions options = uniform_seeding();
  options.population = 20;
  const GeneticMerger method(options);
  const PosePrior start{.target_from_source = flat().truth_off_by(0.25, -0.2, 3), .radius_m = {}, .angle_rad = {}};
  EXPECT_TRUE(flat().found_by(method.propose(flat().request(start), run(1))));
  EXPECT_FALSE(flat().found_by(method.propose(flat().request(), run(1))));
}

TEST(Genetic, AFenceThatShutsTheTruthOutIsKept) {
  const PosePrior fence{.target_from_source = flat().truth_off_by(4, 1, 60), .radius_m = 1, .angle_rad = radians(20)};
  const Alignment alignment = align_prepared(flat().request(fence), GeneticMerger({}), {}, run(1));
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
}

TEST(Genetic, MoreGenerationsDoNotMakeItWorse) {
  GeneticOptions options;
  double last = 0;
  for (const int generations : {1, 4, 16}) {
    options.generations = generations;
    const Proposal proposal = GeneticMerger(options).propose(flat().request(), run(1));
    EXPECT_EQ(proposal.iterations, generations);
    EXPECT_GE(proposal.candidates.front().method_score, 0.98 * last);
    last = proposal.candidates.front().method_score;
  }
}

TEST(Genetic, GivesItsBestSoFarWhenItIsStoppedWhileItEvolves) {
  /// Cancels once it has seen the third generation.
  struct Impatient : TraceSink {
    StopToken stop;
    void on_iteration(const IterationRecord& record) override {
      if (record.iteration == 2) {
        stop.cancel();
      }
    }
  };
  Impatient watcher;
  const Proposal proposal = GeneticMerger({}).propose(flat().request(), run(1, watcher.stop, &watcher));
  EXPECT_TRUE(proposal.stopped);
  EXPECT_EQ(proposal.iterations, 3);
  EXPECT_TRUE(flat().found_by(proposal));
}

TEST(Genetic, SaysWhetherItHasLookedEverywhere) {
  EXPECT_TRUE(GeneticMerger({}).propose(flat().request(), run(1)).surveyed);
  EXPECT_FALSE(GeneticMerger(uniform_seeding()).propose(flat().request(), run(1)).surveyed);
  const StopToken cancelled;
  cancelled.cancel();
  EXPECT_FALSE(GeneticMerger({}).propose(flat().request(), run(1, cancelled)).surveyed);
}

TEST(Genetic, RefusesOptionsOutOfRange) {
  GeneticOptions options;
  options.population = 1;
  EXPECT_THROW(GeneticMerger{options}, std::invalid_argument);
  options = {};
  options.seeding = "guessing";
  EXPECT_THROW(GeneticMerger{options}, std::invalid_argument);
  options = {};
  options.fit.tolerance_m = 0;
  EXPECT_THROW(GeneticMerger{options}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
