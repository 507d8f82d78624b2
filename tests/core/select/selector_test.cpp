#include "gridmerge/select/selector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "gridmerge/align/pipeline.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// Proposes what the test tells it to.
class Toy final : public Merger {
 public:
  [[nodiscard]] MergerTraits traits() const override { return {}; }
  [[nodiscard]] std::optional<std::string> objection(const AlignRequest& /*request*/) const override { return objects; }
  [[nodiscard]] std::optional<Bid> bid(const AlignRequest& /*request*/) const override { return bids; }
  [[nodiscard]] Proposal propose(const AlignRequest& /*request*/, const RunContext& /*context*/) const override {
    Proposal proposal;
    proposal.surveyed = true;
    for (const Pose2& pose : poses) {
      proposal.candidates.push_back({pose, 1});
    }
    return proposal;
  }

  std::vector<Pose2> poses;
  std::optional<std::string> objects;
  std::optional<Bid> bids;
};

BidModel model(const std::string& method, double log_odds, double log_seconds) {
  return {.method = method, .success = {{{"bias", log_odds}}}, .log_seconds = {{{"bias", log_seconds}}}};
}

/// Two maps of a flat, three toys: fast and good, slow and good, fast and bad.
class SelectorTest : public testing::Test {
 protected:
  [[nodiscard]] AlignRequest request() const { return {.target = target_, .source = source_, .prior = {}}; }
  [[nodiscard]] Selector selector(double second_chance = 3, SelectorOptions options = {}) const {
    return {{{"slow", &slow_}, {"fast", &fast_}, {"bad", &bad_}},
            {.methods = {model("slow", 3.0, 0), model("fast", 2.9, -2), model("bad", -1, -4)},
             .second_chance = {{{"bias", second_chance}}}},
            options};
  }
  [[nodiscard]] std::vector<std::string> order(const Selector& selector) const {
    std::vector<std::string> names;
    for (const Standing& one : selector.standings(request(), BidInputs({}, {}, {}))) {
      names.push_back(one.method);
    }
    return names;
  }
  [[nodiscard]] static std::vector<std::string> tried(const Alignment& alignment) {
    std::vector<std::string> names;
    for (const Attempt& one : alignment.attempts) {
      names.push_back(one.method);
    }
    return names;
  }
  [[nodiscard]] Alignment run(const Selector& selector, const RunContext& context = {}) const {
    return align_prepared(request(), selector, {}, context);
  }

  worlds::MapPair pair_ = worlds::make_scene(known_pair("flat"));
  PreparedMap target_{pair_.target, 0.05};
  PreparedMap source_{pair_.source, 0.05};
  Pose2 truth_ = pair_.target_from_source;
  Pose2 nowhere_ = pair_.target_from_source * Pose2{3, 2, 1};
  Toy slow_;
  Toy fast_;
  Toy bad_;
};

TEST_F(SelectorTest, OfThoseAboutAsSuccessfulTheFastestComesFirst) {
  EXPECT_THAT(order(selector()), ElementsAre("fast", "slow", "bad"));
  EXPECT_THAT(order(selector(3, {.success_slack = 0})), ElementsAre("slow", "fast", "bad"));
  EXPECT_THAT(order(selector(3, {.success_slack = 1})), ElementsAre("bad", "fast", "slow"));
}

TEST_F(SelectorTest, WhatAMethodBidsItselfCountsMoreThanWhatWasLearned) {
  bad_.bids = Bid{.success = 0.99, .seconds = 1e-3};
  EXPECT_EQ(order(selector()).front(), "bad");
}

TEST_F(SelectorTest, RunsTheBestBidAndStopsWhenMerged) {
  fast_.poses = {truth_};
  const Alignment alignment = run(selector());
  EXPECT_EQ(alignment.outcome, Outcome::kMerged) << testing::PrintToString(alignment.reasons);
  EXPECT_THAT(tried(alignment), ElementsAre("fast"));
  EXPECT_THAT(alignment.story, Contains(HasSubstr("fast runs")));
  EXPECT_THAT(alignment.story, Contains(HasSubstr("bad bids")));
}

TEST_F(SelectorTest, TriesTheNextWhereTheFirstDidNotMerge) {
  fast_.poses = {nowhere_};
  slow_.poses = {truth_};
  const Alignment alignment = run(selector());
  EXPECT_THAT(tried(alignment), ElementsAre("fast", "slow"));
  EXPECT_EQ(alignment.outcome, Outcome::kMerged) << testing::PrintToString(alignment.reasons);
  EXPECT_NE(alignment.attempts.front().outcome, Outcome::kMerged);
  EXPECT_THAT(alignment.story, Contains(HasSubstr("slow runs: after fast")));
}

TEST_F(SelectorTest, LeavesItWhereAnotherMethodHasHardlyAChance) {
  fast_.poses = {nowhere_};
  slow_.poses = {truth_};
  const Alignment alignment = run(selector(-9));
  EXPECT_THAT(tried(alignment), ElementsAre("fast"));
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  EXPECT_THAT(alignment.story, Contains(HasSubstr("no other runs after fast")));
}

TEST_F(SelectorTest, TriesNoMoreThanItMay) {
  const Alignment alignment = run(selector(3, {.at_most = 2}));
  EXPECT_THAT(tried(alignment), ElementsAre("fast", "slow"));
}

TEST_F(SelectorTest, AnObjectionAndAMissingBidKeepAMethodOut) {
  fast_.objects = "the maps are not to its liking";
  const Selector without({{"fast", &fast_}, {"bad", &bad_}, {"new", &slow_}},
                         {.methods = {model("fast", 3, -2), model("bad", -1, -4)}, .second_chance = {{{"bias", 3}}}},
                         {});
  const Alignment alignment = run(without);
  EXPECT_THAT(tried(alignment), ElementsAre("bad"));
  EXPECT_THAT(alignment.story, Contains("fast objects: the maps are not to its liking"));
  EXPECT_THAT(alignment.story, Contains(HasSubstr("new makes no bid")));
}

TEST_F(SelectorTest, SaysSoWhereNobodyBids) {
  const Selector empty({{"new", &slow_}}, {}, {});
  const Alignment alignment = run(empty);
  EXPECT_EQ(alignment.outcome, Outcome::kDeclined);
  EXPECT_THAT(alignment.attempts, testing::IsEmpty());
  EXPECT_THAT(alignment.story, Contains(HasSubstr("no method bids")));
  EXPECT_THAT(alignment.reasons, Contains(HasSubstr("no method")));
}

TEST_F(SelectorTest, TakesTheBestBidWithinTheTime) {
  fast_.poses = {truth_};
  const Selector picky(
      {{"slow", &slow_}, {"fast", &fast_}},
      {.methods = {model("slow", 9, std::log(1e5)), model("fast", 1, std::log(1e-3))}, .second_chance = {}}, {});
  EXPECT_EQ(tried(run(picky)).front(), "slow");
  const RunContext hurry{.seed = 1, .num_threads = 1, .stop = StopToken::after(std::chrono::seconds(1000))};
  EXPECT_THAT(tried(run(picky, hurry)), ElementsAre("fast"));
  // Where nothing fits, the fastest is tried all the same.
  const RunContext too_late{.seed = 1, .num_threads = 1, .stop = StopToken::after(std::chrono::duration<double>(1e-9))};
  EXPECT_THAT(tried(run(picky, too_late)), ElementsAre("fast"));
}

TEST_F(SelectorTest, ALaterMethodOnlyAddsToWhatIsKnown) {
  // The first finds the pose, but not surely; the second proposes nothing of worth.
  fast_.poses = {nowhere_};
  slow_.poses = {nowhere_ * Pose2{5, 0, 1}};
  const Alignment alone = align_prepared(request(), OneMethod(fast_, "fast"), {}, {});
  const Alignment both = run(selector());
  ASSERT_FALSE(alone.hypotheses.empty());
  ASSERT_FALSE(both.hypotheses.empty());
  EXPECT_GE(both.hypotheses.front().figures.support_m, alone.hypotheses.front().figures.support_m);
}

TEST_F(SelectorTest, SameRequestSameAnswerAtAnyNumberOfThreads) {
  fast_.poses = {nowhere_};
  slow_.poses = {truth_};
  const Alignment one = run(selector(), {.seed = 1, .num_threads = 1});
  const Alignment four = run(selector(), {.seed = 1, .num_threads = 4});
  EXPECT_EQ(one.story, four.story);
  EXPECT_EQ(one.confidence, four.confidence);
  EXPECT_EQ(tried(one), tried(four));
}

TEST(Selector, RefusesABookThatWeighsWhatIsNoInput) {
  const Toy toy;
  const BidBook book{.methods = {{.method = "toy", .success = {{{"colour", 1}}}, .log_seconds = {}}},
                     .second_chance = {}};
  EXPECT_THAT(
      [&] {
        (void)Selector({{"toy", &toy}}, book, {});
      },
      ThrowsMessage<std::invalid_argument>(testing::AllOf(HasSubstr("colour"), HasSubstr("straightness"))));
  EXPECT_THAT(
      [&] {
        (void)Selector({{"toy", &toy}}, {}, {.success_slack = 2});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("success_slack")));
}

TEST(OneMethod, IsTriedOnce) {
  const Toy toy;
  const OneMethod one(toy, "toy");
  const worlds::MapPair pair = worlds::make_scene(known_pair("flat"));
  const PreparedMap map(pair.target, 0.05);
  const std::unique_ptr<Choice> choice = one.begin({.target = map, .source = map, .prior = {}}, {});
  ASSERT_TRUE(choice->next({}));
  EXPECT_EQ(choice->next({})->method, &toy);
  EXPECT_FALSE(choice->next({{.method = "toy", .why = ""}}));
  EXPECT_TRUE(choice->story().empty());
}

}  // namespace
}  // namespace gridmerge
