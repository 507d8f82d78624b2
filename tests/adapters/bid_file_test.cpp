#include "config/bid_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gridmerge/base/error.hpp"
#include "methods/register_all.hpp"

namespace gridmerge {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string error_of(const std::string& yaml) {
  try {
    (void)parse_bids(yaml, "bids.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

constexpr const char* kGood =
    "methods:\n"
    "  toy:\n"
    "    success: {bias: 1.5, clutter: -0.25}\n"
    "    log_seconds: {bias: -3}\n"
    "second_chance: {bias: -2, log_odds: 0.5}\n";

TEST(BidFile, ReadsWhatItWrote) {
  const BidBook book = parse_bids(kGood, "bids.yaml");
  ASSERT_EQ(book.methods.size(), 1U);
  EXPECT_EQ(book.methods.front().method, "toy");
  EXPECT_EQ(book.methods.front().success.weights,
            (std::vector<std::pair<std::string, double>>{{"bias", 1.5}, {"clutter", -0.25}}));
  EXPECT_EQ(book.second_chance.weights.size(), 2U);
  EXPECT_EQ(to_yaml(book), kGood);
  EXPECT_EQ(to_yaml(parse_bids(to_yaml(BidBook{}), "empty")), to_yaml(BidBook{}));
}

TEST(BidFile, TellsEveryProblemWithItsLine) {
  const std::string told = error_of(
      "methods:\n"
      "  toy:\n"
      "    success: {bias: much, colour: 1}\n"
      "  other: 3\n"
      "  third:\n"
      "    success: {bias: 1, bias: 2}\n"
      "    log_seconds: {bias: .inf}\n"
      "last_chance: {}\n");
  EXPECT_THAT(told, AllOf(HasSubstr("bids.yaml:3: bias = 'much': must be a finite number"), HasSubstr("colour"),
                          HasSubstr("bids.yaml:4: other: must hold success and log_seconds"),
                          HasSubstr("bids.yaml:2: toy: key 'log_seconds' is missing"), HasSubstr("last_chance")));
  EXPECT_THAT(told, AllOf(HasSubstr("bids.yaml:6: "), HasSubstr("bids.yaml:7: bias = '.inf'")));
  EXPECT_THAT(error_of("methods: [a]\n"), HasSubstr("methods: must hold methods"));
  EXPECT_THAT(error_of("second_chance: {clutter: 1}\n"), HasSubstr("log_odds"));
  EXPECT_EQ(error_of(kGood), "no InputError");
}

TEST(BidFile, TheShippedOneKnowsEveryMethodOfTheHouse) {
  const BidBook& book = shipped_bids();
  EXPECT_FALSE(book.second_chance.weights.empty());
  const BidInputs inputs({.straightness = 0.6,
                          .directions = 2,
                          .occupied_cells = 5000,
                          .known_area_m2 = 200,
                          .clutter = 0.1,
                          .self_similarity = 0.3},
                         {.straightness = 0.6,
                          .directions = 2,
                          .occupied_cells = 4000,
                          .known_area_m2 = 150,
                          .clutter = 0.1,
                          .self_similarity = 0.3},
                         {});
  const MethodRegistry methods = all_methods();
  for (const MethodEntry& entry : methods.entries()) {
    const std::optional<Bid> bid = bid_of(book, entry.name, inputs);
    ASSERT_TRUE(bid) << entry.name;
    EXPECT_GT(bid->success, 0.3) << entry.name;
    EXPECT_LT(bid->success, 1) << entry.name;
    EXPECT_GT(bid->seconds, 0.005) << entry.name;
    EXPECT_LT(bid->seconds, 20) << entry.name;
  }
}

}  // namespace
}  // namespace gridmerge
