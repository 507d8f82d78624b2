#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "gridmerge/base/error.hpp"
#include "gridmerge/judge/evaluator.hpp"
#include "map_server/map_files.hpp"
#include "study/compare.hpp"
#include "study/curve.hpp"
#include "study/journal.hpp"
#include "study/rows_csv.hpp"
#include "study/runner.hpp"
#include "study/shards.hpp"
#include "study_folder.hpp"
#include "study_rows.hpp"

namespace gridmerge::study {
namespace {

using testing::HasSubstr;

/// Options of a scene that is quickly drawn and quickly merged.
const std::string kTiny = "resolution_m: 0.2, beam_step_deg: 3, scan_step_m: 1.5, target_share: 0.8, source_share: 0.8";

Study study_of(const std::string& text) { return parse_study(text, "s.yaml", {}); }

Study small_study(const std::string& more = "") {
  return study_of(more +
                  "seeds: 1..2\n"
                  "methods: [{name: hough_spectrum, set: {pipeline.refined_candidates: 2}}]\n"
                  "windows: [none, {name: near, radius_m: 2, angle_deg: 10, around: truth}]\n"
                  "data: [{scenes: {kind: flat, seed: 1..2, " +
                  kTiny + "}}]\n");
}

struct Heard : ProgressSink {
  std::vector<Progress> all;
  StopToken stop;
  std::int64_t stop_at = 1000000;
  void on_progress(const Progress& progress) override {
    all.push_back(progress);
    if (progress.done >= stop_at) {
      stop.cancel();
    }
  }
};

StudyOutcome run(const Study& study, const std::filesystem::path& folder, int jobs = 2, const Shard& shard = {}) {
  Heard heard;
  return run_study(study, {.folder = folder, .shard = shard, .jobs = jobs}, heard);
}

std::vector<std::string> timeless_rows(const std::filesystem::path& folder) {
  std::vector<std::string> rows;
  for (const Row& row : read_journal(folder).rows) {
    rows.push_back(in_words(timeless(row)));
  }
  return rows;
}

TEST(StudyRun, KeepsARowForEveryRunWithAllThatItTakesToRepeatIt) {
  const std::filesystem::path folder = fresh_folder();
  EXPECT_TRUE(run(small_study(), folder).complete());
  const std::vector<Row> rows = read_journal(folder).rows;
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_EQ(read_rows_csv(folder / "rows.csv").size(), 8U);
  const Row& row = rows[2];
  EXPECT_EQ(row.set, "flat");
  EXPECT_EQ(row.pair, "flat-1");
  EXPECT_THAT(row.pair_spec, HasSubstr("{\"scene\":{\"kind\":\"flat\",\"seed\":1,"));
  EXPECT_EQ(row.truth, "same");
  EXPECT_GT(row.overlap, 0.2);
  EXPECT_EQ(row.window, "near");
  EXPECT_NEAR(row.window_m, 2, 1e-12);
  EXPECT_NEAR(row.window_deg, 10, 1e-12);
  EXPECT_EQ(row.method, "hough_spectrum");
  EXPECT_EQ(row.options, "pipeline.refined_candidates=2");
  EXPECT_EQ(row.seed, 1U);
  EXPECT_TRUE(row.pose_right);
  EXPECT_LT(row.error_m, 0.5);
  EXPECT_EQ(row.result, row.status == "merged" ? "right" : "missed");
  EXPECT_FALSE(row.reason.empty());
  EXPECT_FALSE(row.figures.empty());
  EXPECT_GT(row.target_walls, 50);
  EXPECT_GT(row.align_s, 0);
  EXPECT_GT(row.yardstick_s, 0);
  EXPECT_FALSE(row.version.empty());
  EXPECT_FALSE(row.compiler.empty());
  EXPECT_THAT(row.date, testing::MatchesRegex("....-..-..T..:..:..Z"));
  EXPECT_TRUE(std::isnan(rows[0].window_m));
}

TEST(StudyRun, GivesTheSameRowsWithAnyNumberOfJobs) {
  const std::filesystem::path folder = fresh_folder();
  for (const int jobs : {1, 4}) {
    std::filesystem::create_directories(folder / std::to_string(jobs));
    run(small_study(), folder / std::to_string(jobs), jobs);
  }
  EXPECT_EQ(timeless_rows(folder / "1"), timeless_rows(folder / "4"));
}

TEST(StudyRun, GoesOnAfterAStopAndRunsNothingTwice) {
  const std::filesystem::path whole = fresh_folder() / "whole";
  const std::filesystem::path parts = whole.parent_path() / "parts";
  std::filesystem::create_directories(whole);
  std::filesystem::create_directories(parts);
  run(small_study(), whole);
  Heard heard;
  heard.stop_at = 1;
  const StudyOutcome stopped = run_study(small_study(), {.folder = parts, .stop = heard.stop}, heard);
  EXPECT_GE(stopped.made, 1);
  EXPECT_EQ(std::filesystem::exists(parts / "rows.csv"), stopped.complete());
  const StudyOutcome rest = run(small_study(), parts);
  EXPECT_EQ(stopped.made + rest.made, 8);
  EXPECT_TRUE(rest.complete());
  EXPECT_EQ(run(small_study(), parts).made, 0);
  EXPECT_EQ(timeless_rows(whole), timeless_rows(parts));
}

TEST(StudyRun, TellsItsProgressFromBeginToEnd) {
  Heard heard;
  run_study(small_study(), {.folder = fresh_folder()}, heard);
  ASSERT_GE(heard.all.size(), 2U);
  EXPECT_EQ(heard.all.front().done, 0);
  EXPECT_EQ(heard.all.front().of, 8);
  EXPECT_TRUE(std::isnan(heard.all.front().seconds_left));
  EXPECT_EQ(heard.all.back().done, 8);
  EXPECT_EQ(heard.all.back().seconds_left, 0);
}

TEST(StudyRun, ShardsMakeTheRowsOfTheWhole) {
  const std::filesystem::path whole = fresh_folder() / "whole";
  const std::filesystem::path parts = whole.parent_path() / "parts";
  std::filesystem::create_directories(whole);
  std::filesystem::create_directories(parts);
  run(small_study(), whole);
  for (int index = 1; index <= 3; ++index) {
    run(small_study(), parts, 1, {index, 3});
  }
  merge_shards(parts);
  EXPECT_EQ(timeless_rows(whole), timeless_rows(parts));
}

TEST(StudyRun, CountsAMergeOfTwoWorldsAsFalseAndARefusalAsRight) {
  const std::filesystem::path folder = fresh_folder();
  run(study_of("methods: [hough_spectrum, {name: hough_spectrum, set: {verdict.bias: 1000, verdict.min_lead: 0, "
               "verdict.spotless_conflict_share: 0, verdict.max_conflict_share: 1, verdict.min_deviations: 0, "
               "verdict.min_same_side_m: 0, verdict.min_evidence_m: 0}}]\n"
               "data: [{scenes: {kind: flat, relation: two_worlds, " +
               kTiny + "}}]\n"),
      folder);
  const std::vector<Row> rows = read_journal(folder).rows;
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].truth, "different");
  EXPECT_EQ(rows[0].result, "refused");
  EXPECT_EQ(rows[1].result, "false") << rows[1].reason;
  EXPECT_TRUE(std::isnan(rows[1].error_m));
  EXPECT_TRUE(std::isnan(rows[1].truth_x_m));
}

TEST(StudyRun, ReadsThePairsOfAManifest) {
  const std::filesystem::path folder = fresh_folder();
  worlds::SceneOptions scene;
  scene.kind = "flat";
  scene.resolution_m = 0.2;
  const worlds::MapPair pair = worlds::make_scene(scene);
  write_map(pair.target, folder / "a.yaml");
  write_map(pair.source, folder / "b.yaml");
  const Pose2& truth = pair.target_from_source;
  std::ofstream(folder / "pairs.csv") << "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\nmine,a.yaml,b.yaml,same,"
                                      << truth.x_m << "," << truth.y_m << "," << truth.theta_rad << ",0.4,2,easy\n"
                                      << "mine,b.yaml,a.yaml,different,,,,,,easy\n";
  const Study study = parse_study("methods: som\ndata: [{manifest: pairs.csv}]\n", "s.yaml", folder);
  run(study, folder);
  const std::vector<Row> rows = read_journal(folder).rows;
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].set, "mine");
  EXPECT_EQ(rows[0].pair, "a.yaml b.yaml");
  EXPECT_EQ(rows[0].tolerance_m, 0.4);
  EXPECT_NEAR(rows[0].overlap, pair.overlap, 0.01);
  EXPECT_EQ(rows[1].truth, "different");
}

TEST(StudyRun, ARunThatFailsEndsTheStudyAndIsNamed) {
  const std::filesystem::path folder = fresh_folder();
  std::ofstream(folder / "pairs.csv")
      << "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\nmine,a.yaml,b.yaml,different,,,,,,\n";
  const Study study = parse_study("methods: som\ndata: [{manifest: pairs.csv}]\n", "s.yaml", folder);
  try {
    run(study, folder);
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("run 0 (som default on mine/a.yaml b.yaml, window none, seed 1)"));
    EXPECT_THAT(error.what(), HasSubstr("a.yaml"));
  }
}

TEST(StudyRun, KeepsCurvesWhereTheyAreAskedFor) {
  const std::filesystem::path folder = fresh_folder();
  run(study_of("curves: true\n"
               "methods: [{name: genetic, set: {genetic.population: 50, genetic.generations: 6}}]\n"
               "data: [{scenes: {kind: flat, " +
               kTiny + "}}]\n"),
      folder);
  const JournalContent content = read_journal(folder);
  ASSERT_EQ(content.rows.size(), 1U);
  ASSERT_EQ(content.curves.size(), 6U);
  for (std::size_t i = 0; i < content.curves.size(); ++i) {
    EXPECT_EQ(content.curves[i].iteration, static_cast<int>(i));
    EXPECT_GT(content.curves[i].acceptance_index, 0.3);
    EXPECT_GE(content.curves[i].error_m, 0);
  }
}

TEST(StudyRun, TheAcceptanceIndexIsTheEvaluators) {
  worlds::SceneOptions scene;
  scene.kind = "flat";
  scene.resolution_m = 0.2;
  const worlds::MapPair pair = worlds::make_scene(scene);
  const PreparedMap target(pair.target, 0.2);
  const PreparedMap source(pair.source, 0.2);
  const Evaluator evaluator(target, source, {});
  for (const double off_m : {0.0, 0.33, 1.7}) {
    Pose2 pose = pair.target_from_source;
    pose.x_m += off_m;
    pose.theta_rad += off_m;
    EXPECT_NEAR(acceptance_index(target, source, pose), evaluator.figures(pose).acceptance_index, 1e-3);
  }
}

TEST(StudyRun, MergesASwarmIntoOne) {
  const std::filesystem::path folder = fresh_folder();
  run(study_of("methods: som\ntolerance: {m: 1, deg: 5}\n"
               "data: [{swarm: {kind: flat, resolution_m: 0.1, beam_step_deg: 2}, robots: 3}]\n"),
      folder);
  const std::vector<Row> rows = read_journal(folder).rows;
  ASSERT_EQ(rows.size(), 1U);
  const Row& row = rows[0];
  EXPECT_EQ(row.robots, 3);
  EXPECT_EQ(row.window, "none");
  EXPECT_EQ(row.robots_wrong, 0) << row.reason;
  EXPECT_EQ(row.result, row.robots_right == 3 ? "right" : "missed");
  EXPECT_EQ(row.status == "merged", row.robots_right == 3);
  EXPECT_GT(row.align_s, 0);
}

Row timed(const std::string& method, const std::string& pair, const std::string& result, double align_s) {
  Row row;
  row.method = method;
  row.profile = "default";
  row.set = "flat";
  row.pair = pair;
  row.result = result;
  row.align_s = align_s;
  row.yardstick_s = 0.01;
  return row;
}

TEST(StudyComparison, CallsWorseWhatIsRightLessOften) {
  const std::vector<Row> before = {timed("som", "1", "right", 1), timed("som", "2", "right", 1)};
  std::vector<Row> after = before;
  EXPECT_FALSE(compare(before, after).worse());
  after[1].result = "missed";
  const Comparison comparison = compare(before, after);
  EXPECT_TRUE(comparison.worse());
  EXPECT_THAT(to_text(comparison), HasSubstr("WORSE: som default: right fell from 2 to 1"));
  EXPECT_FALSE(compare(after, before).worse());
}

TEST(StudyComparison, CallsWorseWhatIsWrongMoreOften) {
  const std::vector<Row> before = {timed("som", "1", "refused", 1)};
  const std::vector<Row> after = {timed("som", "1", "false", 1)};
  EXPECT_THAT(to_text(compare(before, after)), HasSubstr("WORSE: som default: wrong and false rose from 0 to 1"));
}

TEST(StudyComparison, CallsWorseWhatTakesLongerByTheYardstick) {
  const std::vector<Row> before = {timed("som", "1", "right", 1), timed("genetic", "1", "right", 2)};
  std::vector<Row> after = {timed("som", "1", "right", 1.14), timed("genetic", "1", "right", 2.4)};
  const Comparison comparison = compare(before, after);
  EXPECT_THAT(to_text(comparison), HasSubstr("WORSE: genetic default: time rose by +20.0 %, more than 15 %"));
  EXPECT_THAT(to_text(comparison), testing::Not(HasSubstr("WORSE: som")));
  after[1].yardstick_s = 0.012;  // the machine was slower, too
  EXPECT_FALSE(compare(before, after).worse());
  EXPECT_TRUE(compare(before, after, {.slower = 0.1}).worse());
}

TEST(StudyComparison, TakesTheBestOfSeveralTurnsAndLeavesOutWhatHasNoMatch) {
  const std::vector<Row> before = {timed("som", "1", "right", 1)};
  const std::vector<Row> after = {timed("som", "1", "right", 3), timed("som", "1", "right", 1),
                                  timed("som", "2", "wrong", 9)};
  const Comparison comparison = compare(before, after);
  EXPECT_FALSE(comparison.worse());
  EXPECT_EQ(comparison.runs_after_only, 1);
  EXPECT_EQ(comparison.by_method.at(0).after.runs, 1);
  EXPECT_THAT(to_text(comparison), HasSubstr("Nothing is worse."));
}

}  // namespace
}  // namespace gridmerge::study
