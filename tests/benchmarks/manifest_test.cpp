#include "manifest/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

std::filesystem::path manifest_of(const std::string& text) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + ".csv");
  std::ofstream(file) << text;
  return file;
}

std::string problem_of(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_manifest(file));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Manifest, ReadsPairsByTheNamesOfTheColumns) {
  const std::filesystem::path file = manifest_of(
      "tags,set,a,b,truth,tx,ty,theta,tol_m,tol_deg,more\r\n"
      "hard bent,flat,x/a.yaml,b.yaml,same,1.5,-2,0.25,0.5,3,0\r\n"
      "\n"
      ",flat,a.yaml,b.yaml,different,,,,,\n");
  const std::vector<ManifestPair> pairs = read_manifest(file);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].set, "flat");
  EXPECT_EQ(pairs[0].target_name, "x/a.yaml");
  EXPECT_EQ(pairs[0].target_yaml, file.parent_path() / "x/a.yaml");
  EXPECT_EQ(pairs[0].scenario, "hard");
  ASSERT_TRUE(pairs[0].truth);
  EXPECT_EQ(pairs[0].truth->target_from_source, (Pose2{1.5, -2, 0.25}));
  EXPECT_EQ(pairs[0].truth->tolerance_rad, radians(3));
  EXPECT_EQ(pairs[0].tags, "hard bent");
  EXPECT_FALSE(pairs[0].source_centre);
  EXPECT_FALSE(pairs[0].overlap);
  EXPECT_FALSE(pairs[1].truth);
  EXPECT_TRUE(pairs[1].truth_known);
}

/// Two pairs with every field filled, of maps in that folder.
std::vector<ManifestPair> two_pairs(const std::filesystem::path& folder) {
  ManifestPair same = {
      .set = "flat",
      .target_name = "x/a.yaml",
      .source_name = "b.yaml",
      .target_yaml = folder / "x/a.yaml",
      .source_yaml = folder / "b.yaml",
      .truth =
          KnownPose{.target_from_source = {1.0 / 3, -2e-7, 0.25}, .tolerance_m = 0.5, .tolerance_rad = radians(1.5)},
      .scenario = "hard",
      .tags = "hard bent",
      .source_centre = Point2{-3.125, 8},
      .overlap = 0.863};
  ManifestPair different = same;
  different.truth.reset();
  different.overlap.reset();
  different.scenario = different.tags = "other-building";
  return {same, different};
}

TEST(Manifest, ReadsBackEqualWhatItWrote) {
  const std::filesystem::path file = manifest_of("");
  const std::vector<ManifestPair> pairs = two_pairs(file.parent_path());
  write_manifest(file, pairs);
  EXPECT_EQ(read_manifest(file), pairs);
}

TEST(Manifest, WritesTheRefereesColumns) {
  const std::string text = manifest_text("p.csv", two_pairs(""));
  EXPECT_EQ(text,
            "set,a,b,truth,tx,ty,theta,cx,cy,tol_m,tol_deg,overlap,tags\n"
            "flat,x/a.yaml,b.yaml,same,0.3333333333333333,-2e-07,0.25,-3.125,8,0.5,1.5,0.863,hard bent\n"
            "flat,x/a.yaml,b.yaml,different,,,,-3.125,8,,,,other-building\n");
}

TEST(Manifest, LeavesTheFileAsItWasWhereACellCannotBeWritten) {
  const std::filesystem::path file = manifest_of("as it was");
  std::vector<ManifestPair> pairs = two_pairs(file.parent_path());
  pairs[1].source_name = "a, b.yaml";
  try {
    write_manifest(file, pairs);
    FAIL() << "a comma was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::EndsWith(".csv:3: b: 'a, b.yaml' holds a comma, a quote or the end of a line"));
  }
  std::string text;
  std::getline(std::ifstream(file), text);
  EXPECT_EQ(text, "as it was");
}

TEST(Manifest, RefusesToWriteWhatNobodyKnows) {
  std::vector<ManifestPair> unknown = two_pairs("");
  unknown[1].truth_known = false;
  EXPECT_THROW(static_cast<void>(manifest_text("p.csv", unknown)), std::invalid_argument);
  std::vector<ManifestPair> without_centre = two_pairs("");
  without_centre[0].source_centre.reset();
  EXPECT_THROW(static_cast<void>(manifest_text("p.csv", without_centre)), std::invalid_argument);
}

TEST(Manifest, NamesFileLineAndColumnOfAProblem) {
  const std::string heading = "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\n";
  EXPECT_THAT(problem_of(manifest_of(heading + "s,a,b,same,1,2,east,1,1,\n")),
              testing::EndsWith(".csv:2: theta: 'east' is not a number"));
  EXPECT_THAT(problem_of(manifest_of(heading + "s,a,b,perhaps,,,,,,\n")),
              testing::EndsWith(".csv:2: truth: 'perhaps' is neither same nor different"));
  EXPECT_THAT(problem_of(manifest_of("set,a,b\ns,a,b\n")), testing::EndsWith(".csv:2: there is no column tags"));
  EXPECT_THAT(problem_of("nowhere.csv"), testing::EndsWith("nowhere.csv: cannot be read"));
}

}  // namespace
}  // namespace gridmerge
