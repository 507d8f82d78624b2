/// What every registered method owes, in every profile. A new row in register_all.cpp is held to it without another
/// word here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "methods/register_all.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {

/// One profile of one method.
struct Subject {
  std::string method;
  std::string profile;

  [[nodiscard]] std::unique_ptr<MethodConfig> config() const {
    return all_methods().method(method).profile(profile).config();
  }
  [[nodiscard]] std::unique_ptr<Merger> make() const { return config()->make(); }
};

void PrintTo(const Subject& subject, std::ostream* out) { *out << subject.method << "_" << subject.profile; }

namespace {

using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;

std::vector<Subject> subjects() {
  std::vector<Subject> subjects;
  const MethodRegistry registry = all_methods();
  for (const MethodEntry& entry : registry.entries()) {
    for (const MethodProfile& profile : entry.profiles) {
      subjects.push_back({entry.name, profile.name});
    }
  }
  return subjects;
}

worlds::MapPair flat(double resolution_m) {
  worlds::SceneOptions options = known_pair("flat");
  options.resolution_m = resolution_m;
  return worlds::make_scene(options);
}

/// Two maps of one flat, prepared once for all.
struct Scene {
  worlds::MapPair pair = flat(0.08);
  PreparedMap target{pair.target, 0.08};
  PreparedMap source{pair.source, 0.08};
  Point2 centre = source.centre_in_map();

  [[nodiscard]] AlignRequest request(const std::optional<PosePrior>& prior) const {
    return {.target = target, .source = source, .prior = prior};
  }
};

const Scene& scene() {
  static const Scene scene;
  return scene;
}

/// A fence, off the truth by some 0.4 m and 5 degrees.
PosePrior fence_round(const Pose2& truth, Point2 centre) {
  const Point2 at = truth * centre;
  const Pose2 off = Pose2{at.x_m + 0.3, at.y_m - 0.25, 0} * Pose2{0, 0, radians(5)} * Pose2{-at.x_m, -at.y_m, 0};
  return {.target_from_source = off * truth, .radius_m = 1, .angle_rad = radians(15)};
}

RunContext run(std::uint64_t seed, int num_threads = 1, const StopToken& stop = {}, TraceSink* trace = nullptr) {
  return {.seed = seed, .num_threads = num_threads, .stop = stop, .trace = trace};
}

StopToken cancelled() {
  const StopToken token;
  token.cancel();
  return token;
}

bool is_finite(const Pose2& pose) {
  return std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad);
}

void expect_same(const Proposal& a, const Proposal& b) {
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].target_from_source, b.candidates[i].target_from_source);
    EXPECT_EQ(a.candidates[i].method_score, b.candidates[i].method_score);
  }
  EXPECT_EQ(a.carry.target_from_source, b.carry.target_from_source);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.stopped, b.stopped);
}

class MergerContract : public testing::TestWithParam<Subject> {
 protected:
  [[nodiscard]] std::unique_ptr<Merger> make() const { return GetParam().make(); }

  /// What is known beforehand: nothing, unless the profile is the published one or asks for it.
  [[nodiscard]] std::optional<PosePrior> prior(const Pose2& truth, Point2 centre) const {
    const bool wants_one = GetParam().profile == "paper" || make()->traits().needs_prior;
    return wants_one ? std::optional(fence_round(truth, centre)) : std::nullopt;
  }
  [[nodiscard]] AlignRequest request() const {
    return scene().request(prior(scene().pair.target_from_source, scene().centre));
  }
  /// The way through the pipeline, held against the truth at the source's centre.
  [[nodiscard]] Alignment expect_found(const OccupancyGrid& target, const OccupancyGrid& source,
                                       const Pose2& truth) const {
    const Point2 centre = centre_of_known(source);
    const std::unique_ptr<Merger> method = make();
    Alignment alignment =
        align({.target = target, .source = source, .prior = prior(truth, centre)}, *method, {}, run(1));
    EXPECT_EQ(alignment.outcome, Outcome::kMerged) << testing::PrintToString(alignment.reasons);
    EXPECT_THAT(alignment.hypotheses, Not(IsEmpty()));
    if (!alignment.hypotheses.empty()) {
      const PoseDifference error = difference_at(centre, alignment.hypotheses.front().target_from_source.pose, truth);
      EXPECT_LT(error.distance_m, 0.2);
      EXPECT_LT(degrees(error.angle_rad), 1);
    }
    return alignment;
  }
};

TEST_P(MergerContract, PutsAMapOnItself) {
  const OccupancyGrid& map = scene().pair.target;
  (void)expect_found(map, map, {});
}

TEST_P(MergerContract, FindsAKnownPose) {
  const worlds::MapPair& pair = scene().pair;
  (void)expect_found(pair.target, pair.source, pair.target_from_source);
}

TEST_P(MergerContract, GivesTheInverseForSwappedMaps) {
  const worlds::MapPair& pair = scene().pair;
  const Alignment forth = expect_found(pair.target, pair.source, pair.target_from_source);
  const Alignment back = expect_found(pair.source, pair.target, inverse(pair.target_from_source));
  ASSERT_FALSE(forth.hypotheses.empty() || back.hypotheses.empty());
  const PoseDifference apart = difference_at(scene().centre, forth.hypotheses.front().target_from_source.pose,
                                             inverse(back.hypotheses.front().target_from_source.pose));
  EXPECT_LT(apart.distance_m, 0.05);
  EXPECT_LT(degrees(apart.angle_rad), 0.3);
}

TEST_P(MergerContract, FindsAKnownPoseInMapsOfUnequalResolution) {
  const worlds::MapPair coarse = flat(0.1);
  const worlds::MapPair& fine = scene().pair;
  const Point2 centre = centre_of_known(coarse.source);
  const std::unique_ptr<Merger> method = make();
  const Alignment alignment =
      align({.target = fine.target, .source = coarse.source, .prior = prior(coarse.target_from_source, centre)},
            *method, {}, run(1));
  ASSERT_FALSE(alignment.hypotheses.empty());
  const PoseDifference error =
      difference_at(centre, alignment.hypotheses.front().target_from_source.pose, coarse.target_from_source);
  EXPECT_LT(error.distance_m, 0.2);
  EXPECT_LT(degrees(error.angle_rad), 1);
}

TEST_P(MergerContract, AnswersTheSameForTheSameSeed) {
  const std::unique_ptr<Merger> method = make();
  const Proposal once = method->propose(request(), run(7));
  expect_same(once, method->propose(request(), run(7)));
  expect_same(once, make()->propose(request(), run(7)));
  if (!method->traits().stochastic) {
    expect_same(once, method->propose(request(), run(8)));
  }
}

TEST_P(MergerContract, AnswersTheSameAtAnyNumberOfThreads) {
  const std::unique_ptr<Merger> method = make();
  const Proposal one = method->propose(request(), run(7, 1));
  expect_same(one, method->propose(request(), run(7, 4)));
  expect_same(one, method->propose(request(), run(7, 0)));
}

TEST_P(MergerContract, AnswersTheSameWhenCalledTwiceAtOnce) {
  const std::unique_ptr<Merger> method = make();
  const Proposal alone = method->propose(request(), run(7));
  Proposal beside;
  std::jthread other([&] { beside = method->propose(request(), run(7)); });
  const Proposal here = method->propose(request(), run(7));
  other.join();
  expect_same(alone, here);
  expect_same(alone, beside);
}

TEST_P(MergerContract, AnswersTheSameWhenWatched) {
  struct Watcher : TraceSink {
    int stages = 0;
    std::vector<IterationRecord> records;
    void on_stage(const std::string& name) override { stages += name.starts_with("propose") ? 1 : 0; }
    void on_iteration(const IterationRecord& record) override { records.push_back(record); }
  };
  const std::unique_ptr<Merger> method = make();
  Watcher watcher;
  const Proposal watched = method->propose(request(), run(7, 1, {}, &watcher));
  expect_same(watched, method->propose(request(), run(7)));
  EXPECT_GT(watcher.stages, 0);
  EXPECT_EQ(static_cast<int>(watcher.records.size()), watched.iterations);
  for (const IterationRecord& record : watcher.records) {
    EXPECT_TRUE(record.stage.starts_with("propose")) << record.stage;
    EXPECT_TRUE(std::isfinite(record.best_score) && std::isfinite(record.mean_score));
    EXPECT_GE(record.best_score, record.mean_score - 1e-9);
    EXPECT_TRUE(is_finite(record.best_target_from_source));
  }
}

TEST_P(MergerContract, StopsAtOnceWhenCancelledBeforehand) {
  const std::unique_ptr<Merger> method = make();
  const auto began = StopToken::Clock::now();
  const Proposal proposal = method->propose(request(), run(1, 1, cancelled()));
  EXPECT_TRUE(proposal.stopped);
  EXPECT_EQ(proposal.iterations, 0);
  EXPECT_LT(StopToken::Clock::now() - began, std::chrono::seconds(2));
}

TEST_P(MergerContract, AnswersWithItsBestSoFarAtItsDeadline) {
  const worlds::MapPair& pair = scene().pair;
  const std::unique_ptr<Merger> method = make();
  const AlignInput input{
      .target = pair.target, .source = pair.source, .prior = prior(pair.target_from_source, scene().centre)};
  const Alignment alignment = align(input, *method, {}, run(1, 1, StopToken::after(std::chrono::milliseconds(3))));
  EXPECT_TRUE(alignment.stopped);
  EXPECT_THAT(alignment.reasons, testing::Contains(testing::HasSubstr("stopped")));
  EXPECT_EQ(alignment.outcome == Outcome::kStopped, alignment.hypotheses.empty());
}

TEST_P(MergerContract, KeepsToItsBudgetOfIterations) {
  const std::unique_ptr<Merger> method = make();
  for (const int budget : {0, 1, 3}) {
    const Proposal proposal = method->propose(request(), run(1, 1, StopToken().with_iterations(budget)));
    EXPECT_LE(proposal.iterations, budget);
    if (method->traits().anytime) {
      EXPECT_THAT(proposal.candidates, Not(IsEmpty())) << budget;
    }
  }
}

TEST_P(MergerContract, GivesAReasonForMapsThatCannotBeAligned) {
  const OccupancyGrid& good = scene().pair.target;
  const OccupancyGrid empty = unknown_grid({.width = 0, .height = 0, .resolution_m = 0.05, .map_from_grid = {}});
  const OccupancyGrid unknown = text_map({"????", "????"}, 0.05);
  const OccupancyGrid free = text_map({"....", "...."}, 0.1);
  const std::unique_ptr<Merger> method = make();
  for (const OccupancyGrid* bad : {&empty, &unknown, &free}) {
    for (const auto& [target, source] : {std::pair{&good, bad}, {bad, &good}, {bad, bad}}) {
      const Alignment alignment =
          align({.target = *target, .source = *source, .prior = fence_round({}, {})}, *method, {}, run(1));
      EXPECT_EQ(alignment.outcome, Outcome::kDeclined);
      EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
    }
  }
}

TEST_P(MergerContract, NeverMergesASpeck) {
  const OccupancyGrid speck = text_map({"#"}, 0.05, {1, 2, 0.3});
  const OccupancyGrid specks = text_map({"#...#", "....."}, 0.1);
  const OccupancyGrid& good = scene().pair.target;
  const std::unique_ptr<Merger> method = make();
  for (const auto& [target, source] :
       {std::pair{&good, &speck}, {&speck, &good}, {&speck, &speck}, {&specks, &speck}, {&good, &specks}}) {
    const Alignment alignment = align(
        {.target = *target, .source = *source, .prior = prior({}, centre_of_known(*source))}, *method, {}, run(1));
    EXPECT_NE(alignment.outcome, Outcome::kMerged);
    EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
  }
}

TEST_P(MergerContract, ProposesNothingOutsideThePriorsFence) {
  const std::unique_ptr<Merger> method = make();
  if (!method->traits().uses_prior) {
    GTEST_SKIP() << "makes no use of a prior";
  }
  const Pose2& truth = scene().pair.target_from_source;
  const PosePrior near = fence_round(truth, scene().centre);
  PosePrior tight = near;
  tight.radius_m = 0.2;
  tight.angle_rad = radians(2);
  PosePrior elsewhere = fence_round(truth * Pose2{3, 1, radians(70)}, scene().centre);
  PosePrior place_only = near;
  place_only.angle_rad.reset();
  PosePrior heading_only = near;
  heading_only.radius_m.reset();
  for (const PosePrior& prior : {near, tight, elsewhere, place_only, heading_only}) {
    const Proposal proposal = method->propose(scene().request(prior), run(3));
    const auto outside =
        std::count_if(proposal.candidates.begin(), proposal.candidates.end(), [&](const Candidate& candidate) {
          const PoseDifference off =
              difference_at(scene().centre, candidate.target_from_source, prior.target_from_source);
          return off.distance_m > prior.radius_m.value_or(1e9) + 1e-6 ||
                 off.angle_rad > prior.angle_rad.value_or(kPi) + 1e-6;
        });
    EXPECT_EQ(outside, 0) << "of " << proposal.candidates.size() << ", radius " << prior.radius_m.value_or(0) << " m";
  }
}

TEST_P(MergerContract, RanksFiniteCandidatesBestFirst) {
  const std::unique_ptr<Merger> method = make();
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Proposal proposal = method->propose(request(), run(seed));
    ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
    for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
      const Candidate& candidate = proposal.candidates[i];
      EXPECT_TRUE(is_finite(candidate.target_from_source));
      EXPECT_TRUE(std::isfinite(candidate.method_score));
      EXPECT_LE(candidate.method_score, proposal.candidates[i == 0 ? 0 : i - 1].method_score);
      EXPECT_LE(std::abs(candidate.target_from_source.theta_rad), kPi);
    }
    EXPECT_TRUE(
        std::all_of(proposal.carry.target_from_source.begin(), proposal.carry.target_from_source.end(), is_finite));
  }
}

TEST_P(MergerContract, LeavesItsInputsUntouched) {
  const std::unique_ptr<Merger> method = make();
  const Population carried{{scene().pair.target_from_source, Pose2{1, 2, 3}}};
  const Population carried_before = carried;
  const PreparedMap target_before = scene().target;
  const PreparedMap source_before = scene().source;
  AlignRequest with_carried = request();
  with_carried.carried = method->traits().warm_start ? &carried : nullptr;
  (void)method->propose(with_carried, run(1, 2));
  EXPECT_EQ(carried.target_from_source, carried_before.target_from_source);
  for (const auto& [now, before] : {std::pair{&scene().target, &target_before}, {&scene().source, &source_before}}) {
    EXPECT_EQ(now->map_from_local(), before->map_from_local());
    EXPECT_EQ(now->occupancy(), before->occupancy());
    for (int k = 0; k < PreparedMap::kLevels; ++k) {
      EXPECT_EQ(now->level(k).state, before->level(k).state);
      EXPECT_EQ(now->level(k).wall_distance_m, before->level(k).wall_distance_m);
    }
  }
}

TEST_P(MergerContract, CarriesAPopulationOnlyWhereItTakesOneUp) {
  const std::unique_ptr<Merger> method = make();
  const Proposal proposal = method->propose(request(), run(1));
  EXPECT_EQ(!proposal.carry.target_from_source.empty(), method->traits().warm_start);
}

TEST_P(MergerContract, DescribesEveryOptionCompletely) {
  const std::unique_ptr<MethodConfig> config = GetParam().config();
  const OptionList list = config->options();
  EXPECT_THAT(list.problems(), IsEmpty());  // the defaults are in range
  std::set<std::string> keys;
  for (const OptionField& field : list.fields()) {
    EXPECT_THAT(field.key, MatchesRegex("[a-z][a-z0-9]*(_[a-z0-9]+)*"));
    EXPECT_TRUE(keys.insert(field.key).second) << field.key << " is described twice";
    EXPECT_GT(field.text.meaning.size(), 10U) << field.key;
    EXPECT_TRUE(field.text.meaning.ends_with(".")) << field.key << ": " << field.text.meaning;
    EXPECT_TRUE(field.text.advice.empty() || field.text.advice.ends_with(".")) << field.key;
    EXPECT_THAT(field.range_text(), Not(IsEmpty())) << field.key;
    if (std::holds_alternative<std::string*>(field.value)) {
      EXPECT_GT(field.choices.size(), 1U) << field.key;
    } else if (!std::holds_alternative<bool*>(field.value)) {
      EXPECT_LT(field.low, field.high) << field.key;
    }
    // A length, an angle says so in its name and in its unit.
    for (const auto& [suffix, unit] : {std::pair{"_m", "m"}, {"_deg", "deg"}, {"_cells", "cells"}, {"_percent", "%"}}) {
      EXPECT_EQ(field.key.ends_with(suffix), field.text.unit == unit) << field.key << " [" << field.text.unit << "]";
    }
  }
}

TEST_P(MergerContract, TakesItsOwnValuesBackAndRefusesOthers) {
  const std::unique_ptr<MethodConfig> config = GetParam().config();
  OptionList list = config->options();
  for (const auto& [key, value] : list.values()) {
    EXPECT_EQ(list.set(key, value), "") << key;
  }
  EXPECT_NE(list.set("no_such_option", "1"), "");
  for (const OptionField& field : list.fields()) {
    if (double* const* value = std::get_if<double*>(&field.value); value != nullptr && std::isfinite(field.high)) {
      const double before = **value;
      **value = field.high + 1;
      EXPECT_THROW((void)config->make(), std::invalid_argument) << field.key;
      **value = before;
    } else if (int* const* count = std::get_if<int*>(&field.value); count != nullptr) {
      const int before = **count;
      **count = static_cast<int>(field.low) - 1;
      EXPECT_THROW((void)config->make(), std::invalid_argument) << field.key;
      **count = before;
    }
  }
  EXPECT_NO_THROW((void)config->make());
}

std::string subject_name(const testing::TestParamInfo<Subject>& info) { return testing::PrintToString(info.param); }

INSTANTIATE_TEST_SUITE_P(Registry, MergerContract, testing::ValuesIn(subjects()), subject_name);

TEST(AllMethods, TellWhoTheyAre) {
  const MethodRegistry registry = all_methods();
  ASSERT_FALSE(registry.entries().empty());
  EXPECT_EQ(registry.entries().front().name, "genetic");  // the default method
  for (const MethodEntry& entry : registry.entries()) {
    EXPECT_THAT(entry.name, MatchesRegex("[a-z][a-z0-9]*(_[a-z0-9]+)*"));
    EXPECT_THAT(entry.summary, Not(IsEmpty())) << entry.name;
    EXPECT_THAT(entry.paper, testing::ContainsRegex("(19|20)[0-9][0-9]")) << entry.name;
    ASSERT_FALSE(entry.profiles.empty());
    EXPECT_EQ(entry.profiles.front().name, "default") << entry.name;
    for (const MethodProfile& profile : entry.profiles) {
      EXPECT_THAT(profile.summary, Not(IsEmpty())) << entry.name << "/" << profile.name;
    }
  }
}

}  // namespace
}  // namespace gridmerge
