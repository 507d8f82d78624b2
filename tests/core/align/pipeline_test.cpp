#include "gridmerge/align/pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/align/drawn_place.hpp"
#include "gridmerge/base/random.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Proposes what the test tells it to, and claims to have overlooked nothing.
class Told final : public Merger {
 public:
  explicit Told(std::vector<Pose2> poses) {
    says.surveyed = true;
    for (const Pose2& pose : poses) {
      says.candidates.push_back({pose, static_cast<double>(says.candidates.size())});
    }
  }
  [[nodiscard]] MergerTraits traits() const override { return {}; }
  [[nodiscard]] std::optional<std::string> objection(const AlignRequest& /*request*/) const override { return objects; }
  [[nodiscard]] Proposal propose(const AlignRequest& request, const RunContext& context) const override {
    EXPECT_FALSE(request.target.walls().empty());
    EXPECT_FALSE(request.source.walls().empty());
    EXPECT_EQ(request.target.resolution_m(), request.source.resolution_m());
    if (context.stop.stop_requested()) {
      return {.candidates = {}, .carry = {}, .iterations = 0, .stopped = true, .surveyed = false};
    }
    return says;
  }

  Proposal says;
  std::optional<std::string> objects;
};

/// Two overlapping views of the flat, as grids.
struct FlatGrids {
  PlacedView target_view{.place_from_map = {0.3, -0.4, 0.2}, .to_x_m = 9};
  PlacedView source_view{.place_from_map = {2, 5, -1.1}, .origin_yaw_rad = 0.5, .from_x_m = 3};
  OccupancyGrid target = drawn(Place::kFlat, target_view);
  OccupancyGrid source = drawn(Place::kFlat, source_view);
  Pose2 truth = target_from_source(target_view, source_view);

  [[nodiscard]] AlignInput input() const { return {.target = target, .source = source, .prior = {}}; }
  [[nodiscard]] PoseDifference error(const Pose2& pose) const {
    return difference_at(centre_of_known(source), pose, truth);
  }
  /// The truth, a little off, among poses at random.
  [[nodiscard]] std::vector<Pose2> proposals(int wrong = 12) const {
    std::vector<Pose2> poses;
    RandomStream random(1, "wrong poses");
    for (int i = 0; i < wrong; ++i) {
      poses.push_back({random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(-kPi, kPi)});
      if (i == wrong / 2) {
        poses.push_back(truth * Pose2{0.06, -0.05, radians(0.8)});
      }
    }
    return poses;
  }
};

void expect_finite(const Alignment& alignment) {
  EXPECT_TRUE(std::isfinite(alignment.confidence));
  EXPECT_TRUE(std::isfinite(alignment.verdict.lead) && std::isfinite(alignment.verdict.lead_m));
  EXPECT_TRUE(std::isfinite(alignment.verdict.deviations));
  EXPECT_TRUE(std::isfinite(alignment.random_level.mean_m) && std::isfinite(alignment.random_level.deviation_m));
  for (const Hypothesis& one : alignment.hypotheses) {
    const Pose2& pose = one.target_from_source.pose;
    EXPECT_TRUE(std::isfinite(pose.x_m) && std::isfinite(pose.y_m) && std::isfinite(pose.theta_rad));
    EXPECT_TRUE(!one.target_from_source.covariance || one.target_from_source.covariance->allFinite());
    for (const auto& [name, value] : one.figures.named()) {
      EXPECT_TRUE(std::isfinite(value)) << name;
    }
  }
}

void expect_same(const Alignment& a, const Alignment& b) {
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.reasons, b.reasons);
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].target_from_source.pose, b.hypotheses[i].target_from_source.pose);
    EXPECT_EQ(a.hypotheses[i].target_from_source.covariance, b.hypotheses[i].target_from_source.covariance);
    EXPECT_EQ(a.hypotheses[i].figures.named(), b.hypotheses[i].figures.named());
  }
}

TEST(Pipeline, FindsTheRightOneOfTheProposedPoses) {
  const FlatGrids flat;
  const Told method(flat.proposals());
  const Alignment alignment = align(flat.input(), method, {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kMerged);
  EXPECT_GT(alignment.confidence, 0.9);
  EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
  ASSERT_FALSE(alignment.hypotheses.empty());
  const Hypothesis& best = alignment.hypotheses.front();
  EXPECT_LT(flat.error(best.target_from_source.pose).distance_m, 0.015);
  EXPECT_LT(degrees(flat.error(best.target_from_source.pose).angle_rad), 0.1);
  EXPECT_TRUE(best.target_from_source.covariance);
  EXPECT_EQ(best.method_score, 7);  // it is the seventh pose that was proposed
  EXPECT_GT(best.figures.overlap_area_m2, 30);
  EXPECT_GT(best.figures.acceptance_index, 0.95);
  EXPECT_FALSE(alignment.stopped);
  expect_finite(alignment);
}

TEST(Pipeline, LeavesPosesAsProposedWhereRefineIsOff) {
  const FlatGrids flat;
  const std::vector<Pose2> proposed = flat.proposals();
  PipelineOptions options;
  options.refine = false;
  options.hypotheses = 100;
  const Alignment alignment = align(flat.input(), Told(proposed), options, {});
  ASSERT_FALSE(alignment.hypotheses.empty());
  for (const Hypothesis& one : alignment.hypotheses) {
    if (one.proposed) {
      EXPECT_THAT(proposed, testing::Contains(one.target_from_source.pose));
    }
  }
  EXPECT_TRUE(alignment.hypotheses.front().target_from_source.covariance) << "the verdict weighs it";
  EXPECT_EQ(alignment.hypotheses.front().target_from_source.pose, proposed[7]);
}

TEST(Pipeline, GivesTheInverseWhenTheMapsAreSwapped) {
  const FlatGrids flat;
  std::vector<Pose2> inverted;
  for (const Pose2& pose : flat.proposals()) {
    inverted.push_back(inverse(pose));
  }
  const Alignment forth = align(flat.input(), Told(flat.proposals()), {}, {});
  const Alignment back = align({.target = flat.source, .source = flat.target, .prior = {}}, Told(inverted), {}, {});
  EXPECT_EQ(back.outcome, forth.outcome);
  EXPECT_NEAR(back.confidence, forth.confidence, 0.05);
  const PoseDifference apart =
      difference_at(centre_of_known(flat.source), forth.hypotheses.front().target_from_source.pose,
                    inverse(back.hypotheses.front().target_from_source.pose));
  EXPECT_LT(apart.distance_m, 0.01);
  EXPECT_LT(degrees(apart.angle_rad), 0.1);
}

TEST(Pipeline, AlignsMapsOfUnequalResolution) {
  FlatGrids flat;
  for (const auto& [target_m, source_m] : {std::pair{0.05, 0.1}, {0.1, 0.04}, {0.03, 0.05}}) {
    flat.target_view.resolution_m = target_m;
    flat.source_view.resolution_m = source_m;
    flat.target = drawn(Place::kFlat, flat.target_view);
    flat.source = drawn(Place::kFlat, flat.source_view);
    const Alignment alignment = align(flat.input(), Told(flat.proposals()), {}, {});
    EXPECT_EQ(alignment.outcome, Outcome::kMerged) << target_m << ", " << source_m;
    ASSERT_FALSE(alignment.hypotheses.empty());
    const PoseDifference error = flat.error(alignment.hypotheses.front().target_from_source.pose);
    EXPECT_LT(error.distance_m, 0.05) << target_m << ", " << source_m;
    EXPECT_LT(degrees(error.angle_rad), 0.4) << target_m << ", " << source_m;
  }
}

TEST(Pipeline, DeclinesMapsWithoutAnythingToGoBy) {
  const OccupancyGrid good = drawn(Place::kFlat, {});
  const OccupancyGrid empty = unknown_grid({.width = 0, .height = 0, .resolution_m = 0.05, .map_from_grid = {}});
  const OccupancyGrid unknown = text_map({"???", "???"}, 0.05);
  const OccupancyGrid undecided = text_map({"444", "555"}, 0.05);
  const OccupancyGrid free = text_map({"...", "..?"}, 0.05);
  const OccupancyGrid one_free_cell = text_map({"."}, 0.05);
  const Told method({Pose2{}});
  for (const auto& [bad, why] : {std::pair{&empty, "empty or all unknown"},
                                 {&unknown, "empty or all unknown"},
                                 {&undecided, "empty or all unknown"},
                                 {&free, "no occupied cell"},
                                 {&one_free_cell, "no occupied cell"}}) {
    for (const bool bad_target : {true, false}) {
      const Alignment alignment =
          align({.target = bad_target ? *bad : good, .source = bad_target ? good : *bad, .prior = {}}, method, {}, {});
      EXPECT_EQ(alignment.outcome, Outcome::kDeclined);
      EXPECT_THAT(alignment.reasons, ElementsAre(AllOf(HasSubstr(why), HasSubstr(bad_target ? "target" : "source"))));
      EXPECT_THAT(alignment.hypotheses, IsEmpty());
      EXPECT_EQ(alignment.confidence, 0);
      expect_finite(alignment);
    }
    EXPECT_EQ(align({.target = *bad, .source = *bad, .prior = {}}, method, {}, {}).outcome, Outcome::kDeclined);
  }
}

TEST(Pipeline, DoesNotMergeASingleWallCell) {
  const OccupancyGrid good = drawn(Place::kFlat, {});
  const OccupancyGrid post = text_map({"#"}, 0.05);
  for (const auto& [target, source] : {std::pair{&good, &post}, {&post, &good}, {&post, &post}}) {
    const Alignment alignment =
        align({.target = *target, .source = *source, .prior = {}}, Told({{0.05, 0.05, 0}, {3, 2, 1}}), {}, {});
    EXPECT_NE(alignment.outcome, Outcome::kMerged);
    EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
    expect_finite(alignment);
  }
}

TEST(Pipeline, DeclinesForTheReasonTheMethodObjectsWith) {
  const FlatGrids flat;
  Told method(flat.proposals());
  method.objects = "these walls are not straight enough";
  const Alignment alignment = align(flat.input(), method, {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kDeclined);
  EXPECT_THAT(alignment.reasons, ElementsAre("these walls are not straight enough"));
}

TEST(Pipeline, FindsNoOverlapWhereTheMethodFindsNothing) {
  const FlatGrids flat;
  const Alignment alignment = align(flat.input(), Told({}), {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kNoOverlap);
  EXPECT_THAT(alignment.reasons, Not(IsEmpty()));
  EXPECT_THAT(alignment.hypotheses, IsEmpty());
  EXPECT_EQ(alignment.confidence, 0);
}

TEST(Pipeline, DoesNotMergeWhatOnlyChanceProposed) {
  const FlatGrids flat;
  std::vector<Pose2> poses = flat.proposals();
  poses.erase(poses.begin() + 7);
  const Alignment alignment = align(flat.input(), Told(poses), {}, {});
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  expect_finite(alignment);
}

TEST(Pipeline, SaysSoWhenItIsStoppedBeforeAnythingWasFound) {
  const FlatGrids flat;
  const StopToken cancelled;
  cancelled.cancel();
  const Alignment alignment = align(flat.input(), Told(flat.proposals()), {}, {.stop = cancelled});
  EXPECT_EQ(alignment.outcome, Outcome::kStopped);
  EXPECT_TRUE(alignment.stopped);
  EXPECT_THAT(alignment.reasons, testing::Contains(HasSubstr("stopped")));
}

TEST(Pipeline, JudgesTheBestSoFarWhenItWasStopped) {
  const FlatGrids flat;
  Told method(flat.proposals());
  method.says.stopped = true;
  const Alignment alignment = align(flat.input(), method, {}, {});
  EXPECT_TRUE(alignment.stopped);
  EXPECT_EQ(alignment.outcome, Outcome::kMerged);
  EXPECT_THAT(alignment.reasons, testing::Contains(HasSubstr("stopped early")));
}

TEST(Pipeline, ListsDistinctHypothesesBestFirst) {
  const FlatGrids flat;
  std::vector<Pose2> poses = flat.proposals(40);
  for (int i = 0; i < 10; ++i) {  // the same answer ten times over
    poses.push_back(flat.truth * Pose2{0.01 * i, -0.02 * i, 0.002 * i});
  }
  PipelineOptions options;
  options.hypotheses = 6;
  const Alignment alignment = align(flat.input(), Told(poses), options, {});
  EXPECT_EQ(alignment.hypotheses.size(), 6U);
  const Point2 centre = centre_of_known(flat.source);
  for (std::size_t i = 0; i < alignment.hypotheses.size(); ++i) {
    const Hypothesis& one = alignment.hypotheses[i];
    EXPECT_LE(one.figures.evidence_m, alignment.hypotheses[i == 0 ? 0 : i - 1].figures.evidence_m);
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(centre, one.target_from_source.pose, alignment.hypotheses[k].target_from_source.pose);
      EXPECT_TRUE(apart.distance_m >= options.verdict.distinct_m ||
                  apart.angle_rad >= radians(options.verdict.distinct_deg))
          << i << " and " << k;
    }
  }
  EXPECT_GT(alignment.verdict.lead, 0.5);
}

TEST(Pipeline, PutsFirstWhatIsFarMorePlausibleAsRivalsAreWeighed) {
  const FlatGrids flat;
  const Pose2 turned_round =
      inverse(flat.target_view.place_from_map) * Pose2{12, 8, kPi} * flat.source_view.place_from_map;
  PipelineOptions options;
  options.refined_candidates = 1;         // the one that comes first by its support
  options.evaluator.conflict_weight = 0;  // so that the other one has evidence, too
  const Alignment by_support = align(flat.input(), Told({flat.truth, turned_round}), options, {});
  ASSERT_EQ(by_support.hypotheses.size(), 2U);
  EXPECT_LT(flat.error(by_support.hypotheses[0].target_from_source.pose).distance_m, 0.1);
  EXPECT_FALSE(by_support.hypotheses[1].target_from_source.covariance);
  // As if conflict made a pose plausible.
  options.verdict.weights.per_rival = {.log_conflict = 3, .elastic_gain = 0, .log_overlap_share = 0};
  const Alignment put_first = align(flat.input(), Told({flat.truth, turned_round}), options, {});
  ASSERT_EQ(put_first.hypotheses.size(), 2U);
  const Hypothesis& first = put_first.hypotheses[0];
  EXPECT_GT(flat.error(first.target_from_source.pose).distance_m, 0.5);
  EXPECT_TRUE(first.target_from_source.covariance);
  EXPECT_GT(first.figures.psi_cells, 0);  // all figures
  EXPECT_LT(flat.error(put_first.hypotheses[1].target_from_source.pose).distance_m, 0.1);
  EXPECT_NE(put_first.outcome, Outcome::kMerged);
}

TEST(Pipeline, WeighsTheRivalEvenWhereOnlyOneHypothesisIsListed) {
  // Half a corridor, seen twice: to slide it or to turn it round changes nothing.
  const OccupancyGrid corridor = drawn(Place::kCorridor, {.place_from_map = {}, .from_x_m = 0, .to_x_m = 30});
  PipelineOptions options;
  options.hypotheses = 1;
  const Point2 centre = centre_of_known(corridor);
  const Pose2 turned{2 * centre.x_m, 2 * centre.y_m, kPi};
  const Alignment alignment =
      align({.target = corridor, .source = corridor, .prior = {}}, Told({Pose2{}, turned}), options, {});
  EXPECT_EQ(alignment.hypotheses.size(), 1U);
  EXPECT_LT(alignment.verdict.lead, 0.05);
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous);
}

TEST(Pipeline, SeeksTheRivalsThatAMethodHasNotLookedFor) {
  // One pose alone is proposed, and it is right; but turned round, the corridor fits as well.
  const OccupancyGrid corridor = drawn(Place::kCorridor, {.place_from_map = {}, .from_x_m = 0, .to_x_m = 20});
  const AlignInput input{.target = corridor, .source = corridor, .prior = {}};
  Told method({Pose2{}});
  EXPECT_EQ(align(input, method, {}, {}).hypotheses.size(), 1U);
  method.says.surveyed = false;
  const Alignment alignment = align(input, method, {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous);
  EXPECT_GE(alignment.hypotheses.size(), 2U);
  EXPECT_TRUE(alignment.hypotheses.front().proposed);
  EXPECT_FALSE(alignment.hypotheses.back().proposed);
}

TEST(Pipeline, MergesAMethodsOnlyPoseWhereNoRivalIsFound) {
  const FlatGrids flat;
  Told method({flat.truth * Pose2{0.06, -0.05, radians(0.8)}});
  method.says.surveyed = false;
  const Alignment alignment = align(flat.input(), method, {}, {.num_threads = 2});
  EXPECT_EQ(alignment.outcome, Outcome::kMerged);
  EXPECT_LT(flat.error(alignment.hypotheses.front().target_from_source.pose).distance_m, 0.015);
  EXPECT_LT(alignment.verdict.lead, 1);  // somebody was found to lead over
}

TEST(Pipeline, DoesNotTakeARivalForTheMethodsAnswer) {
  // What a method did not propose is not its answer, however well it fits.
  const FlatGrids flat;
  Told method({flat.truth * Pose2{3, 1, radians(70)}});
  method.says.surveyed = false;
  const Alignment alignment = align(flat.input(), method, {}, {});
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
  EXPECT_TRUE(alignment.hypotheses.front().proposed);
  EXPECT_GT(flat.error(alignment.hypotheses.front().target_from_source.pose).distance_m, 0.5);
}

TEST(Pipeline, DoesNotMergeWhereTheSearchForRivalsWasCutShort) {
  /// Proposes, and then has no time left.
  class Late final : public Merger {
   public:
    explicit Late(const Pose2& pose) : pose_(pose) {}
    [[nodiscard]] MergerTraits traits() const override { return {}; }
    [[nodiscard]] Proposal propose(const AlignRequest& /*request*/, const RunContext& context) const override {
      context.stop.cancel();
      return {.candidates = {{pose_, 1}}, .carry = {}, .iterations = 1, .stopped = true, .surveyed = false};
    }

   private:
    Pose2 pose_;
  };
  const FlatGrids flat;
  const Alignment alignment = align(flat.input(), Late(flat.truth), {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous);
  EXPECT_TRUE(alignment.stopped);
  EXPECT_THAT(alignment.reasons, testing::Contains(HasSubstr("overlooked")));
}

TEST(Pipeline, DoesNotMergeWhereItsTimeIsUpBeforeAllRivalsAreFound) {
  const FlatGrids flat;
  const PreparedMap target(flat.target, 0.05);
  const PreparedMap source(flat.source, 0.05);
  Told method({flat.truth});
  method.says.surveyed = false;
  const Alignment alignment = align_prepared({.target = target, .source = source, .prior = {}}, method, {},
                                             {.stop = StopToken::after(std::chrono::milliseconds(1))});
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
}

TEST(Pipeline, RefinesNoPoseOutOfThePriorsFence) {
  const FlatGrids flat;
  const Pose2 beside = flat.truth * Pose2{0.1, 0.05, radians(1)};
  AlignInput input = flat.input();
  input.prior = PosePrior{.target_from_source = beside, .radius_m = 0.02, .angle_rad = radians(0.2)};
  const Alignment alignment = align(input, Told({beside}), {}, {});
  ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
  const PoseDifference off =
      difference_at(centre_of_known(flat.source), alignment.hypotheses.front().target_from_source.pose, beside);
  EXPECT_LE(off.distance_m, 0.02 + 1e-6);
  EXPECT_LE(degrees(off.angle_rad), 0.2 + 1e-6);
}

TEST(Pipeline, TimesEveryStep) {
  const FlatGrids flat;
  const StepSeconds seconds = align(flat.input(), Told(flat.proposals()), {}, {}).seconds;
  for (const double step : {seconds.prepare, seconds.propose, seconds.refine, seconds.judge}) {
    EXPECT_GT(step, 0);
  }
  const double sum = seconds.prepare + seconds.propose + seconds.refine + seconds.judge;
  EXPECT_LE(sum, seconds.align + 1e-6);
  EXPECT_GT(sum, 0.5 * seconds.align);
}

TEST(Pipeline, LeavesItsInputUntouched) {
  const FlatGrids flat;
  const OccupancyGrid target = flat.target;
  const OccupancyGrid source = flat.source;
  const Population carried{{{1, 2, 3}}};
  AlignInput input = flat.input();
  input.carried = &carried;
  input.prior = PosePrior{flat.truth, 1, 0.5};
  (void)align(input, Told(flat.proposals()), {}, {});
  EXPECT_EQ(flat.target, target);
  EXPECT_EQ(flat.source, source);
  EXPECT_THAT(carried.target_from_source, ElementsAre(Pose2{1, 2, 3}));
}

TEST(Pipeline, HandsOnWhatTheMethodCarries) {
  const FlatGrids flat;
  Told method(flat.proposals());
  method.says.carry.target_from_source = {{4, 5, 0.6}};
  method.says.iterations = 17;
  const Alignment alignment = align(flat.input(), method, {}, {});
  EXPECT_THAT(alignment.carry.target_from_source, ElementsAre(Pose2{4, 5, 0.6}));
  EXPECT_EQ(alignment.iterations, 17);
}

TEST(Pipeline, IsTheSameAtAnyNumberOfThreads) {
  const FlatGrids flat;
  const Told method(flat.proposals(40));
  const Alignment one = align(flat.input(), method, {}, {.seed = 3, .num_threads = 1});
  for (const int threads : {0, 2, 4}) {
    SCOPED_TRACE(threads);
    expect_same(one, align(flat.input(), method, {}, {.seed = 3, .num_threads = threads}));
  }
}

TEST(Pipeline, AnswersTheSameForMapsThatAreAlreadyPrepared) {
  const FlatGrids flat;
  const Told method(flat.proposals());
  const PreparedMap target(flat.target, 0.05);
  const PreparedMap source(flat.source, 0.05);
  expect_same(align(flat.input(), method, {}, {}),
              align_prepared({.target = target, .source = source, .prior = {}}, method, {}, {}));
}

TEST(Pipeline, TellsTheWatcherItsStages) {
  struct Watcher : TraceSink {
    std::vector<std::string> stages;
    void on_stage(const std::string& name) override { stages.push_back(name); }
  };
  const FlatGrids flat;
  const Told method(flat.proposals());
  Watcher watcher;
  const Alignment watched = align(flat.input(), method, {}, {.trace = &watcher});
  EXPECT_THAT(watcher.stages, ElementsAre("prepare", "refine", "judge"));
  expect_same(watched, align(flat.input(), method, {}, {}));
}

TEST(Pipeline, FindsTheTruthHoweverFarOffTheOriginsLie) {
  FlatGrids flat;
  const Pose2 move_target{1e6, -2e6, 0.4};
  const Pose2 move_source{-3e6, 1e6, -1};
  std::vector<Pose2> poses;
  for (const Pose2& pose : flat.proposals()) {
    poses.push_back(move_target * pose * inverse(move_source));
  }
  flat.truth = move_target * flat.truth * inverse(move_source);
  flat.target.geometry.map_from_grid = move_target * flat.target.geometry.map_from_grid;
  flat.source.geometry.map_from_grid = move_source * flat.source.geometry.map_from_grid;
  const Alignment alignment = align(flat.input(), Told(poses), {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kMerged);
  EXPECT_LT(flat.error(alignment.hypotheses.front().target_from_source.pose).distance_m, 0.015);
  expect_finite(alignment);
}

TEST(Pipeline, StaysFiniteWhateverIsProposed) {
  const FlatGrids flat;
  for (const Pose2& pose : {Pose2{1e5, 0, 0}, Pose2{-1e12, 1e12, 2}, Pose2{0, 1e30, 0}, Pose2{0, 0, 1e6}}) {
    for (const bool refine : {true, false}) {
      PipelineOptions options;
      options.refine = refine;
      const Alignment alignment = align(flat.input(), Told({pose}), options, {});
      EXPECT_NE(alignment.outcome, Outcome::kMerged);
      expect_finite(alignment);
    }
  }
}

TEST(Pipeline, RefusesGridsAndOptionsThatBreakTheirRules) {
  const FlatGrids flat;
  const Told method(flat.proposals());
  OccupancyGrid broken = flat.source;
  broken.cells.pop_back();
  EXPECT_THROW((void)align({.target = flat.target, .source = broken, .prior = {}}, method, {}, {}),
               std::invalid_argument);
  broken = flat.source;
  broken.geometry.resolution_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)align({.target = broken, .source = flat.source, .prior = {}}, method, {}, {}),
               std::invalid_argument);
  const auto refused = [&](auto&& change) {
    PipelineOptions options;
    change(options);
    EXPECT_THROW((void)align(flat.input(), method, options, {}), std::invalid_argument);
  };
  refused([](PipelineOptions& o) { o.hypotheses = 0; });
  refused([](PipelineOptions& o) { o.refined_candidates = 0; });
  refused([](PipelineOptions& o) { o.prepare.free_percent = 90; });
  refused([](PipelineOptions& o) { o.prepare.finest_resolution_m = -1; });
  refused([](PipelineOptions& o) { o.refinement.reach_m = std::numeric_limits<double>::quiet_NaN(); });
  refused([](PipelineOptions& o) { o.evaluator.tolerance_m = 0; });
  refused([](PipelineOptions& o) { o.verdict.min_confidence = 2; });
}

/// Laid over each other as far as they go, half a turn off, its two ends agree in more than where they meet.
TEST(Align, LeavesTheTwoEndsOfASymmetricHallApart) {
  const worlds::MapPair hall = worlds::make_scene({.kind = "hall"});
  const Pose2 half_a_turn_off = {-10, 0, radians(-70)};
  const Pose2 a_column_off = {2, 7, radians(110)};  // stronger than the truth, with a little conflict
  const Alignment alignment = align({.target = hall.target, .source = hall.source, .prior = {}},
                                    Told({hall.target_from_source, half_a_turn_off, a_column_off}), {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous);
  EXPECT_THAT(alignment.reasons, testing::Contains(HasSubstr("another pose fits without conflict")));
  EXPECT_LT(difference_at({0, 0}, alignment.hypotheses.front().target_from_source.pose, half_a_turn_off).distance_m,
            0.1);
}

}  // namespace
}  // namespace gridmerge
