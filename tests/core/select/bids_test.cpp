#include "gridmerge/select/bids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace gridmerge {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const SceneFeatures kOffice{.straightness = 0.7,
                            .directions = 2,
                            .occupied_cells = 5000,
                            .known_area_m2 = 300,
                            .clutter = 0.1,
                            .self_similarity = 0.3};
const SceneFeatures kForest{.straightness = 0.1,
                            .directions = 5,
                            .occupied_cells = 9000,
                            .known_area_m2 = 1600,
                            .clutter = 1,
                            .self_similarity = 0.05,
                            .ternary = false};

double input(const NamedValues& inputs, const std::string& name) {
  for (const auto& [key, value] : inputs) {
    if (key == name) {
      return value;
    }
  }
  ADD_FAILURE() << "no input " << name;
  return 0;
}

TEST(BidInputs, TakeTheHarderOfTheTwoMaps) {
  const BidInputs inputs(kOffice, kForest, {});
  EXPECT_EQ(input(inputs.named(), "bias"), 1);
  EXPECT_EQ(input(inputs.named(), "straightness"), 0.1);
  EXPECT_EQ(input(inputs.named(), "clutter"), 1);
  EXPECT_EQ(input(inputs.named(), "self_similarity"), 0.3);
  EXPECT_NEAR(input(inputs.named(), "log_least_known"), std::log(300), 1e-12);
  EXPECT_NEAR(input(inputs.named(), "log_occupied"), std::log(14000), 1e-12);
  EXPECT_EQ(input(inputs.named(), "probabilistic"), 1);
  EXPECT_EQ(input(inputs.named(), "directions"), 3.5);
}

TEST(BidInputs, SwappingTheMapsChangesNothing) {
  EXPECT_EQ(BidInputs(kOffice, kForest, {}).named(), BidInputs(kForest, kOffice, {}).named());
}

TEST(BidInputs, KnowHowTightAPriorIs) {
  const auto prior = [](double radius_m, double angle_deg) {
    return PosePrior{.target_from_source = {}, .radius_m = radius_m, .angle_rad = radians(angle_deg)};
  };
  EXPECT_EQ(input(BidInputs(kOffice, kOffice, {}).named(), "prior"), 0);
  EXPECT_EQ(input(BidInputs(kOffice, kOffice, PosePrior{}).named(), "prior"), 0);  // a start, not a fence
  const double tight = input(BidInputs(kOffice, kOffice, prior(1, 5)).named(), "prior");
  const double wide = input(BidInputs(kOffice, kOffice, prior(20, 180)).named(), "prior");
  EXPECT_LT(tight, 1);
  EXPECT_GT(tight, wide);
  EXPECT_GT(wide, 0);
}

TEST(BidInputs, HaveATextForEveryName) {
  const BidInputs inputs(kOffice, kForest, {});
  ASSERT_EQ(BidInputs::texts().size(), inputs.named().size());
  for (std::size_t i = 0; i < inputs.named().size(); ++i) {
    EXPECT_EQ(BidInputs::texts()[i].name, inputs.named()[i].first);
  }
}

TEST(BidBook, BidsBySumsOfWeightedInputs) {
  const BidBook book{.methods = {{.method = "toy",
                                  .success = {{{"bias", 2}, {"clutter", -1}}},
                                  .log_seconds = {{{"bias", -3}, {"log_occupied", 0.5}}}}},
                     .second_chance = {}};
  const BidInputs inputs(kOffice, kForest, {});
  const std::optional<Bid> bid = bid_of(book, "toy", inputs);
  ASSERT_TRUE(bid);
  EXPECT_NEAR(bid->success, 1 / (1 + std::exp(-1)), 1e-12);
  EXPECT_NEAR(bid->seconds, std::exp(-3 + 0.5 * std::log(14000)), 1e-9);
  EXPECT_FALSE(bid_of(book, "unheard_of", inputs));
}

TEST(BidBook, ASecondChanceSeesHowFarTheConfidenceIsAboveAHalf) {
  EXPECT_NEAR(input(second_chance_inputs(0.75, true), "above_half"), std::log(3), 1e-9);
  EXPECT_EQ(input(second_chance_inputs(0.5, true), "above_half"), 0);
  const NamedValues unlikely = second_chance_inputs(0.2, true);
  EXPECT_EQ(input(unlikely, "above_half"), 0);
  EXPECT_NEAR(input(unlikely, "log_odds"), -std::log(4), 1e-9);
  EXPECT_EQ(input(unlikely, "ambiguous"), 1);
}

TEST(BidBook, RefusesAWeightForWhatIsNoInput) {
  const WeightedSum sum{{{"colour", 1}}};
  EXPECT_THAT([&] { (void)sum.of(BidInputs(kOffice, kForest, {}).named()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("colour")));
}

}  // namespace
}  // namespace gridmerge
