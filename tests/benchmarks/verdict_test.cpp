#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/random.hpp"
#include "methods/register_all.hpp"
#include "support/scenes.hpp"
#include "verdict/derived.hpp"
#include "verdict/fit.hpp"
#include "verdict/pairs.hpp"
#include "verdict/pictures.hpp"
#include "verdict/rows.hpp"
#include "verdict/tables.hpp"
#include "worlds/world.hpp"

namespace gridmerge::verdict_study {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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

TEST(Derived, MirroredTwiceIsTheMapItself) {
  const OccupancyGrid map = office().target;
  EXPECT_NE(mirrored(map).cells, map.cells);
  EXPECT_EQ(mirrored(mirrored(map)).cells, map.cells);
  EXPECT_EQ(count_known(mirrored(map)), count_known(map));
}

TEST(Pairs, DrawnScenesComeInEveryKindWithTheirTruth) {
  const std::vector<PairPlan> plans = plan_pairs({.manifests = {}, .same_building = {}, .scenes = 400});
  ASSERT_EQ(plans.size(), 400U);
  std::vector<std::string> kinds;
  std::vector<std::string> sets;
  for (const PairPlan& plan : plans) {
    kinds.push_back(plan.kind);
    sets.push_back(plan.set);
    EXPECT_TRUE(worlds::scene_problems(plan.scene).empty()) << plan.target_name;
  }
  EXPECT_NEAR(static_cast<double>(std::count(kinds.begin(), kinds.end(), "overlap")), 185, 20);
  for (const char* kind : {"two_worlds", "mirrored", "two_ends"}) {
    EXPECT_NEAR(static_cast<double>(std::count(kinds.begin(), kinds.end(), kind)), 46, 12) << kind;
  }
  for (const char* kind : {"two_buildings", "two_floors", "ambiguous"}) {
    EXPECT_GT(std::count(kinds.begin(), kinds.end(), kind), 15) << kind;
  }
  for (const std::string& world : worlds::world_kinds()) {
    EXPECT_GT(std::count(sets.begin(), sets.end(), world), 2) << world;
  }
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
  std::vector<PairPlan> plans = plan_pairs({.manifests = {}, .same_building = {}, .scenes = 2});
  for (PairPlan& plan : plans) {
    const std::string relation = &plan == &plans.front() ? "overlap" : "mirrored";
    plan.kind = relation;
    plan.scene = {
        .kind = "flat", .seed = 7, .relation = relation, .target_share = 0.9, .source_share = 0.9, .resolution_m = 0.1};
  }
  return plans;
}

/// Without what depends on the machine.
std::string timeless(std::vector<Row> rows) {
  for (Row& row : rows) {
    row.seconds = row.judge_s = 0;
  }
  return to_csv(rows);
}

TEST(Rows, AreTheSameAtAnyNumberOfThreads) {
  const auto method = all_methods().entries().front().profiles.front().config()->make();
  const std::vector<PairPlan> plans = tiny_plans();
  const std::vector<Row> rows = make_rows(plans, *method, {}, 1);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_GT(rows[0].overlap, 0.01);
  EXPECT_TRUE(rows[0].error);
  EXPECT_FALSE(rows[1].error);
  EXPECT_EQ(timeless(make_rows(plans, *method, {}, 2)), timeless(rows));
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "rows.csv";
  std::ofstream(file) << to_csv(rows);
  const std::vector<Row> again = read_rows(file);
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(to_csv(again), to_csv(rows));
  EXPECT_TRUE(again[0].right);
  EXPECT_EQ(again[1].outcome, rows[1].outcome);
}

/// A row whose figures are what chance makes them.
Row random_row(RandomStream& chance) {
  Row row;
  row.evidence_m = 50;
  for (const ConfidenceTerm& term : confidence_terms()) {
    row.figures.*term.figure = chance.uniform(-1, 1);
  }
  row.rivals.resize(chance.below(6));
  for (RivalFigures& rival : row.rivals) {
    for (const RivalTerm& term : rival_terms()) {
      rival.*term.figure = chance.uniform(-2, 2);
    }
  }
  return row;
}

/// Weights that tell the terms apart.
ConfidenceWeights some_weights() {
  ConfidenceWeights weights;
  weights.bias = -0.4;
  double next = 1.5;
  for (const ConfidenceTerm& term : confidence_terms()) {
    weights.per.*term.figure = next;
    next = next > 0 ? -next + 0.1 : -next;
  }
  weights.per.log_rivals = -1.4;
  weights.per_rival = {.log_conflict = -0.9, .elastic_gain = 0.6, .log_overlap_share = 1.1};
  return weights;
}

TEST(Fit, FindsTheWeightsThatMadeTheRows) {
  RandomStream chance(1, "rows");
  const ConfidenceWeights truth = some_weights();
  std::vector<Row> rows;
  for (int i = 0; i < 40000; ++i) {
    rows.push_back(random_row(chance));
    rows.back().right = chance.uniform() < confidence_of(rows.back(), truth);
  }
  const ConfidenceWeights fitted = fit_weights(rows, std::vector<double>(rows.size(), 1));
  EXPECT_NEAR(fitted.bias, truth.bias, 0.1);
  for (const ConfidenceTerm& term : confidence_terms()) {
    EXPECT_NEAR(fitted.per.*term.figure, truth.per.*term.figure, 0.15) << term.name;
  }
  for (const RivalTerm& term : rival_terms()) {
    EXPECT_NEAR(fitted.per_rival.*term.figure, truth.per_rival.*term.figure, 0.1) << term.name;
  }
  EXPECT_LT(calibration_error(rows,
                              [&] {
                                std::vector<double> told;
                                for (const Row& row : rows) {
                                  told.push_back(confidence_of(row, fitted));
                                }
                                return told;
                              }()),
            0.02);
}

TEST(Rows, AreReadBackWithTheirRivals) {
  RandomStream chance(5, "rows");
  Row row = random_row(chance);
  row.kind = "pair";
  row.rivals = {{.log_conflict = -0.25, .elastic_gain = 0.1, .log_overlap_share = 1e-7}, {}};
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "rivals.csv";
  std::ofstream(file) << to_csv({row});
  const std::vector<Row> again = read_rows(file);
  ASSERT_EQ(again.size(), 1U);
  ASSERT_EQ(again[0].rivals.size(), 2U);
  EXPECT_EQ(again[0].rivals[0].log_overlap_share, 1e-7);
  EXPECT_EQ(to_csv(again), to_csv({row}));
}

TEST(Rows, NameARivalThatIsNone) {
  RandomStream chance(6, "rows");
  Row row = random_row(chance);
  row.rivals = {{}};
  const std::string text = to_csv({row});
  ASSERT_NE(text.find("0:0:0"), std::string::npos);
  for (const std::string wrong : {"0:0", "0:0:0:0", "0:x:0", "0;0;0"}) {
    const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "no_rival.csv";
    std::ofstream(file) << std::string(text).replace(text.find("0:0:0"), 5, wrong);
    try {
      static_cast<void>(read_rows(file));
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("no_rival.csv:2: rivals"), HasSubstr("'" + wrong + "'")));
    }
  }
}

TEST(Fit, RowsOfNoImportanceDoNotCount) {
  RandomStream chance(2, "rows");
  std::vector<Row> rows;
  std::vector<double> importance;
  for (int i = 0; i < 400; ++i) {
    rows.push_back(random_row(chance));
    rows.back().right = chance.uniform() < confidence_of(rows.back(), some_weights());
    importance.push_back(1);
  }
  const ConfidenceWeights before = fit_weights(rows, importance);
  const ConfidenceWeights twice = fit_weights(rows, std::vector<double>(rows.size(), 2));
  rows.push_back(random_row(chance));
  importance.push_back(0);
  EXPECT_EQ(fit_weights(rows, importance).bias, before.bias);
  EXPECT_NE(twice.bias, before.bias);  // the ridge weighs less
  // Nor do rows in which more speaks against the pose than for it: they are never sure of themselves.
  rows.back().evidence_m = -1;
  importance.back() = 1;
  EXPECT_EQ(fit_weights(rows, importance).bias, before.bias);
  EXPECT_EQ(confidence_of(rows.back(), before), 0);
}

TEST(Reliability, PutsEveryRowIntoItsBin) {
  std::vector<Row> rows(4);
  rows[2].right = rows[3].right = true;
  const std::vector<double> confidence = {0, 0.14, 0.16, 1};
  const std::vector<ReliabilityBin> bins = reliability(rows, confidence);
  ASSERT_EQ(bins.size(), 10U);
  EXPECT_EQ(bins[0].rows, 1);
  EXPECT_EQ(bins[1].rows, 2);
  EXPECT_NEAR(bins[1].mean_confidence, 0.15, 1e-12);
  EXPECT_NEAR(bins[1].share_right, 0.5, 1e-12);
  EXPECT_EQ(bins[9].rows, 1);
  EXPECT_NEAR(calibration_error(rows, confidence), (0 + 0.7 + 0) / 4, 1e-12);
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
    rows.back().right = chance.uniform() < confidence_of(rows.back(), some_weights());
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

TEST(Tables, SayHowOftenEachStrictnessIsWrongAndMisses) {
  const auto row = [](const char* truth, bool right, double overlap) {
    Row one;
    one.kind = "pair";
    one.truth = truth;
    one.right = right;
    one.overlap = overlap;
    return one;
  };
  std::vector<Row> rows = {row("same", true, 0.55), row("same", true, 0.6), row("different", false, 0),
                           row("different", false, 0)};
  const std::vector<Strictness> degrees = degrees_of_strictness();
  const double enough_for_eager = (degrees[1].min_confidence + degrees[2].min_confidence) / 2;
  const std::vector<double> confidence = {0.999, 0.3, enough_for_eager, 0.1};
  const std::string table = strictness_table(rows, confidence);
  // cautious and normal merge the first alone; eager the stranger as well.
  EXPECT_NE(table.find("| pair | 4 | 0/4 (0.00 %) | 1/2 (50.00 %) | 0/4 (0.00 %) | 1/2 (50.00 %) | 1/4 (25.00 %) |"),
            std::string::npos)
      << table;
  rows[2].vetoed = true;
  EXPECT_EQ(strictness_table(rows, confidence).find("25.00 %"), std::string::npos);
  EXPECT_NE(overlap_table(rows, confidence).find("| 0.5 .. 0.7 | 2 | 2/2 (100.00 %) | 1/2 (50.00 %) | 0 |"),
            std::string::npos);
}

TEST(Pictures, AreWrittenWholeAndCanBeLookedAt) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "verdict_pictures";
  std::filesystem::create_directories(folder);
  std::vector<Row> rows(20);
  std::vector<double> confidence;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    confidence.push_back(static_cast<double>(i) / 20);
    rows[i].right = i > 8;
  }
  write_pictures({{"toy", rows, confidence}}, folder);
  for (const char* name : {"reliability.png", "roc.png"}) {
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000U) << name;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace gridmerge::verdict_study
