#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "methods/register_all.hpp"
#include "support/scenes.hpp"
#include "verdict/derived.hpp"
#include "verdict/fit.hpp"
#include "verdict/pairs.hpp"
#include "verdict/rows.hpp"
#include "verdict/tables.hpp"

namespace gridmerge::verdict_study {
namespace {

/// Two surveys of one office that have a part in common.
worlds::MapPair office() { return make_scene(known_pair("office_small_overlap")); }

std::size_t count_known(const OccupancyGrid& grid) { return known_cells(grid).count; }

/// The least distance between known cells of two grids of one geometry [m].
double distance_between(const OccupancyGrid& first, const OccupancyGrid& second, double at_most_m) {
  const int reach = static_cast<int>(std::ceil(at_most_m / first.geometry.resolution_m));
  double least = at_most_m;
  for (int row = 0; row < first.geometry.height; ++row) {
    for (int column = 0; column < first.geometry.width; ++column) {
      for (int dy = -reach; dy <= reach && first.at({column, row}) != kUnknown; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          const CellIndex other = {column + dx, row + dy};
          if (second.geometry.contains(other) && second.at(other) != kUnknown) {
            least = std::min(least, std::hypot(dx, dy) * first.geometry.resolution_m);
          }
        }
      }
    }
  }
  return least;
}

TEST(Derived, ErasedMapsShareNoKnownCell) {
  const worlds::MapPair pair = office();
  ASSERT_GT(pair.overlap, 0.1);
  const OccupancyGrid erased = erase_overlap(pair.target, pair.source, pair.target_from_source, 1);
  EXPECT_GT(count_known(erased), 0U);
  EXPECT_EQ(worlds::overlap_of(pair.target, erased, pair.target_from_source), 0);
  EXPECT_EQ(worlds::overlap_of(erased, pair.target, inverse(pair.target_from_source)), 0);
  // Nor with anything that lies a little less than the reach away.
  for (const Point2 way : {Point2{0.95, 0}, Point2{-0.95, 0}, Point2{0, 0.95}, Point2{0, -0.95}}) {
    const Pose2 moved = Pose2{way.x_m, way.y_m, 0} * pair.target_from_source;
    EXPECT_EQ(worlds::overlap_of(pair.target, erased, moved), 0);
  }
}

TEST(Derived, HalvesOfASplitMapLieApart) {
  const OccupancyGrid whole = office().target;
  const KnownCells known = known_cells(whole);
  const auto [before, behind] = split_in_two(whole, known.principal_rad + 0.3, 0.5, 1);
  EXPECT_GT(count_known(before), known.count / 4);
  EXPECT_GT(count_known(behind), known.count / 4);
  EXPECT_LT(count_known(before) + count_known(behind), known.count);
  EXPECT_GE(distance_between(before, behind, 1.2), 1 - 1e-9);
}

TEST(Derived, CutsLeaveTheOverlapAskedFor) {
  const worlds::MapPair pair = office();
  const auto cut = cut_to_overlap(pair.target, pair.source, pair.target_from_source, 0.4, 0.3);
  ASSERT_TRUE(cut);
  EXPECT_NEAR(worlds::overlap_of(pair.target, *cut, pair.target_from_source), 0.3, 0.03);
  EXPECT_LT(count_known(*cut), count_known(pair.source));
  const OccupancyGrid nothing = unknown_grid(pair.source.geometry);
  EXPECT_FALSE(cut_to_overlap(pair.target, nothing, pair.target_from_source, 0.4, 0.3));
}

TEST(Derived, KnownCellsTellCentreAxisAndArea) {
  OccupancyGrid grid =
      unknown_grid({.width = 40, .height = 40, .resolution_m = 0.5, .map_from_grid = {10, 20, radians(30)}});
  for (int column = 4; column < 36; ++column) {
    grid.at({column, 9}) = kFree;
    grid.at({column, 10}) = kOccupied;
  }
  const KnownCells known = known_cells(grid);
  EXPECT_EQ(known.count, 64U);
  EXPECT_EQ(known.area_m2, 16);
  EXPECT_EQ(known.walls_m, 16);
  EXPECT_NEAR(known.principal_rad, radians(30), 1e-9);
  EXPECT_NEAR(norm(known.centre - grid.geometry.map_from_grid * Point2{10, 5}), 0, 1e-9);
  OccupancyGrid elsewhere = grid;
  elsewhere.geometry.map_from_grid = {};
  EXPECT_EQ(known_cells(elsewhere).fingerprint, known.fingerprint);
  EXPECT_NE(known_cells(unknown_grid(grid.geometry)).fingerprint, known.fingerprint);
}

TEST(Pairs, DrawnScenesComeInEveryKindWithTheirTruth) {
  const std::vector<PairPlan> plans = plan_pairs({.manifests = {}, .same_building = {}, .scenes = 36});
  ASSERT_EQ(plans.size(), 36U);
  std::vector<std::string> kinds;
  for (const PairPlan& plan : plans) {
    kinds.push_back(plan.kind);
  }
  for (const char* kind : {"overlap", "two_worlds", "mirrored", "two_ends"}) {
    EXPECT_EQ(std::count(kinds.begin(), kinds.end(), kind), 8) << kind;
  }
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "ambiguous"), 4);
  EXPECT_NE(plans[8].scene.seed, plans[26].scene.seed);
  const auto of_kind = [&](const std::string& set, const std::string& kind) {
    return *build_pair(*std::find_if(plans.begin(), plans.end(),
                                     [&](const PairPlan& plan) { return plan.set == set && plan.kind == kind; }));
  };
  EXPECT_EQ(of_kind("flat", "overlap").truth, "same");
  EXPECT_TRUE(of_kind("flat", "overlap").pose);
  EXPECT_EQ(of_kind("flat", "mirrored").truth, "different");
  EXPECT_EQ(of_kind("hall", "ambiguous").truth, "ambiguous");
  EXPECT_FALSE(of_kind("flat", "mirrored").pose);
}

/// Two tiny scenes, one that overlaps and one that does not.
std::vector<PairPlan> tiny_plans() {
  std::vector<PairPlan> plans = plan_pairs({.manifests = {}, .same_building = {}, .scenes = 10});
  plans = {plans[8], plans[9]};
  for (PairPlan& plan : plans) {
    EXPECT_EQ(plan.set, "flat");
    plan.scene.resolution_m = 0.1;
  }
  return plans;
}

TEST(Rows, AreTheSameAtAnyNumberOfThreads) {
  const auto method = all_methods().entries().front().profiles.front().config()->make();
  const std::vector<PairPlan> plans = tiny_plans();
  const std::vector<Row> rows = make_rows(plans, *method, {}, 1);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_GT(rows[0].overlap, 0.01);
  EXPECT_TRUE(rows[0].error);
  EXPECT_FALSE(rows[1].error);
  EXPECT_EQ(to_csv(make_rows(plans, *method, {}, 2)), to_csv(rows));
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "rows.csv";
  std::ofstream(file) << to_csv(rows);
  const std::vector<Row> again = read_rows(file);
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(again[0].figures, rows[0].figures);
  EXPECT_EQ(again[1].outcome, rows[1].outcome);
}

/// A row whose figures are what chance makes them.
Row random_row(RandomStream& chance) {
  Figures figures;
  figures.source_in_target.same_side_m = chance.uniform(10, 150);
  figures.target_in_source.same_side_m = chance.uniform(10, 150);
  const double same_side_m = figures.source_in_target.same_side_m + figures.target_in_source.same_side_m;
  figures.source_in_target.far_in_free_m = chance.uniform(0, 0.08) * same_side_m;
  figures.source_in_target.in_free_m = figures.source_in_target.far_in_free_m + chance.uniform(0, 0.15) * same_side_m;
  const double in_free_m = figures.source_in_target.in_free_m;
  const double far_m = figures.source_in_target.far_in_free_m;
  figures.conflict_share = in_free_m / (in_free_m + same_side_m);
  figures.far_conflict_share = far_m / (far_m + same_side_m);
  figures.evidence_m = same_side_m - 1.75 * in_free_m;
  figures.overlap_area_m2 = std::exp(chance.uniform(2, 6));
  figures.mutual_information_bit = chance.uniform(0, 0.3);
  figures.overlap_share = chance.uniform(0, 1);
  Row row;
  row.lead = chance.uniform(0.08, 1);
  row.deviations = 5;
  row.figures = figures.named();
  return row;
}

TEST(Fit, FindsTheWeightsThatMadeTheRows) {
  RandomStream chance(1, "rows");
  const VerdictOptions truth;
  std::vector<Row> rows;
  for (int i = 0; i < 40000; ++i) {
    rows.push_back(random_row(chance));
    rows.back().right = chance.uniform() < confidence_of(rows.back(), truth);
  }
  const VerdictOptions fitted = fit_weights(rows, std::vector<double>(rows.size(), 1));
  for (const Weight& weight : kWeights) {
    const double wanted = truth.*weight.value;
    EXPECT_NEAR(fitted.*weight.value, wanted, 0.1 * std::abs(wanted) + 0.15) << weight.key;
  }
}

TEST(Fit, RowsOfNoImportanceDoNotCount) {
  RandomStream chance(2, "rows");
  std::vector<Row> rows;
  std::vector<double> importance;
  for (int i = 0; i < 400; ++i) {
    rows.push_back(random_row(chance));
    rows.back().right = chance.uniform() < confidence_of(rows.back(), {});
    importance.push_back(1);
  }
  const VerdictOptions before = fit_weights(rows, importance);
  const VerdictOptions twice = fit_weights(rows, std::vector<double>(rows.size(), 2));
  rows.push_back(random_row(chance));
  importance.push_back(0);
  EXPECT_EQ(fit_weights(rows, importance).bias, before.bias);
  EXPECT_NE(twice.bias, before.bias);  // the ridge weighs less
}

TEST(Fit, ConfidenceIsThatOfTheVerdict) {
  RandomStream chance(3, "rows");
  int merged = 0;
  for (int i = 0; i < 200; ++i) {
    const Row row = random_row(chance);
    Figures figures;
    figures.source_in_target.same_side_m = row.figure("source_same_side_m");
    figures.target_in_source.same_side_m = row.figure("target_same_side_m");
    figures.source_in_target.in_free_m = row.figure("source_in_free_m");
    figures.source_in_target.far_in_free_m = row.figure("source_far_in_free_m");
    figures.conflict_share = row.figure("conflict_share");
    figures.far_conflict_share = row.figure("far_conflict_share");
    figures.evidence_m = row.figure("evidence_m");
    figures.overlap_area_m2 = row.figure("overlap_area_m2");
    figures.mutual_information_bit = row.figure("mutual_information_bit");
    figures.overlap_share = row.figure("overlap_share");
    Figures rival;
    rival.evidence_m = (1 - row.lead) * figures.evidence_m;
    const Verdict verdict = judge({{.target_from_source = {}, .figures = figures, .method_score = 0},
                                   {.target_from_source = {}, .figures = rival, .method_score = 0}},
                                  {.mean_m = 0, .deviation_m = figures.evidence_m / row.deviations, .poses = 48}, {});
    const bool passes = passes_gates(row, {}) && confidence_of(row, {}) >= VerdictOptions{}.min_confidence;
    EXPECT_EQ(verdict.outcome == Outcome::kMerged, passes);
    if (verdict.outcome == Outcome::kMerged) {
      ++merged;
      EXPECT_NEAR(verdict.confidence, confidence_of(row, {}), 1e-9);
    }
  }
  EXPECT_GT(merged, 20);
}

/// The confidence of each row by weights fitted to other places.
std::vector<double> by_other_places(const std::vector<Row>& rows) {
  const std::vector<double> once(rows.size(), 1);
  return confidence_of(rows, place_keys(rows), fit_without(rows, once, place_keys(rows), share_a_place));
}

TEST(Fit, CrossValidationNeverFitsToARelatedRow) {
  RandomStream chance(4, "rows");
  std::vector<Row> rows;
  for (int i = 0; i < 300; ++i) {
    rows.push_back(random_row(chance));
    rows.back().places = i % 3 == 0 ? "mill" : i % 3 == 1 ? "barn" : "mill+barn";
    rows.back().right = chance.uniform() < confidence_of(rows.back(), {});
  }
  const std::vector<double> before = by_other_places(rows);
  // What stands in the mill's rows, and in those of both, is all the same to the mill.
  for (Row& row : rows) {
    row.right = row.places == "barn" ? row.right : !row.right;
  }
  const std::vector<double> after = by_other_places(rows);
  for (std::size_t i = 0; i < rows.size(); i += 3) {
    EXPECT_EQ(before[i], after[i]);
  }
  EXPECT_NE(before[1], after[1]);
  EXPECT_TRUE(share_a_place("a+b", "b"));
  EXPECT_FALSE(share_a_place("a+b", "ab+c"));
}

TEST(Tables, CountByKindAndSet) {
  const auto row = [](const char* kind, const char* truth, bool right, const char* outcome) {
    Row one;
    one.kind = kind;
    one.set = "mill";
    one.truth = truth;
    one.right = right;
    one.outcome = outcome;
    return one;
  };
  EXPECT_EQ(outcome_table({row("pair", "same", true, "merged"), row("pair", "same", false, "merged"),
                           row("cut", "same", true, "ambiguous"), row("pair", "different", false, "no_overlap"),
                           row("pair", "different", false, "merged")}),
            "| kind | set | pairs | right | wrong | missed | refused | false | pose@1 |\n"
            "|---|---|---|---|---|---|---|---|---|\n"
            "| pair | mill | 4 | 1 | 1 | 0 | 1 | 1 | 1 |\n"
            "| cut | mill | 1 | 0 | 0 | 1 | 0 | 0 | 1 |\n"
            "| all |  | 5 | 1 | 1 | 1 | 1 | 1 | 2 |\n");
}

}  // namespace
}  // namespace gridmerge::verdict_study
