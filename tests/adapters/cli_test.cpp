/// The program as the user meets it: most cases run `gridmerge` as a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/serial_merge.hpp"
#include "cli/shipped_configs.hpp"
#include "cli/watch.hpp"
#include "map_server/map_files.hpp"
#include "methods/register_all.hpp"
#include "support/scenes.hpp"
#include "support/shell.hpp"
#include "support/text_map.hpp"

namespace gridmerge::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// Names of what lies in a folder, sorted.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The answer of --json.
json answer_of(const Ended& ended) { return json::parse(ended.out); }

/// A folder with maps of known truth; it is gone after the tests of a suite.
class Program : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = fs::temp_directory_path() / ("gridmerge_cli_test_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    pair = worlds::make_scene(known_pair("flat"));
    write_map(pair.target, folder / "a.yaml");
    write_map(pair.source, folder / "b.yaml");
    write_map(worlds::make_scene(known_pair("two_flats")).source, folder / "stranger.yaml");
    write_map(text_map({"??", "??"}), folder / "unknown.yaml");
    write_map(text_map({"#"}), folder / "one_cell.yaml");
    write_map(text_map({"....", "....", "...."}), folder / "bare.yaml");
  }
  static void TearDownTestSuite() { fs::remove_all(folder); }

  /// Runs `gridmerge` in the folder; arguments are words of a shell.
  static Ended run(const std::string& arguments) { return shell("'" GRIDMERGE_PROGRAM "' " + arguments); }

  /// The same, with a search that would last a minute, and Ctrl-C after two seconds.
  static Ended interrupted(const std::string& arguments) {
    const auto began = std::chrono::steady_clock::now();
    const Ended result = shell("{ '" GRIDMERGE_PROGRAM "' " + arguments +
                               " --profile paper --set genetic.iterations_per_epoch=1000000 --time-limit 60 & } && "
                               "sleep 2 && kill -INT $! && wait $!");
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(45)) << arguments;
    return result;
  }

  /// Expects a failure that is told on standard error and nowhere else. @return what it says
  static std::string refusal(int status, const std::string& arguments) {
    const std::vector<std::string> before = names_in(folder);
    const Ended result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_THAT(result.err, AllOf(StartsWith("gridmerge: "), EndsWith("\n"))) << arguments;
    EXPECT_EQ(names_in(folder), before) << arguments;
    return result.err;
  }

  static Ended shell(const std::string& command) { return run_in(folder, command); }

  static Pose2 transform_of(const json& answer) {
    const json& t = answer.at("transform");
    return {t.at("x"), t.at("y"), t.at("theta")};
  }

  static inline fs::path folder;
  static inline worlds::MapPair pair;
};

using AlignCommand = Program;
using MergeCommand = Program;
using EvaluateCommand = Program;
using InspectCommand = Program;
using PluginArgument = Program;
using MethodsCommand = Program;
using ConfigCommand = Program;
using CommandLine = Program;
using BadInput = Program;

std::vector<std::string> keys_of(const json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) {
    keys.push_back(key);
  }
  return keys;
}

TEST_F(AlignCommand, AnswersWithOneObjectThatHoldsAllThatIsPromised) {
  const Ended result = run("align a.yaml b.yaml --json --seed 7 --threads 2");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.err, "");
  const json answer = answer_of(result);
  EXPECT_EQ(answer.at("status"), "merged");
  const PoseDifference error = pose_error(pair, transform_of(answer));
  EXPECT_LT(error.distance_m, 0.1);
  EXPECT_LT(degrees(error.angle_rad), 0.5);
  ASSERT_EQ(answer.at("covariance").size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_EQ(answer.at("covariance")[i].size(), 3U);
    EXPECT_GT(answer.at("covariance")[i][i], 0.0);
  }
  EXPECT_GE(answer.at("confidence"), 0.9);
  EXPECT_FALSE(answer.at("reasons").empty());
  EXPECT_EQ(answer.at("hypotheses")[0].at("transform"), answer.at("transform"));
  EXPECT_THAT(keys_of(answer.at("hypotheses")[0]), Contains("covariance"));
  EXPECT_THAT(keys_of(answer.at("figures")),
              AllOf(Contains("evidence_m"), Contains("acceptance_index"), Contains("lead"), Contains("lead_m"),
                    Contains("deviations"), Contains("random_mean_m")));
  EXPECT_EQ(answer.at("method"), "genetic");
  EXPECT_EQ(answer.at("profile"), "default");
  EXPECT_TRUE(answer.at("prior").is_null());
  EXPECT_EQ(answer.at("seed"), 7);
  EXPECT_EQ(answer.at("threads"), 2);
  EXPECT_THAT(keys_of(answer.at("options")),
              AllOf(Contains("genetic"), Contains("pipeline"), Contains("prepare"), Contains("refine"),
                    Contains("evaluator"), Contains("verdict"), Contains("fuse")));
  EXPECT_TRUE(answer.at("options").at("pipeline").at("refine").is_boolean());
  double steps = 0;
  for (const char* step : {"load", "prepare", "propose", "refine", "judge"}) {
    EXPECT_GE(answer.at("seconds").at(step), 0.0) << step;
    steps += std::string(step) == "load" ? 0.0 : answer.at("seconds").at(step).get<double>();
  }
  EXPECT_GE(answer.at("seconds").at("align").get<double>(), 0.99 * steps);
}

TEST_F(AlignCommand, SaysItInWordsWithoutJson) {
  const Ended result = run("align a.yaml b.yaml");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.err, "");  // no terminal, no progress
  EXPECT_THAT(result.out, AllOf(StartsWith("Merged: "), HasSubstr("standard deviation"), HasSubstr("\nWhy\n  - "),
                                HasSubstr("\nTime\n")));
}

TEST_F(AlignCommand, AutoChoosesAndExplainsTheChoice) {
  const Ended told = run("align a.yaml b.yaml --method auto --explain");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out,
              AllOf(HasSubstr("\nChoice of the method\n  - target: straightness"), HasSubstr("prior: none"),
                    HasSubstr("genetic bids"), HasSubstr(" runs: "), HasSubstr("\nTried\n  - "), HasSubstr("choose ")));
  const json answer = answer_of(run("align a.yaml b.yaml --method auto --json --prior 0,0,0,50,180"));
  EXPECT_EQ(answer.at("method"), "auto");
  EXPECT_FALSE(answer.at("attempts").empty());
  EXPECT_THAT(answer.at("choice").dump(), AllOf(HasSubstr("within 50.0 m and 180 deg"), HasSubstr("no limit")));
  EXPECT_THAT(keys_of(answer.at("options")), AllOf(Contains("selector"), Contains("genetic"), Contains("som")));
  EXPECT_GT(answer.at("seconds").at("choose"), 0.0);
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --explain"), HasSubstr("--method auto"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --method auto --profile paper"), HasSubstr("known: default"));
}

TEST_F(AlignCommand, AutoReadsOtherBids) {
  write_text(folder / "bids.yaml",
             "methods: {som: {success: {bias: 3}, log_seconds: {bias: -2}}}\nsecond_chance: {bias: -9}\n");
  const json answer = answer_of(run("align a.yaml b.yaml --method auto --bids bids.yaml --json"));
  ASSERT_EQ(answer.at("attempts").size(), 1U);
  EXPECT_EQ(answer.at("attempts")[0].at("method"), "som");
  write_text(folder / "my.yaml", "method: auto\nbids: bids.yaml\nselector: {at_most: 1}\n");
  EXPECT_EQ(answer_of(run("align a.yaml b.yaml --config my.yaml --json")).at("attempts")[0].at("method"), "som");
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --bids bids.yaml"), HasSubstr("only --method auto reads it"));
  write_text(folder / "my.yaml", "method: genetic\nbids: bids.yaml\n");
  EXPECT_THAT(refusal(1, "align a.yaml b.yaml --config my.yaml"), HasSubstr("my.yaml:2: bids"));
  write_text(folder / "bids.yaml", "methods: {som: {success: {colour: 3}, log_seconds: {bias: -2}}}\n");
  EXPECT_THAT(refusal(1, "align a.yaml b.yaml --method auto --bids bids.yaml"),
              AllOf(HasSubstr("bids.yaml:1: "), HasSubstr("colour")));
  for (const char* name : {"bids.yaml", "my.yaml"}) {
    fs::remove(folder / name);
  }
}

TEST_F(AlignCommand, StrictnessSaysHowSureAMergeMustBe) {
  const json cautious = answer_of(run("align a.yaml b.yaml --strictness cautious --json"));
  EXPECT_EQ(cautious.at("options").at("verdict").at("strictness"), "cautious");
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --strictness reckless"),
              AllOf(HasSubstr("--strictness reckless"), HasSubstr("cautious, normal, eager")));
  EXPECT_EQ(run("align a.yaml b.yaml --set verdict.min_confidence=1").status, 3);
}

TEST_F(CommandLine, FeaturesTellWhatMapsLookLike) {
  const Ended told = run("features a.yaml b.yaml");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(StartsWith("a.yaml\n  straightness"), HasSubstr("\n\nb.yaml\n"),
                              HasSubstr("self_similarity"), HasSubstr(" m2 ")));
  const json all = answer_of(run("features a.yaml unknown.yaml --json"));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].at("map"), "a.yaml");
  EXPECT_GT(all[0].at("occupied_cells"), 100.0);
  EXPECT_EQ(all[1].at("known_area_m2"), 0.0);
  EXPECT_THAT(refusal(1, "features nowhere.yaml"), HasSubstr("nowhere.yaml"));
}

TEST_F(AlignCommand, SwappedMapsGiveTheInversePose) {
  const json there = answer_of(run("align a.yaml b.yaml --json"));
  const json back = answer_of(run("align b.yaml a.yaml --json"));
  EXPECT_EQ(back.at("status"), "merged");
  const PoseDifference apart =
      difference_at(centre_of_known(pair.source), transform_of(there), inverse(transform_of(back)));
  EXPECT_LT(apart.distance_m, 0.05);
  EXPECT_LT(degrees(apart.angle_rad), 0.3);
}

TEST_F(AlignCommand, TheSameSeedGivesTheSameAnswerAtAnyNumberOfThreads) {
  const auto answer = [](const std::string& threads) {
    json all = answer_of(run("align a.yaml b.yaml --json --threads " + threads));
    all.erase("seconds");
    all.erase("threads");
    return all;
  };
  EXPECT_EQ(answer("1"), answer("2"));
}

TEST_F(AlignCommand, DoesNotMergeStrangersAndStillTellsTheBestPose) {
  const Ended result = run("align a.yaml stranger.yaml --json");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(answer_of(result).at("status"), ::testing::AnyOf("no_overlap", "ambiguous"));
  EXPECT_TRUE(answer_of(result).at("transform").is_object());
}

TEST_F(AlignCommand, APriorWithRadiusAndAngleIsAFence) {
  const Pose2 wrong = Pose2{3, 0, 0} * pair.target_from_source;
  std::ostringstream prior;
  prior << wrong.x_m << "," << wrong.y_m << "," << wrong.theta_rad;
  const auto off = [&](const std::string& fence) {
    const Ended result = run("align a.yaml b.yaml --json --prior=" + prior.str() + fence);
    const json answer = answer_of(result);
    EXPECT_NEAR(answer.at("prior").at("x"), wrong.x_m, 1e-3);
    EXPECT_EQ(answer.at("prior").at("radius_m").is_null(), fence.empty());
    EXPECT_TRUE(answer.at("transform").is_object());
    return answer.at("transform").is_object() ? difference_at(centre_of_known(pair.source), transform_of(answer), wrong)
                                              : PoseDifference{};
  };
  constexpr double kRefined_m = 0.1;  // the refinement knows no fence
  EXPECT_LT(off(",1,10").distance_m, 1 + kRefined_m);
  EXPECT_LT(degrees(off(",1,10").angle_rad), 11);
  EXPECT_NEAR(off("").distance_m, 3, kRefined_m) << "without them it is a start";
}

TEST_F(AlignCommand, WritesEveryIterationToTheTraceFile) {
  ASSERT_EQ(run("align a.yaml b.yaml --trace trace.csv").status, 0);
  std::istringstream csv(content_of(folder / "trace.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "alignment,stage,iteration,iterations,best_score,mean_score,x,y,theta,population");
  int lines = 0;
  while (std::getline(csv, line)) {
    EXPECT_THAT(line, StartsWith("1,propose/"));
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 9);
    ++lines;
  }
  EXPECT_GT(lines, 2);

  ASSERT_EQ(run("align a.yaml b.yaml --trace trace.jsonl").status, 0);
  std::istringstream jsonl(content_of(folder / "trace.jsonl"));
  int records = 0;
  while (std::getline(jsonl, line)) {
    const json record = json::parse(line);
    EXPECT_FALSE(record.at("population").empty());
    EXPECT_GE(record.at("best_score"), record.at("mean_score"));
    ++records;
  }
  EXPECT_EQ(records, lines);
  EXPECT_EQ(names_in(folder).size(), 14U);  // no partial file: six maps, two traces
  fs::remove(folder / "trace.csv");
  fs::remove(folder / "trace.jsonl");
}

TEST_F(AlignCommand, CtrlCEndsTheSearchAndTellsTheBestSoFar) {
  const Ended result = interrupted("align a.yaml b.yaml --json");
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_EQ(answer_of(result).at("stopped"), true);
  EXPECT_TRUE(answer_of(result).at("transform").is_object());
}

TEST_F(AlignCommand, ATimeLimitIsKept) {
  const Ended result =
      run("align a.yaml b.yaml --json --profile paper --set genetic.iterations_per_epoch=1000000 --time-limit 0.5");
  EXPECT_EQ(answer_of(result).at("stopped"), true);
  EXPECT_LT(answer_of(result).at("seconds").at("propose"), 20.0);
}

TEST_F(MergeCommand, WritesMapOverlayAndReport) {
  const Ended result = run("merge a.yaml b.yaml -o deep/out --robot 2:1,0.5,0.25");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(StartsWith("Merged 2 of 2 maps."), HasSubstr("Written to deep/out")));
  EXPECT_THAT(names_in(folder / "deep/out"), ElementsAre("merged.pgm", "merged.yaml", "overlay.png", "report.json"));

  const json report = json::parse(content_of(folder / "deep/out/report.json"));
  const json& island = report.at("islands").at(0);
  ASSERT_EQ(island.at("maps").size(), 2U);
  EXPECT_EQ(island.at("maps")[0].at("file"), "a.yaml");
  EXPECT_EQ(island.at("maps")[0].at("pose"), json({{"x", 0.0}, {"y", 0.0}, {"theta", 0.0}}));
  EXPECT_EQ(island.at("image"), "merged.pgm");
  EXPECT_EQ(island.at("maps")[1].at("covariance").size(), 3U);
  EXPECT_TRUE(report.at("left_out").empty());
  EXPECT_EQ(report.at("alignments").size(), 1U);
  EXPECT_GE(report.at("seconds").at("fuse").get<double>(), 0);
  EXPECT_EQ(report.at("alignments")[0].at("status"), "merged");
  const json& b = island.at("maps")[1].at("pose");
  const Pose2 pose{b.at("x"), b.at("y"), b.at("theta")};
  EXPECT_LT(pose_error(pair, pose).distance_m, 0.1);
  const json& robot = island.at("robots").at(0).at("pose");
  EXPECT_NEAR(robot.at("x"), (pose * Point2{1, 0.5}).x_m, 1e-9);
  EXPECT_NEAR(robot.at("theta"), wrap_angle(pose.theta_rad + 0.25), 1e-9);

  const OccupancyGrid merged = read_map(folder / "deep/out/merged.yaml");
  const OccupancyGrid& target = pair.target;
  const auto known = [](const OccupancyGrid& grid) {
    return grid.cells.size() - static_cast<std::size_t>(std::count(grid.cells.begin(), grid.cells.end(), kUnknown));
  };
  EXPECT_GT(known(merged), known(target));
  EXPECT_EQ(merged.geometry.resolution_m, target.geometry.resolution_m);
  EXPECT_THAT(content_of(folder / "deep/out/overlay.png"), StartsWith("\x89PNG"));
  fs::remove_all(folder / "deep");
}

TEST_F(MergeCommand, AnOutlierIsLeftOutWhereverItStands) {
  for (const std::string files :
       {"stranger.yaml a.yaml b.yaml", "a.yaml stranger.yaml b.yaml", "unknown.yaml a.yaml b.yaml one_cell.yaml"}) {
    const Ended result = run("merge " + files + " -o out --json");
    ASSERT_EQ(result.status, 0) << files << result.err;
    const json report = answer_of(result);
    EXPECT_EQ(report, json::parse(content_of(folder / "out/report.json")));
    std::set<std::string> merged;
    std::set<std::string> left_out;
    for (const json& map : report.at("islands").at(0).at("maps")) {
      merged.insert(map.at("file"));
    }
    for (const json& map : report.at("left_out")) {
      left_out.insert(map.at("file"));
      EXPECT_NE(map.at("reason"), "") << files;
    }
    EXPECT_EQ(merged, (std::set<std::string>{"a.yaml", "b.yaml"})) << files;
    EXPECT_EQ(merged.size() + left_out.size(),
              1U + static_cast<std::size_t>(std::count(files.begin(), files.end(), ' ')));
    fs::remove_all(folder / "out");
  }
}

TEST_F(MergeCommand, WritesNothingWhereNothingMerges) {
  const Ended result = run("merge a.yaml stranger.yaml -o new/out");
  EXPECT_EQ(result.status, 3);
  EXPECT_THAT(result.out, AllOf(StartsWith("Not merged: nothing is written."), HasSubstr("stranger.yaml: ")));
  EXPECT_FALSE(fs::exists(folder / "new"));
  const Ended as_json = run("merge a.yaml stranger.yaml -o new/out --json");
  EXPECT_EQ(as_json.status, 3);
  EXPECT_EQ(answer_of(as_json).at("status"), "not_merged");
  EXPECT_EQ(answer_of(as_json).at("written"), false);
  EXPECT_TRUE(answer_of(as_json).at("islands").empty());
  EXPECT_EQ(answer_of(as_json).at("left_out").size(), 2U);
}

TEST_F(MergeCommand, CtrlCLeavesNothingBehind) {
  const Ended result = interrupted("merge a.yaml b.yaml -o out --json");
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_EQ(answer_of(result).at("stopped"), true);
  EXPECT_EQ(answer_of(result).at("written"), false);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(MergeCommand, KeepsAnOlderResultUntilThereIsANewOne) {
  fs::create_directory(folder / "kept");
  write_text(folder / "kept/merged.yaml", "old");
  EXPECT_EQ(run("merge a.yaml stranger.yaml -o kept").status, 3);
  EXPECT_EQ(content_of(folder / "kept/merged.yaml"), "old");
  EXPECT_THAT(names_in(folder / "kept"), ElementsAre("merged.yaml"));
  fs::create_directory(folder / "kept/overlay.png");  // cannot be replaced: nor is the rest
  EXPECT_EQ(run("merge a.yaml b.yaml -o kept").status, 1);
  EXPECT_EQ(content_of(folder / "kept/merged.yaml"), "old");
  fs::remove(folder / "kept/overlay.png");
  EXPECT_EQ(run("merge a.yaml b.yaml -o kept --format png --rule max").status, 0);
  EXPECT_NE(content_of(folder / "kept/merged.yaml"), "old");
  EXPECT_THAT(names_in(folder / "kept"), ElementsAre("merged.png", "merged.yaml", "overlay.png", "report.json"));
  EXPECT_EQ(json::parse(content_of(folder / "kept/report.json")).at("options").at("fuse").at("rule"), "max");
  fs::remove_all(folder / "kept");
}

TEST_F(EvaluateCommand, TellsTheFiguresOfOnePose) {
  std::ostringstream pose;
  pose << pair.target_from_source.x_m << "," << pair.target_from_source.y_m << "," << pair.target_from_source.theta_rad;
  const Ended right = run("evaluate a.yaml b.yaml --json --pose=" + pose.str());
  const Ended wrong = run("evaluate a.yaml b.yaml --json --pose=2,2,2");
  EXPECT_EQ(right.status, 0);
  EXPECT_EQ(wrong.status, 3);
  const json good = answer_of(right).at("figures");
  const json bad = answer_of(wrong).at("figures");
  EXPECT_GT(good.at("evidence_m"), bad.at("evidence_m"));
  EXPECT_GT(good.at("acceptance_index"), bad.at("acceptance_index"));
  EXPECT_LT(std::abs(transform_of(answer_of(right)).x_m - pair.target_from_source.x_m), 1e-3) << "it is not refined";
  const Ended words = run("evaluate a.yaml b.yaml --pose=2,2,2");
  EXPECT_THAT(words.out, AllOf(HasSubstr("Figures\n"), HasSubstr("acceptance_index"), HasSubstr("Why\n")));
  EXPECT_EQ(answer_of(run("evaluate a.yaml unknown.yaml --pose=0,0,0 --json")).at("status"), "declined");
}

TEST_F(InspectCommand, WritesThePicturesAndAPageThatShowsThem) {
  const Ended result = run("inspect genetic a.yaml b.yaml -o deep/out --seed 3 --trace trace.csv");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              AllOf(StartsWith("Merged: "), HasSubstr("Written to deep/out\n  index.html\n  overlay.png: ")));
  const std::string page = content_of(folder / "deep/out/index.html");
  EXPECT_THAT(page, AllOf(StartsWith("<!DOCTYPE html>"), HasSubstr("genetic, profile default"), HasSubstr("a.yaml"),
                          HasSubstr("Merged: "), HasSubstr("m of wall agree"), HasSubstr("Seed 3")));
  const std::vector<std::string> names = names_in(folder / "deep/out");
  EXPECT_THAT(names, AllOf(Contains("overlay.png"), Contains("scores.png"), Contains("index.html")));
  for (const std::string& name : names) {
    if (name != "index.html") {
      EXPECT_THAT(name, EndsWith(".png"));
      EXPECT_THAT(content_of(folder / "deep/out" / name), StartsWith("\x89PNG"));
      EXPECT_THAT(page, HasSubstr("<img src=\"" + name + "\""));
    }
  }
  EXPECT_TRUE(fs::exists(folder / "trace.csv"));
  fs::remove(folder / "trace.csv");
  fs::remove_all(folder / "deep");
}

TEST_F(InspectCommand, FindsWhatAlignFinds) {
  const std::string options =
      " a.yaml b.yaml --seed 5 --profile paper --prior=" + std::to_string(pair.target_from_source.x_m) + "," +
      std::to_string(pair.target_from_source.y_m) + "," + std::to_string(pair.target_from_source.theta_rad) + ",2,20";
  const auto without_time = [](const std::string& text) { return text.substr(0, text.find("\nTime\n")); };
  EXPECT_EQ(without_time(run("inspect genetic -o out" + options).out), without_time(run("align" + options).out));
  fs::remove_all(folder / "out");
}

TEST_F(InspectCommand, WritesThePicturesWhateverTheVerdict) {
  EXPECT_EQ(run("inspect genetic a.yaml stranger.yaml -o out").status, 0);
  EXPECT_THAT(names_in(folder / "out"), Contains("overlay.png"));
  EXPECT_EQ(run("inspect genetic a.yaml unknown.yaml -o nothing").status, 0) << "no pose, no overlay";
  EXPECT_THAT(names_in(folder / "nothing"), ElementsAre("index.html"));
  EXPECT_THAT(content_of(folder / "nothing/index.html"), HasSubstr("Declined: "));
  fs::remove_all(folder / "out");
  fs::remove_all(folder / "nothing");
}

TEST_F(InspectCommand, CtrlCLeavesNothingBehind) {
  const Ended result = interrupted("inspect genetic a.yaml b.yaml -o out");
  EXPECT_EQ(result.status, 3) << result.err;
  EXPECT_THAT(result.out, HasSubstr("no pictures are written"));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(InspectCommand, RefusesWhatItCannotDo) {
  EXPECT_THAT(refusal(2, "inspect magic a.yaml b.yaml -o out"), HasSubstr("magic: is not known; known: genetic"));
  EXPECT_THAT(refusal(2, "inspect genetic a.yaml b.yaml"), HasSubstr("--output"));
  EXPECT_THAT(refusal(1, "inspect genetic nowhere.yaml b.yaml -o a.yaml"), HasSubstr("a.yaml: is not a folder"));
  EXPECT_THAT(refusal(1, "inspect genetic nowhere.yaml b.yaml -o /proc/gridmerge"), HasSubstr("/proc/gridmerge"));
  EXPECT_THAT(refusal(1, "inspect genetic nowhere.yaml b.yaml -o new/out"), HasSubstr("nowhere.yaml"));
}

TEST_F(PluginArgument, AddsAMethodToEveryCommandThatKnowsMethods) {
  const std::string plugin = " --plugin '" GRIDMERGE_CENTROID "'";
  const json methods = answer_of(run("methods --json" + plugin));
  EXPECT_EQ(methods.size(), all_methods().entries().size() + 1);
  EXPECT_EQ(methods.back().at("name"), "centroid");
  EXPECT_THAT(run("methods centroid" + plugin).out, HasSubstr("climb: true"));

  const Ended aligned = run("align a.yaml b.yaml --json --method centroid --set centroid.climb=true" + plugin);
  EXPECT_EQ(aligned.status, 0) << aligned.err;
  EXPECT_EQ(answer_of(aligned).at("method"), "centroid");
  EXPECT_EQ(answer_of(aligned).at("plugins").size(), 1U);
  EXPECT_EQ(answer_of(aligned).at("options").at("centroid").at("climb"), true);
  EXPECT_LT(pose_error(pair, transform_of(answer_of(aligned))).distance_m, 0.1);

  EXPECT_EQ(run("merge a.yaml b.yaml -o out --method centroid" + plugin).status, 0);
  EXPECT_EQ(run("inspect centroid a.yaml b.yaml -o out" + plugin).status, 0);
  EXPECT_THAT(names_in(folder / "out"), AllOf(Contains("merged.yaml"), Contains("target_walls.png")));
  fs::remove_all(folder / "out");
  EXPECT_EQ(run("evaluate a.yaml b.yaml --pose=2,2,2" + plugin).status, 3);

  write_text(folder / "mine.yaml", "method: centroid\ncentroid: {climb: false}\n");
  EXPECT_EQ(run("check-config mine.yaml" + plugin).out, "ok\n");
  EXPECT_THAT(refusal(1, "check-config mine.yaml"), HasSubstr("mine.yaml:1: method = 'centroid' is not known"));
  fs::remove(folder / "mine.yaml");
}

TEST_F(PluginArgument, MayStandInTheConfigurationFileRelativeToIt) {
  fs::create_directories(folder / "deep");
  fs::create_symlink(GRIDMERGE_CENTROID, folder / "deep/mine.so");
  for (const std::string plugins : {"plugins: [mine.so]", "plugins: mine.so", "plugins:\n  - ./mine.so\n  - mine.so"}) {
    write_text(folder / "deep/mine.yaml", plugins + "\nmethod: centroid\n");
    const Ended result = run("config --config deep/mine.yaml");
    ASSERT_EQ(result.status, 0) << plugins << result.err;
    EXPECT_THAT(result.out,
                AllOf(HasSubstr("method: centroid\n"), HasSubstr("plugins:\n  - "), HasSubstr("climb: true")));
    write_text(folder / "whole.yaml", result.out);
    EXPECT_EQ(run("config --config whole.yaml").out, result.out) << "it reads back the same";
    EXPECT_EQ(run("config --config whole.yaml --plugin deep/mine.so").out, result.out) << "named twice, taken once";
  }
  EXPECT_THAT(refusal(1, "config --config deep/mine.yaml --set centroid.magic=1 --plugin nowhere.so"),
              HasSubstr("nowhere.so: does not exist"));
  write_text(folder / "deep/mine.yaml", "plugins: [nowhere.so]\n");
  EXPECT_THAT(refusal(1, "check-config deep/mine.yaml"),
              AllOf(HasSubstr("deep/mine.yaml: plugins: "), HasSubstr("deep/nowhere.so: does not exist")));
  write_text(folder / "deep/mine.yaml", "plugins: {a: b}\n");
  EXPECT_THAT(refusal(1, "check-config deep/mine.yaml"), HasSubstr("'plugins' must have a single value, or a list"));
  fs::remove(folder / "whole.yaml");
  fs::remove_all(folder / "deep");
}

TEST_F(PluginArgument, RefusesWhatIsNoPlugin) {
  EXPECT_THAT(refusal(1, "methods --plugin nowhere.so"), HasSubstr("nowhere.so: does not exist"));
  EXPECT_THAT(refusal(1, "align a.yaml b.yaml --plugin a.yaml"),
              HasSubstr("a.yaml: is not a shared library that can be loaded: "));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --plugin"), HasSubstr("--plugin"));
  EXPECT_THAT(refusal(2, "config --write written --plugin '" GRIDMERGE_CENTROID "'"), HasSubstr("stands alone"));
}

TEST_F(MethodsCommand, ListsEveryMethodWithItsOptions) {
  const json all = answer_of(run("methods --json"));
  const MethodRegistry registry = all_methods();
  ASSERT_EQ(all.size(), registry.entries().size());
  const std::string docs = run("methods --markdown").out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_EQ(all[i].at("name"), registry.entries()[i].name);
    EXPECT_NE(all[i].at("paper"), "");
    for (const json& profile : all[i].at("profiles")) {
      for (const json& option : profile.at("options")) {
        EXPECT_NE(option.at("meaning"), "") << option;
        EXPECT_THAT(docs, HasSubstr("| `" + option.at("key").get<std::string>() + "` |"));
      }
    }
  }
  const Ended one = run("methods genetic");
  EXPECT_EQ(one.status, 0);
  EXPECT_THAT(one.out, AllOf(HasSubstr("paper: "), HasSubstr("population: ")));
  EXPECT_THAT(refusal(2, "methods magic"), HasSubstr("unknown method 'magic'; known methods: genetic"));
}

TEST(ShippedConfigs, AreTheBuiltInDefaults) {
  const std::vector<ShippedConfig> expected = shipped_configs(all_methods());
  std::vector<std::string> shipped = names_in(GRIDMERGE_CONFIGS);
  std::erase_if(shipped, [](const std::string& name) { return !name.ends_with(".yaml"); });
  for (const ShippedConfig& file : expected) {
    EXPECT_THAT(shipped, Contains(file.name));
    EXPECT_EQ(content_of(fs::path(GRIDMERGE_CONFIGS) / file.name), file.text)
        << "write them anew with: gridmerge config --write configs";
  }
}

TEST_F(ConfigCommand, TheLearnedWeightsAreBuiltIn) {
  const std::string defaults = run("config verdict").out;
  EXPECT_EQ(run("config verdict --config '" GRIDMERGE_CONFIGS "/learned/verdict.yaml'").out, defaults);
  EXPECT_THAT(content_of(fs::path(GRIDMERGE_CONFIGS) / "learned" / "verdict.yaml"), HasSubstr("gridmerge_verdict fit"));
}

TEST_F(ConfigCommand, EveryShippedFileLoads) {
  for (const std::string& name : names_in(GRIDMERGE_CONFIGS)) {
    if (name.ends_with(".yaml")) {
      const Ended result = run("check-config '" GRIDMERGE_CONFIGS "/" + name + "'");
      EXPECT_EQ(result.status, 0) << result.err;
      EXPECT_EQ(result.out, "ok\n");
    }
  }
}

TEST_F(ConfigCommand, PrintsWhatReadsBackTheSame) {
  const std::string changed = run("config --set verdict.min_lead=0.33 --seed 5 --profile paper").out;
  EXPECT_THAT(changed, AllOf(HasSubstr("min_lead: 0.33\n"), HasSubstr("seed: 5\n"), HasSubstr("profile: paper\n")));
  write_text(folder / "changed.yaml", changed);
  EXPECT_EQ(run("config --config changed.yaml").out, changed);
  EXPECT_THAT(run("config --config changed.yaml --seed 6 --profile paper").out, HasSubstr("seed: 6\n"))
      << "the command line wins";
  EXPECT_EQ(run("config verdict").out.find("pipeline:"), std::string::npos);
  fs::remove(folder / "changed.yaml");
}

TEST_F(ConfigCommand, WritesTheShippedFiles) {
  EXPECT_EQ(run("config --write written").status, 0);
  EXPECT_EQ(names_in(folder / "written").size(), shipped_configs(all_methods()).size());
  fs::remove_all(folder / "written");
  EXPECT_THAT(refusal(2, "config --write written --seed 3"), HasSubstr("stands alone"));
}

TEST_F(ConfigCommand, CheckConfigTellsEveryProblemWithItsLine) {
  write_text(folder / "bad.yaml",
             "method: genetic\n"
             "threads: many\n"
             "genetic:\n"
             "  population: 3\n"
             "  populaton: 30\n"
             "verdict: {min_lead: 0.1, min_lead: 0.2}\n"
             "judge: {}\n");
  const std::string told = refusal(1, "check-config bad.yaml");
  EXPECT_THAT(
      told,
      AllOf(HasSubstr("bad.yaml:2: threads = 'many' is not a whole number"),
            HasSubstr("bad.yaml:4: population = 3 poses is out of range: 4 .. 100000"),
            HasSubstr("bad.yaml:5: unknown key 'populaton'; known keys: population, "),
            HasSubstr("bad.yaml:6: repeated key 'min_lead'"),
            HasSubstr("bad.yaml:7: unknown key 'judge'; known keys: plugins, method, bids, profile, seed, threads, "
                      "genetic, pipeline, prepare, refine, evaluator, verdict, fuse")));
  write_text(folder / "bad.yaml", "method: magic\n");
  EXPECT_THAT(refusal(1, "check-config bad.yaml"),
              HasSubstr("bad.yaml:1: method = 'magic' is not known; known: genetic"));
  write_text(folder / "bad.yaml", "profile: golden\n");
  EXPECT_THAT(refusal(1, "check-config bad.yaml"), HasSubstr("profile = 'golden' is not known; known: default"));
  write_text(folder / "bad.yaml", "prepare: {free_percent: 70, occupied_percent: 60}\n");
  EXPECT_THAT(refusal(1, "check-config bad.yaml"), HasSubstr("free_percent must lie below occupied_percent"));
  write_text(folder / "bad.yaml", "a: b: c\n");
  EXPECT_THAT(refusal(1, "align a.yaml b.yaml --config bad.yaml"), HasSubstr("bad.yaml:1: is not YAML"));
  fs::remove(folder / "bad.yaml");
  EXPECT_THAT(refusal(1, "check-config bad.yaml"), HasSubstr("bad.yaml: does not exist"));
}

TEST_F(CommandLine, HelpAndVersionAreAnswers) {
  for (const std::string command : {"", "align ", "merge ", "evaluate ", "methods ", "config ", "check-config "}) {
    const Ended help = run(command + "--help");
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_THAT(help.out, AllOf(HasSubstr("Usage: gridmerge"), HasSubstr("Exit status: 0"))) << command;
    EXPECT_EQ(help.err, "") << command;
  }
  EXPECT_THAT(run("--version").out, StartsWith("gridmerge "));
}

TEST_F(CommandLine, WrongUsageIsToldAndEndsWithTwo) {
  EXPECT_THAT(refusal(2, ""), HasSubstr("no command is given; commands: align, merge"));
  EXPECT_THAT(refusal(2, "aling a.yaml b.yaml"), HasSubstr("unknown command 'aling'; commands: align, merge"));
  EXPECT_THAT(refusal(2, "align a.yaml"), HasSubstr("B is required"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml a.yaml"), HasSubstr("not expected"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --metod genetic"), HasSubstr("--metod"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --method magic"), HasSubstr("magic: is not known; known: genetic"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --profile golden"), HasSubstr("golden: is not known; known: default"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --seed two"), HasSubstr("seed = 'two' is not a whole number"));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --seed=-1"), HasSubstr("out of range: 0 .. "));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --threads 1000000"), HasSubstr("out of range: 0 .. "));
  EXPECT_THAT(refusal(2, "align a.yaml b.yaml --trace trace.txt"), HasSubstr(".csv or .jsonl"));
  for (const std::string limit : {"0", "=-1", " nan", " soon", " 1e300"}) {
    EXPECT_THAT(refusal(2, "align a.yaml b.yaml --time-limit" + std::string(limit == "0" ? " " : "") + limit),
                HasSubstr("--time-limit"));
  }
  for (const std::string prior : {"1,2", "1,2,nan", "1,2,inf", "1,2,3,4", "1,2,3,0,5", "1,2,3,1,-5", "1,2,3,1,181",
                                  "1,2,3,", "x,y,z", "1;2;3", "1,2,3,4,5,6"}) {
    EXPECT_THAT(refusal(2, "align a.yaml b.yaml '--prior=" + prior + "'"), HasSubstr("--prior '" + prior)) << prior;
  }
  EXPECT_THAT(refusal(2, "merge a.yaml -o out"), HasSubstr("MAPS: At least 2 required"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml"), HasSubstr("--output is required"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml -o out --format jpg"), HasSubstr("jpg not in"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml -o out --rule mean"), HasSubstr("'mean' is not one of: log_odds"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml a.yaml -o out --prior=1,2,3"), HasSubstr("there are 3 maps"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml -o out --robot 3:0,0,0"), HasSubstr("whole number, 1 .. 2"));
  EXPECT_THAT(refusal(2, "merge a.yaml b.yaml -o out --robot 0,0,0"), HasSubstr("must be N:X,Y,YAW"));
  EXPECT_THAT(refusal(2, "evaluate a.yaml b.yaml"), HasSubstr("--pose is required"));
  EXPECT_THAT(refusal(2, "evaluate a.yaml b.yaml --pose=0,0"), HasSubstr("--pose '0,0': must be X,Y,THETA"));
}

TEST_F(CommandLine, EveryWrongSettingIsToldAtOnce) {
  const std::string told =
      refusal(2,
              "align a.yaml b.yaml --set genetic.populaton=1 --set genetic.population=1 "
              "--set magic.x=1 --set seed=4 --set verdict.min_lead=0.2 --set verdict.min_lead=0.3");
  EXPECT_THAT(told, AllOf(HasSubstr("--set genetic.populaton=1: unknown key 'populaton'; known keys: population, "),
                          HasSubstr("--set genetic.population=1: population = 1 poses is out of range"),
                          HasSubstr("--set magic.x=1: unknown section 'magic'; known sections: genetic, pipeline, "),
                          HasSubstr("--set seed=4: must be SECTION.KEY=VALUE"),
                          HasSubstr("'verdict.min_lead' is given twice")));
  const json answer = answer_of(run("align a.yaml b.yaml --json --set genetic.population=500"));
  EXPECT_EQ(answer.at("options").at("genetic").at("population"), 500);
}

TEST_F(BadInput, WrongMapFilesAreNamedWithTheRuleTheyBreak) {
  const std::string good = content_of(folder / "a.yaml");
  const std::string image = content_of(folder / "a.pgm");
  const auto with = [&](const std::string& key, const std::string& value) {
    std::istringstream lines(good);
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      text += (line.starts_with(key + ":") ? key + ": " + value : line) + "\n";
    }
    return text;
  };
  struct Case {
    std::string yaml;
    std::string told;
  };
  write_text(folder / "cut.pgm", image.substr(0, image.size() / 2));
  write_text(folder / "huge.pgm", "P5\n1000000000 1000000000\n255\n");
  write_text(folder / "words.pgm", "this is no image");
  write_text(folder / "empty.pgm", "");
  for (const Case& one :
       {Case{with("image", "nowhere.pgm"), "nowhere.pgm"}, Case{with("image", "cut.pgm"), "cut.pgm"},
        Case{with("image", "huge.pgm"), "huge.pgm"}, Case{with("image", "words.pgm"), "words.pgm"},
        Case{with("image", "empty.pgm"), "empty.pgm"}, Case{with("resolution", "0"), "resolution"},
        Case{with("resolution", "-.inf"), "resolution"}, Case{with("origin", "[.nan, 0, 0]"), "origin"},
        Case{with("origin", "[0, 0]"), "origin"}, Case{with("mode", "magic"), "mode"}, Case{"just words", "bad.yaml"},
        Case{"a: [1, 2", "bad.yaml"}, Case{"", "image"}, Case{std::string(64, '\0'), "bad.yaml"}}) {
    write_text(folder / "bad.yaml", one.yaml);
    for (const std::string arguments : {"align bad.yaml b.yaml --json", "align a.yaml bad.yaml",
                                        "merge a.yaml bad.yaml -o out", "evaluate a.yaml bad.yaml --pose=0,0,0"}) {
      const std::string told = refusal(1, arguments);
      EXPECT_THAT(told, HasSubstr(one.told)) << one.yaml;
      EXPECT_LT(std::count(told.begin(), told.end(), '\n'), 6) << told;
    }
  }
  for (const char* file : {"cut.pgm", "huge.pgm", "words.pgm", "empty.pgm", "bad.yaml"}) {
    fs::remove(folder / file);
  }
  EXPECT_THAT(refusal(1, "align a.yaml nowhere.yaml"), HasSubstr("nowhere.yaml: does not exist"));
  EXPECT_THAT(refusal(1, "align a.yaml ."), HasSubstr("is a directory"));
  EXPECT_THAT(refusal(1, "align a.yaml a.pgm"), HasSubstr("a.pgm"));
}

TEST_F(BadInput, MapsThatShowNothingAreDeclined) {
  for (const std::string map : {"unknown.yaml", "bare.yaml"}) {
    for (const std::string& files : {"a.yaml " + map, map + " a.yaml", map + " " + map}) {
      const Ended result = run("align --json " + files);
      EXPECT_EQ(result.status, 3) << files << result.err;
      const json answer = answer_of(result);
      EXPECT_EQ(answer.at("status"), "declined") << files;
      EXPECT_TRUE(answer.at("transform").is_null());
      EXPECT_TRUE(answer.at("covariance").is_null());
      EXPECT_TRUE(answer.at("hypotheses").empty());
      EXPECT_FALSE(answer.at("reasons").empty());
      EXPECT_THAT(run("align " + files).out, StartsWith("Declined: "));
    }
  }
  for (const std::string files : {"a.yaml one_cell.yaml", "one_cell.yaml a.yaml", "one_cell.yaml one_cell.yaml"}) {
    const Ended result = run("align --json " + files);
    EXPECT_EQ(result.status, 3) << files << result.err;
    EXPECT_NE(answer_of(result).at("status"), "merged");
  }
}

TEST_F(BadInput, AFolderThatCannotBeWrittenIsToldBeforeTheSearch) {
  EXPECT_THAT(refusal(1, "merge nowhere.yaml b.yaml -o a.yaml"), HasSubstr("a.yaml: is not a folder"));
  EXPECT_THAT(refusal(1, "merge nowhere.yaml b.yaml -o a.yaml/out"), HasSubstr("a.yaml: is not a folder"));
  EXPECT_THAT(refusal(1, "merge nowhere.yaml b.yaml -o /proc/gridmerge"), HasSubstr("/proc/gridmerge"));
  EXPECT_THAT(refusal(1, "merge nowhere.yaml b.yaml -o new/out"), HasSubstr("nowhere.yaml")) << "and made nothing";
  EXPECT_THAT(refusal(1, "align a.yaml b.yaml --trace nowhere/trace.csv"), HasSubstr("nowhere/trace.csv"));
}

TEST_F(BadInput, AFileNameMayHoldAnyByte) {
  fs::copy(folder / "b.yaml", folder / "b\xff'.yaml");
  const Ended result = run("align a.yaml \"b\xff'.yaml\" --json");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(answer_of(result).at("source"), "b\xef\xbf\xbd'.yaml");
  fs::remove(folder / "b\xff'.yaml");
}

/// Columns of a map, in a frame of their own whose origin lies at their lower left.
OccupancyGrid columns_of(const OccupancyGrid& map, int first, int count) {
  GridGeometry geometry = map.geometry;
  geometry.width = count;
  geometry.map_from_grid = {};
  OccupancyGrid cut = unknown_grid(geometry);
  for (int row = 0; row < geometry.height; ++row) {
    for (int column = 0; column < count; ++column) {
      cut.at({column, row}) = map.at({first + column, row});
    }
  }
  return cut;
}

TEST(SerialMerge, GoesRoundAgainOverMapsThatDidNotFitAtFirst) {
  worlds::SceneOptions scene = known_pair("office");
  scene.target_share = 1;
  const OccupancyGrid whole = worlds::make_scene(scene).target;
  const int third = whole.geometry.width / 3;
  const std::vector<OccupancyGrid> maps = {columns_of(whole, 0, third),
                                           columns_of(whole, 2 * third, whole.geometry.width - 2 * third),
                                           columns_of(whole, third / 2, 2 * third)};
  const auto method = all_methods().entries().front().profiles.front().config()->make();
  const OneMethod methods(*method, "");
  const SerialMerge merge = merge_serially({maps, {}, methods, {}, {}}, {.seed = 1, .num_threads = 2, .stop = {}});
  ASSERT_EQ(merge.merged.size(), 3U);
  EXPECT_TRUE(merge.left_out.empty());
  std::vector<std::size_t> tried;
  for (const MergeAttempt& attempt : merge.attempts) {
    tried.push_back(attempt.source);
  }
  EXPECT_THAT(tried, ElementsAre(1, 2, 1));
  EXPECT_THAT(merge.attempts.back().targets, ElementsAre(0, 2));
  for (const MergedMap& one : merge.merged) {
    const int first = one.map == 0 ? 0 : one.map == 1 ? 2 * third : third / 2;
    EXPECT_NEAR(one.merged_from_map.pose.x_m, first * whole.geometry.resolution_m, 0.05);
    EXPECT_NEAR(one.merged_from_map.pose.y_m, 0, 0.05);
    EXPECT_NEAR(one.merged_from_map.pose.theta_rad, 0, radians(0.2));
  }
  // The last one lies on the one before, whose uncertainty it shares.
  const auto spread = [&](std::size_t i) { return merge.merged[i].merged_from_map.covariance->trace(); };
  EXPECT_EQ(spread(0), 0);
  EXPECT_GT(spread(2), merge.attempts.back().alignment.hypotheses.front().target_from_source.covariance->trace());
}

TEST(SerialMerge, StoppedAtOnceSaysSo) {
  const std::vector<OccupancyGrid> maps(3, text_map({"#.#", "..#"}));
  const auto method = all_methods().entries().front().profiles.front().config()->make();
  const StopToken stop;
  stop.cancel();
  const OneMethod methods(*method, "");
  const SerialMerge merge = merge_serially({maps, {}, methods, {}, {}}, {.seed = 1, .num_threads = 1, .stop = stop});
  EXPECT_TRUE(merge.stopped);
  EXPECT_TRUE(merge.merged.empty());
  EXPECT_TRUE(merge.attempts.empty());
  ASSERT_EQ(merge.left_out.size(), 3U);
  EXPECT_EQ(merge.left_out[0].reason, "stopped before it was tried");
}

TEST(ProgressLine, AppearsAfterAWhileAndIsGoneAtTheEnd) {
  std::ostringstream terminal;
  {
    Progress progress(&terminal, Progress::Seconds(0.01), Progress::Seconds(0.01));
    progress.on_stage("prepare");
    IterationRecord record;
    record.stage = "propose/evolve";
    record.iteration = 2;
    record.iterations = 16;
    record.best_score = 12.34;
    progress.on_iteration(record);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  EXPECT_THAT(terminal.str(), AllOf(HasSubstr("propose/evolve 3/16, best 12.3"), EndsWith("\r\x1b[K")));
  EXPECT_THAT(terminal.str(), Not(HasSubstr("\n")));
}

TEST(ProgressLine, SaysNothingOfWhatIsQuicklyDoneAndNothingWithoutATerminal) {
  std::ostringstream terminal;
  { Progress(&terminal).on_stage("prepare"); }
  EXPECT_THAT(terminal.str(), IsEmpty());
  Progress(nullptr).on_stage("prepare");
}

}  // namespace
}  // namespace gridmerge::cli
