/// `gridmerge simulate`, `convert` and `study` as the user meets them: most cases run the program as a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands/pair_again.hpp"
#include "manifest/manifest.hpp"
#include "map_server/map_files.hpp"
#include "study/journal.hpp"
#include "study/rows_csv.hpp"
#include "support/shell.hpp"

namespace gridmerge::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;
using ::testing::StrCaseEq;

/// Runs words of a shell in the folder of the test, with the program on the path.
class Commands : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("Commands.") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write_text(folder_ / "tiny.yaml", kTiny);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] Ended shell(const std::string& words) const {
    return run_in(folder_, "PATH='" + fs::path(GRIDMERGE_PROGRAM).parent_path().string() + "':$PATH; " + words);
  }
  [[nodiscard]] std::vector<study::Row> rows(const std::string& study_folder) const {
    return study::read_rows_csv(folder_ / study_folder / "rows.csv");
  }

  static constexpr const char* kTiny =
      "name: tiny\n"
      "about: Small enough for a test.\n"
      "seeds: 1\n"
      "methods: [hough_spectrum, {name: genetic, set: {genetic.population: 100}}]\n"
      "windows: [none, {name: near, radius_m: 2, angle_deg: 10, around: truth}]\n"
      "data:\n"
      "  - scenes: {kind: flat, seed: 1..2, resolution_m: 0.1}\n"
      "  - scenes: {kind: flat, seed: 3, resolution_m: 0.1, relation: two_worlds}\n"
      "    windows: none\n"
      "tolerance: {m: 0.5, deg: 3}\n";
  fs::path folder_;
};

TEST_F(Commands, SimulateDrawsAPairWithItsTruth) {
  const Ended ended = shell("gridmerge simulate --kind flat --seed 2 --resolution_m 0.1 -o maps");
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto truth = nlohmann::json::parse(content_of(folder_ / "maps/truth.json"));
  const std::vector<ManifestPair> pairs = read_manifest(folder_ / "maps/pairs.csv");
  ASSERT_THAT(pairs, SizeIs(1));
  ASSERT_TRUE(pairs[0].truth);
  EXPECT_DOUBLE_EQ(truth["target_from_source"]["x"], pairs[0].truth->target_from_source.x_m);
  EXPECT_EQ(read_map(pairs[0].source_yaml).geometry.resolution_m, 0.1);
}

TEST_F(Commands, SimulateDrawsManyPairsEachFromItsOwnSeed) {
  ASSERT_EQ(shell("gridmerge simulate --kind flat --seed 4 --pairs 3 --resolution_m 0.2 -o many").status, 0);
  ASSERT_EQ(shell("gridmerge simulate --kind flat --seed 5 --resolution_m 0.2 -o one").status, 0);
  EXPECT_THAT(read_manifest(folder_ / "many/pairs.csv"), SizeIs(3));
  EXPECT_EQ(content_of(folder_ / "many/flat-5/a.pgm"), content_of(folder_ / "one/a.pgm"));
}

TEST_F(Commands, SimulateSaysWhenNothingIsShared) {
  const Ended ended = shell("gridmerge simulate --kind flat --relation two_worlds --resolution_m 0.2 -o maps");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("nothing in common"));
  EXPECT_FALSE(read_manifest(folder_ / "maps/pairs.csv").at(0).truth);
}

TEST_F(Commands, SimulateDrawsASwarmThatConvertTurnsIntoPairs) {
  ASSERT_EQ(shell("gridmerge simulate --kind office --robots 3 --resolution_m 0.2 -o swarm").status, 0);
  const Ended ended = shell("gridmerge convert folder swarm -o pairs");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("3 maps"));
  EXPECT_TRUE(fs::exists(folder_ / "pairs/pairs.csv"));
}

TEST_F(Commands, SimulateRefusesWhatIsOutOfRange) {
  const Ended ended = shell("gridmerge simulate --kind castle --range_m -1 -o maps");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("castle"), HasSubstr("range_m")));
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_FALSE(fs::exists(folder_ / "maps"));
}

TEST_F(Commands, ConvertReadsCarpinsGrids) {
  fs::create_directories(folder_ / "in");
  write_text(folder_ / "in/robot0.txt", "0 0 0\n0 255 127\n0 255 127\n");
  const Ended ended = shell("gridmerge convert carpin in -o out");
  ASSERT_EQ(ended.status, 0) << ended.err;
  const OccupancyGrid map = read_map(folder_ / "out/robot0.yaml");
  EXPECT_EQ(map.at({0, 0}), kOccupied);
  EXPECT_EQ(map.at({1, 0}), kFree);
  EXPECT_EQ(map.at({2, 0}), kUnknown);
}

TEST_F(Commands, ConvertNamesTheFileThatIsWrong) {
  const Ended ended = shell("gridmerge convert halmstad nowhere -o out");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(StartsWith("gridmerge: "), HasSubstr("nowhere")));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Commands, StudyGivesRowsAndAPage) {
  const Ended ended = shell("gridmerge study tiny.yaml -o out");
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("10 of 10 runs done"));
  EXPECT_THAT(rows("out"), SizeIs(10));
  const std::string page = content_of(folder_ / "out/report.html");
  EXPECT_THAT(page.substr(0, 15), StrCaseEq("<!doctype html>"));
  EXPECT_NE(page.find("Small enough for a test."), std::string::npos);
}

TEST_F(Commands, StudyGoesOnFromWhatThereIs) {
  ASSERT_EQ(shell("gridmerge study tiny.yaml -o out").status, 0);
  const std::string before = content_of(folder_ / "out/rows.csv");
  const Ended again = shell("gridmerge study tiny.yaml -o out");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("10 from before"));
  EXPECT_EQ(content_of(folder_ / "out/rows.csv"), before);
}

TEST_F(Commands, StudyInPartsIsTheStudy) {
  ASSERT_EQ(shell("gridmerge study tiny.yaml -o whole").status, 0);
  const Ended part = shell("gridmerge study tiny.yaml -o parts --shard 1/2");
  EXPECT_THAT(part.out, HasSubstr("gridmerge study merge"));
  EXPECT_EQ(shell("gridmerge study merge parts").status, 1);  // the other part is not there yet
  ASSERT_EQ(shell("gridmerge study tiny.yaml -o parts --shard 2/2").status, 0);
  ASSERT_EQ(shell("gridmerge study merge parts").status, 0);
  const std::vector<study::Row> whole = rows("whole");
  const std::vector<study::Row> parts = rows("parts");
  ASSERT_EQ(parts.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(parts[i].run, whole[i].run);
    EXPECT_EQ(parts[i].result, whole[i].result);
    EXPECT_EQ(parts[i].x_m, whole[i].x_m);
  }
  EXPECT_TRUE(fs::exists(folder_ / "parts/report.html"));
}

TEST_F(Commands, ARowsCommandRepeatsIt) {
  ASSERT_EQ(shell("gridmerge study tiny.yaml -o out").status, 0);
  for (const study::Row& row : rows("out")) {
    const Ended ended = shell(command_again(row) + " --json | tail -n +1");
    const std::size_t begin = ended.out.find("{\n");
    ASSERT_NE(begin, std::string::npos) << command_again(row) << "\n" << ended.err;
    const auto answer = nlohmann::json::parse(ended.out.substr(begin));
    EXPECT_EQ(answer["status"], row.status) << command_again(row);
    EXPECT_DOUBLE_EQ(answer["transform"]["x"], row.x_m) << command_again(row);
    EXPECT_DOUBLE_EQ(answer["transform"]["theta"], row.theta_rad) << command_again(row);
  }
}

TEST_F(Commands, ARowsMapsAreDrawnAgain) {
  ASSERT_EQ(
      shell("gridmerge study tiny.yaml -o out && gridmerge simulate --kind flat --seed 1 --resolution_m 0.1 -o maps")
          .status,
      0);
  const page::PairMaps maps = maps_again(rows("out").front());
  EXPECT_EQ(maps.target.cells, read_map(folder_ / "maps/a.yaml").cells);
  EXPECT_EQ(maps.source.cells, read_map(folder_ / "maps/b.yaml").cells);
  EXPECT_TRUE(maps.tracks);
}

TEST_F(Commands, AComparisonWithItselfIsNoWorse) {
  ASSERT_EQ(shell("gridmerge study tiny.yaml -o out").status, 0);
  const Ended same = shell("gridmerge study compare --before out/rows.csv --after out/rows.csv");
  EXPECT_EQ(same.status, 0) << same.out;

  std::vector<study::Row> worse = rows("out");
  for (study::Row& row : worse) {
    row.result = row.result == "right" ? "missed" : row.result;
  }
  write_text(folder_ / "worse.csv", study::to_csv(worse));
  EXPECT_EQ(shell("gridmerge study compare --before out/rows.csv --after worse.csv").status, 3);
}

TEST_F(Commands, StudyNamesEveryMistake) {
  write_text(folder_ / "wrong.yaml",
             "name: wrong\nmethods: [genetics]\ndata:\n  - scenes: {kind: castle}\nwibble: 1\n");
  const Ended ended = shell("gridmerge study wrong.yaml -o out");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("wrong.yaml:2"), HasSubstr("genetics"), HasSubstr("wrong.yaml:4"),
                               HasSubstr("castle"), HasSubstr("wrong.yaml:5"), HasSubstr("wibble")));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Commands, StudyWithoutAFileSaysWhatItNeeds) {
  const Ended ended = shell("gridmerge study");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("needs FILE"));
  EXPECT_EQ(shell("gridmerge study tiny.yaml -o out --shard 3/2").status, 2);
}

TEST(CommandAgain, GivesTheShellOneWordForOne) {
  study::Row row;
  row.pair_spec = R"({"target": "my maps/a.yaml", "source": "it's.yaml"})";
  row.method = "genetic";
  row.profile = "paper";
  row.options = "genetic.population=100 verdict.min_lead=0.2";
  row.window_m = 5;
  row.window_deg = 20;
  row.prior_x_m = 1.5;
  row.prior_y_m = -2;
  row.prior_theta_rad = 0.25;
  EXPECT_EQ(command_again(row),
            "gridmerge align 'my maps/a.yaml' 'it'\\''s.yaml' --method genetic --profile paper --set "
            "genetic.population=100 --set verdict.min_lead=0.2 --prior 1.5,-2,0.25,5,20 --seed 1 --threads 1");
}

}  // namespace
}  // namespace gridmerge::cli
