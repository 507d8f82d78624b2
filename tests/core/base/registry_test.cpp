#include "gridmerge/align/registry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace gridmerge {
namespace {

struct StillOptions {
  int candidates = 1;
  void describe(OptionList& list) { list.add("candidates", candidates, 1, 5, {"", "How many to propose.", ""}); }
};

/// Proposes that nothing moves.
class Still final : public Merger {
 public:
  explicit Still(const StillOptions& options) : options_(options) { require_valid(options, "still"); }
  [[nodiscard]] MergerTraits traits() const override { return {}; }
  [[nodiscard]] Proposal propose(const AlignRequest& /*request*/, const RunContext& /*context*/) const override {
    return {.candidates = std::vector<Candidate>(static_cast<std::size_t>(options_.candidates)), .carry = {}};
  }

 private:
  StillOptions options_;
};

MethodEntry entry(const std::string& name, const std::vector<std::string>& profiles) {
  MethodEntry made = {.name = name, .summary = "Nothing moves.", .paper = "none", .profiles = {}};
  for (const std::string& profile : profiles) {
    made.profiles.push_back(
        {profile, "", [] { return std::make_unique<TypedMethodConfig<StillOptions, Still>>(StillOptions{}); }});
  }
  return made;
}

/// The text of the std::invalid_argument that is thrown.
template <typename Act>
std::string refusal(Act&& act) {
  try {
    act();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(MethodRegistry, KeepsTheOrderOfAdding) {
  MethodRegistry registry;
  registry.add(entry("still", {"default"}));
  registry.add(entry("idle", {"default", "paper"}));
  EXPECT_THAT(registry.entries(), testing::ElementsAre(testing::Field(&MethodEntry::name, "still"),
                                                       testing::Field(&MethodEntry::name, "idle")));
  EXPECT_EQ(registry.method("idle").profile("paper").name, "paper");
}

TEST(MethodRegistry, RefusesANameThatIsTaken) {
  MethodRegistry registry;
  registry.add(entry("still", {"default"}));
  EXPECT_EQ(refusal([&] { registry.add(entry("still", {"default"})); }), "method still is registered twice");
  EXPECT_EQ(registry.entries().size(), 1U);
}

TEST(MethodRegistry, RefusesAMethodWithoutAProfile) {
  MethodRegistry registry;
  EXPECT_EQ(refusal([&] { registry.add(entry("still", {})); }), "method still has no profile");
}

TEST(MethodRegistry, NamesTheKnownMethodsForAnUnknownOne) {
  MethodRegistry registry;
  registry.add(entry("still", {"default"}));
  registry.add(entry("idle", {"default"}));
  EXPECT_EQ(refusal([&] { static_cast<void>(registry.method("Still")); }),
            "unknown method 'Still'; known: still, idle");
}

TEST(MethodRegistry, NamesTheKnownProfilesForAnUnknownOne) {
  EXPECT_EQ(refusal([] {
              static_cast<void>(entry("still", {"default", "paper"}).profile("fast"));
            }),
            "unknown profile of method still 'fast'; known: default, paper");
}

TEST(MethodConfig, BuildsTheMethodFromItsOptions) {
  const std::unique_ptr<MethodConfig> config = entry("still", {"default"}).profile("default").config();
  EXPECT_EQ(config->options().set("candidates", "3"), "");
  EXPECT_THAT(config->options().values(), testing::ElementsAre(testing::Pair("candidates", "3")));
  EXPECT_NE(config->make(), nullptr);
}

TEST(MethodConfig, RefusesOptionsOutOfRangeWhenBuilding) {
  StillOptions options;
  options.candidates = 9;
  const TypedMethodConfig<StillOptions, Still> config(options);
  EXPECT_EQ(refusal([&] { static_cast<void>(config.make()); }), "still: candidates = 9 is out of range: 1 .. 5");
}

}  // namespace
}  // namespace gridmerge
