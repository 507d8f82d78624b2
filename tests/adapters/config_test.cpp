#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "config/config_file.hpp"
#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

struct ToyOptions {
  int population = 300;
  double rate = 0.5;
  bool niches = false;
  std::string policy = "mean";

  void describe(OptionList& list) {
    list.add("population", population, 2, 10000, {"", "How many poses live at a time", ""})
        .add("rate", rate, 0, 1, {"", "Share of poses replaced", ""})
        .add("niches", niches, {"", "Whether poses keep apart", ""})
        .add("policy", policy, {"mean", "off"}, {"", "Where the next epoch starts", ""});
  }
};

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

/// What `check` says of a file whose section `toy` holds ToyOptions, beside the value `method`.
std::string problems_of(const std::string& yaml) {
  return error_of([&] {
    ConfigFile file = ConfigFile::parse(yaml, "toy.yaml");
    ToyOptions options;
    OptionList list = option_list(options);
    (void)file.value("method");
    file.apply("toy", list);
    file.check();
  });
}

TEST(ConfigFile, SetsTheOptionsGivenAndLeavesTheOthers) {
  ConfigFile file = ConfigFile::parse("method: toy\ntoy: {population: 20, policy: off}\n", "toy.yaml");
  ToyOptions options;
  OptionList list = option_list(options);
  EXPECT_EQ(file.value("method"), "toy");
  EXPECT_EQ(file.value("profile"), std::nullopt);
  EXPECT_THAT(file.sections(), ElementsAre("toy"));
  file.apply("toy", list);
  file.check();
  EXPECT_EQ(options.population, 20);
  EXPECT_EQ(options.policy, "off");
  EXPECT_EQ(options.rate, 0.5);
}

TEST(ConfigFile, TopLevelOptionsStandOutsideOfSections) {
  ConfigFile file = ConfigFile::parse("rate: 0.25\nother: {population: 7}\n", "toy.yaml");
  ToyOptions top;
  ToyOptions other;
  OptionList top_list = option_list(top);
  OptionList other_list = option_list(other);
  file.apply(ConfigFile::kTopLevel, top_list);
  file.apply("other", other_list);
  file.check();
  EXPECT_EQ(top.rate, 0.25);
  EXPECT_EQ(top.population, 300);
  EXPECT_EQ(other.population, 7);
}

TEST(ConfigFile, AFileOrASectionMayBeEmpty) {
  EXPECT_EQ(problems_of(""), "no InputError");
  EXPECT_EQ(problems_of("# nothing yet\n"), "no InputError");
  EXPECT_EQ(problems_of("toy:\n  # population: 20\n"), "no InputError");
  EXPECT_EQ(problems_of("toy: {}\n"), "no InputError");
}

TEST(ConfigFile, TellsAllProblemsAtOnceWithTheirLines) {
  const std::string problems = problems_of(
      "method: toy\n"
      "toy:\n"
      "  population: 1\n"
      "  populaton: 30\n"
      "  rate: fast\n"
      "  niches: 3\n"
      "  policy: median\n"
      "genetc: {}\n");
  EXPECT_THAT(problems, StartsWith("toy.yaml:3: population"));
  EXPECT_THAT(problems, AllOf(HasSubstr("2 .. 10000"),
                              HasSubstr("toy.yaml:4: unknown key 'populaton'; known keys: population, rate, niches, "
                                        "policy"),
                              HasSubstr("toy.yaml:5: rate = 'fast'"), HasSubstr("toy.yaml:6: niches = '3'"),
                              HasSubstr("toy.yaml:7: policy = 'median'"), HasSubstr("mean, off"),
                              HasSubstr("toy.yaml:8: unknown key 'genetc'; known keys: method, toy")));
}

TEST(ConfigFile, ARepeatedKeyIsAProblem) {
  EXPECT_EQ(problems_of("toy:\n  rate: 0.1\n  rate: 0.2\n"), "toy.yaml:3: repeated key 'rate', first given on line 2");
  EXPECT_EQ(problems_of("toy: {}\nmethod: a\ntoy: {}\n"), "toy.yaml:3: repeated key 'toy', first given on line 1");
}

TEST(ConfigFile, AKeyThatNobodyAskedForIsAProblem) {
  EXPECT_THAT(error_of([] { ConfigFile::parse("a: 1\n", "x.yaml").check(); }), StartsWith("x.yaml:1: unknown key 'a'"));
}

TEST(ConfigFile, AValueMustBeSingleAndASectionMustHoldOptions) {
  EXPECT_EQ(problems_of("toy: {rate: [0.1, 0.2]}\n"), "toy.yaml:1: 'rate' must have a single value");
  EXPECT_EQ(problems_of("toy: {rate: }\n"), "toy.yaml:1: 'rate' must have a single value");
  EXPECT_EQ(problems_of("method: {name: toy}\n"), "toy.yaml:1: 'method' must have a single value");
  EXPECT_THAT(problems_of("toy: 5\n"), StartsWith("toy.yaml:1: 'toy' must hold options"));
  EXPECT_THAT(problems_of("toy: [rate]\n"), StartsWith("toy.yaml:1: 'toy' must hold options"));
}

TEST(ConfigFile, ACallerMayRejectAValue) {
  ConfigFile file = ConfigFile::parse("\nmethod: magic\n", "toy.yaml");
  (void)file.value("method");
  file.reject("method", "is not known; known: toy");
  EXPECT_EQ(error_of([&] { file.check(); }), "toy.yaml:2: method = 'magic' is not known; known: toy");
}

TEST(ConfigFile, WhatIsNotOneYamlMappingIsNamedWithItsLine) {
  EXPECT_THAT(problems_of("method: toy\ntoy: {rate: 0.1\n"), AllOf(StartsWith("toy.yaml:"), HasSubstr("is not YAML")));
  EXPECT_THAT(problems_of("just words\n"), HasSubstr("is not a YAML mapping"));
  EXPECT_THAT(problems_of("- a\n- b\n"), HasSubstr("is not a YAML mapping"));
  EXPECT_THAT(problems_of("a: 1\n---\nb: 2\n"), HasSubstr("holds more than one YAML document"));
  EXPECT_THAT(problems_of(", x\n"), StartsWith("toy.yaml"));
  EXPECT_THAT(problems_of("[a, b]: 1\n"), HasSubstr("toy.yaml:1: a key must be a single word"));
  EXPECT_THAT(problems_of("a: *nowhere\n"), HasSubstr("is not YAML"));
  EXPECT_THAT(problems_of(std::string(100000, '[')), HasSubstr("is not YAML"));
}

TEST(ConfigFile, AMissingFileIsNamed) {
  EXPECT_EQ(error_of([] { (void)ConfigFile::read("no/such.yaml"); }), "no/such.yaml: does not exist");
  const std::string folder = ::testing::TempDir();
  EXPECT_EQ(error_of([&] { (void)ConfigFile::read(folder); }), folder + ": is a directory, not a file");
}

TEST(ConfigFile, WhatToYamlWritesReadsBackTheSame) {
  ToyOptions written{.population = 12, .rate = 0.1, .niches = true, .policy = "off"};
  const std::string yaml = to_yaml("toy", option_list(written));
  EXPECT_EQ(yaml, "toy:\n  population: 12\n  rate: 0.1\n  niches: true\n  policy: \"off\"\n");
  ConfigFile file = ConfigFile::parse(yaml, "toy.yaml");
  ToyOptions read;
  OptionList list = option_list(read);
  file.apply("toy", list);
  file.check();
  EXPECT_EQ(list.values(), option_list(written).values());
  EXPECT_THAT(to_yaml(ConfigFile::kTopLevel, option_list(written)), StartsWith("population: 12\n"));
}

TEST(YamlWord, ReadsBackAsTheSameText) {
  for (const std::string text : {"plain",
                                 "with space",
                                 "",
                                 "true",
                                 "No",
                                 "12",
                                 "~",
                                 "a: b",
                                 "#1",
                                 "say \"hi\"",
                                 "back\\slash",
                                 "tab\there",
                                 "line\nbreak",
                                 "- dash",
                                 "[x]",
                                 "h\u00f6lder.pgm",
                                 "*star",
                                 "2024-01-01",
                                 ".hidden",
                                 "nul"}) {
    const auto entries = parse_yaml_mapping("key: " + yaml_word(text) + "\n", "x.yaml");
    ASSERT_EQ(entries.size(), 1U) << text;
    EXPECT_EQ(entries.front().text, text);
    EXPECT_EQ(entries.front().kind, YamlEntry::Kind::kScalar) << text;
  }
}

TEST(ConfigFile, GivesAListOrASingleValueAsTexts) {
  ConfigFile file = ConfigFile::parse("one: a.so\nmany: [b.so, 'c d.so']\nnone: []\n", "f.yaml");
  EXPECT_EQ(file.values("one"), std::vector<std::string>{"a.so"});
  EXPECT_EQ(file.values("many"), (std::vector<std::string>{"b.so", "c d.so"}));
  EXPECT_TRUE(file.values("none").empty());
  EXPECT_TRUE(file.values("not given").empty());
  EXPECT_NO_THROW(file.check());
}

TEST(ConfigFile, RefusesAListOfAnythingButTexts) {
  for (const std::string text : {"list: {a: b}\n", "list: [[a]]\n", "list:\n"}) {
    ConfigFile file = ConfigFile::parse(text, "f.yaml");
    EXPECT_TRUE(file.values("list").empty());
    EXPECT_THROW(file.check(), InputError) << text;
  }
}

}  // namespace
}  // namespace gridmerge
