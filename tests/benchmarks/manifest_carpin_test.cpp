#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/manifest_samples.hpp"
#include "manifest/carpin.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using samples::problem_of;
using samples::test_folder;
using samples::write;
namespace fs = std::filesystem;

std::string parse_problem(const std::string& text, const CarpinOptions& options = {}) {
  return problem_of([&] { static_cast<void>(parse_carpin(text, "m.txt", options)); });
}

TEST(CarpinGrid, HasItsFirstLineAtTheTop) {
  const OccupancyGrid map = parse_carpin("0 127 255 \n255\t255  255\r\n\n", "m.txt");
  EXPECT_EQ(map, text_map({"#?.", "..."}, 0.05));
}

TEST(CarpinGrid, NamesFileLineAndNumberOfEveryProblem) {
  EXPECT_EQ(parse_problem("0 127\n0 128\n0 -1\n0 wall\n"),
            "m.txt:2: number 2: '128' is none of 0 (occupied), 127 (unknown), 255 (free)\n"
            "m.txt:3: number 2: '-1' is none of 0 (occupied), 127 (unknown), 255 (free)\n"
            "m.txt:4: number 2: 'wall' is none of 0 (occupied), 127 (unknown), 255 (free)");
  EXPECT_EQ(parse_problem("0 0 0\n0 0\n"), "m.txt:2: has 2 numbers, the first row has 3");
  EXPECT_EQ(parse_problem("\n \n"), "m.txt: holds no number");
}

TEST(CarpinGrid, StopsTellingAfterTenProblems) {
  std::string text;
  for (int row = 0; row < 1000; ++row) {
    text += "1 1 1\n";
  }
  const std::string problem = parse_problem(text);
  EXPECT_EQ(std::count(problem.begin(), problem.end(), '\n'), 9);
}

TEST(CarpinGrid, TakesOtherNumbersForTheNearestWhereAsked) {
  const CarpinOptions nearest = {.resolution_m = 1, .nearest = true};
  EXPECT_EQ(parse_carpin("0 63 64 190 191 255", "m.txt", nearest), text_map({"##??.."}));
  EXPECT_EQ(parse_problem("256", nearest), "m.txt:1: number 1: '256' is none of 0..255");
}

/// Two grids of 3 m x 2 m and a page of text.
fs::path two_grids() {
  fs::path folder = test_folder("grids");
  write(folder / "robot0.txt", "0 0 0\n255 255 255\n");
  write(folder / "robot1.txt", "255 255 127\n255 127 127\n");
  write(folder / "README.txt", "Please cite.\n");
  return folder;
}

TEST(CarpinConversion, TurnsEveryGridIntoAMap) {
  const fs::path out = test_folder("out");
  const Conversion result = convert_carpin(two_grids(), out, {.resolution_m = 1});
  EXPECT_EQ(result.maps, 2U);
  EXPECT_EQ(result.pairs, 0U);
  EXPECT_THAT(result.left_out, testing::ElementsAre(testing::EndsWith("README.txt: does not begin with a number")));
  EXPECT_EQ(read_map(out / "robot0.yaml"), text_map({"###", "..."}));
  EXPECT_EQ(read_map(out / "robot1.yaml"), text_map({"..?", ".??"}));
  EXPECT_FALSE(fs::exists(out / "pairs.csv"));
}

TEST(CarpinConversion, TurnsASingleFile) {
  const fs::path out = test_folder("out");
  EXPECT_EQ(convert_carpin(two_grids() / "robot1.txt", out).maps, 1U);
  EXPECT_TRUE(fs::exists(out / "robot1.png"));
}

TEST(CarpinConversion, CompletesTheTruthThatLiesBesideTheGrids) {
  const fs::path folder = two_grids();
  write(folder / "pairs.csv",
        "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\n"
        "mine,robot0.yaml,robot1.yaml,same,2,0,0,0.5,2,by-eye\n");
  const fs::path out = test_folder("out");
  EXPECT_EQ(convert_carpin(folder, out, {.resolution_m = 1}).pairs, 1U);
  const std::vector<ManifestPair> pairs = read_manifest(out / "pairs.csv");
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].truth->target_from_source, (Pose2{2, 0, 0}));
  EXPECT_DOUBLE_EQ(*pairs[0].overlap, 0.667);  // two of three known cells lie on robot0's last column
  EXPECT_EQ(*pairs[0].source_centre, (Point2{0.833, 1.167}));
}

TEST(CarpinConversion, WritesNothingWhereAnythingIsWrong) {
  const fs::path folder = two_grids();
  write(folder / "robot2.txt", "0 0\n1 1\n");
  write(folder / "robot3.txt", "0 0\n0\n");
  const fs::path out = test_folder("out");
  const std::string problem = problem_of([&] { convert_carpin(folder, out); });
  EXPECT_THAT(problem, testing::HasSubstr("robot2.txt:2: number 1: '1' is none of"));
  EXPECT_THAT(problem, testing::HasSubstr("robot3.txt:2: has 1 numbers, the first row has 2"));
  EXPECT_TRUE(fs::is_empty(out));
}

TEST(CarpinConversion, NamesTruthThatFitsNoGrid) {
  const fs::path folder = two_grids();
  write(folder / "pairs.csv",
        "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\nmine,robot0.yaml,robot9.yaml,different,,,,,,\n");
  EXPECT_THAT(problem_of([&] { convert_carpin(folder, test_folder("out")); }),
              testing::EndsWith("pairs.csv:2: b: there is no grid for 'robot9.yaml'"));
  EXPECT_THAT(problem_of([&] { convert_carpin("nowhere", test_folder("out")); }),
              "nowhere: is neither a folder nor a file");
}

}  // namespace
}  // namespace gridmerge
