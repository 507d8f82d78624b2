#include "manifest/manifest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

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
  EXPECT_FALSE(pairs[1].truth);
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
