#include "gridmerge/base/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

struct Sample {
  bool enabled = true;
  int count = 3;
  double radius_m = 0.5;
  std::string rule = "max";
  double bare = 1;

  void describe(OptionList& list) {
    list.add("enabled", enabled, {"", "Whether it runs.", ""})
        .add("count", count, 1, 10, {"", "How many.", "more is slower"})
        .add("radius_m", radius_m, 0.1, 2.5, {"m", "How far.", ""})
        .add("rule", rule, {"max", "log_odds"}, {"", "Which rule.", ""})
        .add("bare", bare, 0, std::numeric_limits<double>::infinity(), {"", "A number without a unit.", ""});
  }
};

TEST(OptionList, KeepsTheOrderOfDescription) {
  Sample sample;
  const OptionList list = option_list(sample);
  EXPECT_THAT(list.values(), testing::ElementsAre(testing::Pair("enabled", "true"), testing::Pair("count", "3"),
                                                  testing::Pair("radius_m", "0.5"), testing::Pair("rule", "max"),
                                                  testing::Pair("bare", "1")));
}

TEST(OptionList, TellsTheRangeOfEachOption) {
  Sample sample;
  std::vector<std::string> ranges;
  const OptionList list = option_list(sample);
  for (const OptionField& field : list.fields()) {
    ranges.push_back(field.range_text());
  }
  EXPECT_THAT(ranges, testing::ElementsAre("true | false", "1 .. 10", "0.1 .. 2.5", "max | log_odds", "0 .. .inf"));
}

TEST(OptionList, WritesWholeNumbersWithoutAnExponent) {
  struct Large {
    int count = 200000;
    double low_m = -std::numeric_limits<double>::infinity();
    void describe(OptionList& list) {
      list.add("count", count, 1, 1000000, {"", "How many.", ""})
          .add("low_m", low_m, -std::numeric_limits<double>::infinity(), 100000, {"m", "How low.", ""});
    }
  };
  Large large;
  OptionList list = option_list(large);
  EXPECT_EQ(list.fields()[0].range_text(), "1 .. 1000000");
  EXPECT_EQ(list.fields()[1].range_text(), "-.inf .. 100000");
  EXPECT_EQ(list.set("low_m", "100000"), "");
  EXPECT_EQ(list.fields()[1].value_text(), "100000");
  EXPECT_EQ(list.set("low_m", "-.inf"), "");
  EXPECT_EQ(list.fields()[1].value_text(), "-.inf");
}

TEST(OptionList, WritesIntoTheStructItDescribes) {
  Sample sample;
  OptionList list = option_list(sample);
  EXPECT_EQ(list.set("enabled", "false"), "");
  EXPECT_EQ(list.set("count", "10"), "");
  EXPECT_EQ(list.set("radius_m", "0.25"), "");
  EXPECT_EQ(list.set("rule", "log_odds"), "");
  EXPECT_EQ(list.set("bare", ".inf"), "");
  EXPECT_FALSE(sample.enabled);
  EXPECT_EQ(sample.count, 10);
  EXPECT_EQ(sample.radius_m, 0.25);
  EXPECT_EQ(sample.rule, "log_odds");
  EXPECT_EQ(sample.bare, std::numeric_limits<double>::infinity());
}

TEST(OptionList, ReadsBackWhatItWrites) {
  Sample sample;
  sample.radius_m = 0.1 + 0.2;
  sample.bare = 1e300;
  Sample copy;
  OptionList into = option_list(copy);
  for (const auto& [key, value] : option_list(sample).values()) {
    EXPECT_EQ(into.set(key, value), "") << key;
  }
  EXPECT_EQ(copy.radius_m, sample.radius_m);
  EXPECT_EQ(copy.bare, sample.bare);
}

struct BadText {
  const char* key;
  const char* value;
  const char* problem;
};

void PrintTo(const BadText& bad, std::ostream* out) { *out << bad.key << " = " << bad.value; }

class OptionListRefuses : public testing::TestWithParam<BadText> {};

TEST_P(OptionListRefuses, AndSaysWhyAndChangesNothing) {
  Sample sample;
  OptionList list = option_list(sample);
  EXPECT_EQ(list.set(GetParam().key, GetParam().value), GetParam().problem);
  Sample untouched;
  EXPECT_EQ(list.values(), option_list(untouched).values());
}

INSTANTIATE_TEST_SUITE_P(
    , OptionListRefuses,
    testing::Values(BadText{"colour", "red", "unknown key 'colour'; known keys: enabled, count, radius_m, rule, bare"},
                    BadText{"Count", "3", "unknown key 'Count'; known keys: enabled, count, radius_m, rule, bare"},
                    BadText{"enabled", "yes", "enabled = 'yes' is neither true nor false"},
                    BadText{"enabled", "", "enabled = '' is neither true nor false"},
                    BadText{"count", "3.5", "count = '3.5' is not a whole number"},
                    BadText{"count", "three", "count = 'three' is not a whole number"},
                    BadText{"count", "", "count = '' is not a whole number"},
                    BadText{"count", "99999999999", "count = '99999999999' is not a whole number"},
                    BadText{"count", "0", "count = 0 is out of range: 1 .. 10"},
                    BadText{"count", "11", "count = 11 is out of range: 1 .. 10"},
                    BadText{"radius_m", "0.5 m", "radius_m = '0.5 m' is not a number"},
                    BadText{"radius_m", "1,5", "radius_m = '1,5' is not a number"},
                    BadText{"radius_m", "0.05", "radius_m = 0.05 m is out of range: 0.1 .. 2.5"},
                    BadText{"radius_m", ".inf", "radius_m = .inf m is out of range: 0.1 .. 2.5"},
                    BadText{"radius_m", "nan", "radius_m = nan m is out of range: 0.1 .. 2.5"},
                    BadText{"bare", "-1", "bare = -1 is out of range: 0 .. .inf"},
                    BadText{"rule", "min", "rule = 'min' is not one of: max, log_odds"}));

TEST(OptionList, ReportsAllValuesOutOfRangeAtOnce) {
  Sample sample;
  EXPECT_THAT(option_list(sample).problems(), testing::IsEmpty());
  sample.count = 0;
  sample.radius_m = std::numeric_limits<double>::quiet_NaN();
  sample.rule = "none";
  EXPECT_THAT(option_list(sample).problems(),
              testing::ElementsAre("count = 0 is out of range: 1 .. 10", "radius_m = nan m is out of range: 0.1 .. 2.5",
                                   "rule = 'none' is not one of: max, log_odds"));
}

TEST(RequireValid, ThrowsNamingOwnerAndEveryProblem) {
  Sample sample;
  EXPECT_NO_THROW(require_valid(sample, "sample"));
  sample.count = 0;
  sample.rule = "none";
  try {
    require_valid(sample, "sample");
    FAIL() << "nothing thrown";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "sample: count = 0 is out of range: 1 .. 10; rule = 'none' is not one of: max, log_odds");
  }
}

TEST(InputError, SaysWhereAndWhat) {
  EXPECT_STREQ(InputError("map.yaml", "resolution = 0 must be positive").what(),
               "map.yaml: resolution = 0 must be positive");
}

}  // namespace
}  // namespace gridmerge
