#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gridmerge/base/random.hpp"
#include "selector/learn.hpp"
#include "selector/tables.hpp"

namespace gridmerge::selector_study {
namespace {

using study::Row;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Row run_of(const std::string& method, int pair, const std::string& result, double seconds) {
  Row row;
  row.set = "toy";
  row.pair = std::to_string(pair);
  row.window = "none";
  row.window_m = row.window_deg = std::numeric_limits<double>::quiet_NaN();
  row.method = method;
  row.profile = "default";
  row.truth = result == "refused" || result == "false" ? "different" : "same";
  row.result = result;
  row.status = result == "missed" || result == "refused" ? "ambiguous" : "merged";
  row.confidence = row.status == "merged" ? 0.97 : 0.3;
  row.align_s = seconds;
  row.target = {.straightness = 0.7,
                .directions = 2,
                .occupied_cells = 5000,
                .known_area_m2 = 300,
                .clutter = 0.1,
                .self_similarity = 0.3};
  row.source = row.target;
  row.tried = method;
  return row;
}

/// `walls` is right where there is little clutter, `posts` where there is much; `posts` takes ten times as long.
std::vector<Row> learned_rows() {
  std::vector<Row> rows;
  RandomStream random(1, "selector rows");
  for (int pair = 0; pair < 400; ++pair) {
    const double clutter = random.uniform();
    const double cells = std::exp(random.uniform(7, 10));
    for (const std::string method : {"walls", "posts"}) {
      const double chance = method == "walls" ? 1 - clutter : clutter;
      Row row = run_of(method, pair, random.uniform() < chance ? "right" : "missed",
                       (method == "walls" ? 1e-5 : 1e-4) * cells);
      row.target.clutter = row.source.clutter = clutter;
      row.target.occupied_cells = row.source.occupied_cells = cells;
      rows.push_back(row);
    }
  }
  return rows;
}

TEST(Learn, FindsWhichMethodIsForWhat) {
  const BidBook book = learn(learned_rows());
  ASSERT_EQ(book.methods.size(), 2U);
  const auto bid = [&](const std::string& method, double clutter) {
    SceneFeatures scene{.straightness = 0.7,
                        .directions = 2,
                        .occupied_cells = 5000,
                        .known_area_m2 = 300,
                        .clutter = clutter,
                        .self_similarity = 0.3};
    return *bid_of(book, method, BidInputs(scene, scene, {}));
  };
  EXPECT_GT(bid("walls", 0.1).success, 0.75);
  EXPECT_LT(bid("walls", 0.9).success, 0.25);
  EXPECT_GT(bid("posts", 0.9).success, 0.75);
  EXPECT_NEAR(bid("walls", 0.5).seconds, 0.05, 0.01);
  EXPECT_NEAR(bid("posts", 0.5).seconds, 0.5, 0.1);
}

TEST(Learn, TheSecondChanceIsWhatAnotherMethodDidThere) {
  std::vector<Row> rows;
  for (int pair = 0; pair < 200; ++pair) {
    // What the first leaves ambiguous the other merges; what it leaves as no overlap nobody merges.
    Row first = run_of("first", pair, "missed", 0.1);
    first.status = pair % 2 == 0 ? "ambiguous" : "no_overlap";
    rows.push_back(first);
    Row second = run_of("second", pair, pair % 2 == 0 ? "right" : "missed", 0.1);
    second.status = pair % 2 == 0 ? "merged" : "no_overlap";
    rows.push_back(second);
  }
  const WeightedSum chance = learn(rows).second_chance;
  const auto of = [&](bool ambiguous) { return 1 / (1 + std::exp(-chance.of(second_chance_inputs(0.3, ambiguous)))); };
  EXPECT_GT(of(true), 0.8);
  EXPECT_LT(of(false), 0.2);
}

/// A gate leaves the confidence at a half, where nobody else merges; above it little is missing. One slope through both
/// would say the same of either.
TEST(Learn, ANearMissHasItsOwnSecondChance) {
  std::vector<Row> rows;
  for (int pair = 0; pair < 300; ++pair) {
    const bool near_miss = pair % 3 == 0;
    Row first = run_of("first", pair, "missed", 0.1);
    first.confidence = near_miss ? 0.7 : pair % 3 == 1 ? 0.5 : 0.01;
    rows.push_back(first);
    rows.push_back(run_of("second", pair, near_miss ? "right" : "missed", 0.1));
  }
  for (Row& row : rows) {
    row.status = row.result == "right" ? "merged" : "ambiguous";
  }
  const WeightedSum chance = learn(rows).second_chance;
  EXPECT_GT(chance.of(second_chance_inputs(0.75, true)), 0);
  EXPECT_LT(chance.of(second_chance_inputs(0.5, true)), -1);
  EXPECT_LT(chance.of(second_chance_inputs(0.01, true)), -1);
}

TEST(Learn, LeavesOutWhatTellsNothingOfAMethod) {
  EXPECT_TRUE(is_learned_from(run_of("walls", 1, "right", 0.1)));
  EXPECT_FALSE(is_learned_from(run_of("auto", 1, "right", 0.1)));
  Row row = run_of("walls", 1, "right", 0.1);
  row.profile = "paper";
  EXPECT_FALSE(is_learned_from(row));
  row = run_of("walls", 1, "right", 0.1);
  row.truth = "unknown";
  EXPECT_FALSE(is_learned_from(row));
  row = run_of("walls", 1, "right", 0.1);
  row.options = "walls.step=2";
  EXPECT_FALSE(is_learned_from(row));
  EXPECT_TRUE(learn({}).methods.empty());
}

TEST(Tables, CompareEveryMethodWithTheBestInHindsight) {
  std::vector<Row> rows = {run_of("walls", 1, "right", 0.1),   run_of("posts", 1, "right", 0.3),
                           run_of("auto", 1, "right", 0.11),   run_of("walls", 2, "missed", 0.1),
                           run_of("posts", 2, "right", 0.5),   run_of("auto", 2, "right", 0.6),
                           run_of("walls", 3, "refused", 0.1), run_of("posts", 3, "false", 0.2),
                           run_of("auto", 3, "refused", 0.1),  run_of("walls", 4, "right", 0.1)};
  rows[5].tried = "walls posts";
  const std::string table = comparison_table(rows);
  // The fourth pair was run by one method alone: it is not counted.
  EXPECT_THAT(table,
              AllOf(HasSubstr("| toy | walls | 3 | 1 | 0 | 0.100 |"), HasSubstr("| toy | posts | 3 | 2 | 1 | 0.300 |"),
                    HasSubstr("| toy | auto | 3 | 2 | 0 | 0.110 |"),
                    HasSubstr("| toy | best in hindsight | 3 | 2 | 0 | 0.100 |"), HasSubstr("| all | auto | 3 |")));
  EXPECT_THAT(choice_table(rows),
              AllOf(HasSubstr("| auto | 1 | 0 | 1 | 0 | 0 |"), HasSubstr("| walls posts | 1 | 0 | 0 | 0 | 0 |")));
}

}  // namespace
}  // namespace gridmerge::selector_study
