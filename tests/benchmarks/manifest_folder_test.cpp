#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmarks/manifest_samples.hpp"
#include "manifest/folder_conversion.hpp"
#include "manifest/map_folder.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using samples::problem_of;
using samples::test_folder;
using samples::write;
namespace fs = std::filesystem;

/// Four rows of free cells with a wall; the left half of the second map is the right half of the first.
OccupancyGrid strip(int width) {
  OccupancyGrid map = unknown_grid({.width = width, .height = 4, .resolution_m = 1, .map_from_grid = {}});
  std::fill(map.cells.begin(), map.cells.end(), kFree);
  std::fill(map.cells.begin(), map.cells.begin() + width, kOccupied);
  return map;
}

/// Maps a, b and c of 8 m x 4 m: b begins 4 m to the right of a, c lies far away; none is turned but b, by 90 degrees.
fs::path three_maps() {
  fs::path folder = test_folder("maps");
  for (const char* name : {"c", "a", "b"}) {
    write_map(strip(8), folder / (std::string(name) + ".yaml"));
  }
  write(folder / "study.yaml", "methods: [genetic]\n");
  write(folder / "world.csv", "map,x,y,theta\na.yaml,0,0,0\nb.yaml,4,8,-1.5707963267948966\nc.yaml,100,0,0\n");
  return folder;
}

TEST(MapFolder, ListsTheMapsByNameAndPassesOverOtherFiles) {
  const MapFolder folder = read_map_folder(three_maps());
  EXPECT_EQ(folder.name, "maps");
  ASSERT_EQ(folder.maps.size(), 3U);
  EXPECT_EQ(folder.maps[0].name, "a.yaml");
  EXPECT_EQ(folder.maps[2].name, "c.yaml");
  EXPECT_EQ(folder.maps[2].world_from_map, (Pose2{100, 0, 0}));
}

TEST(MapFolder, TellsItsNameWhateverThePathEndsWith) {
  const fs::path folder = three_maps();
  EXPECT_EQ(read_map_folder(folder.string() + "/").name, "maps");
  EXPECT_EQ(read_map_folder(folder / ".").name, "maps");
}

TEST(MapFolder, NamesEveryProblemAtOnce) {
  const fs::path folder = three_maps();
  fs::remove(folder / "a.pgm");
  write(folder / "b.yaml", "image: b.pgm\nresolution: 0\norigin: [0, 0, 0]\n");
  write(folder / "z.yaml", "no mapping\n");
  const std::string problem = problem_of([&] { static_cast<void>(read_map_folder(folder)); });
  EXPECT_THAT(problem, testing::HasSubstr("a.yaml: image: there is no file 'a.pgm'"));
  EXPECT_THAT(problem, testing::HasSubstr("b.yaml:2: resolution"));
  EXPECT_THAT(problem, testing::HasSubstr("z.yaml"));
}

TEST(MapFolder, NamesRowsOfTheWorldThatFitNoMap) {
  const fs::path folder = three_maps();
  write(folder / "world.csv", "map,x,y,theta\nd.yaml,0,0,0\na.yaml,0,0,0\na.yaml,0,0,0\nb.yaml,0,north,0\n");
  const std::string problem = problem_of([&] { static_cast<void>(read_map_folder(folder)); });
  EXPECT_THAT(problem, testing::HasSubstr("world.csv:2: map: there is no map 'd.yaml' in this folder"));
  EXPECT_THAT(problem, testing::HasSubstr("world.csv:4: map: 'a.yaml' has a row already"));
  EXPECT_THAT(problem, testing::HasSubstr("world.csv:5: y: 'north' is not a number"));
}

TEST(MapFolder, RefusesAPlaceWithoutMaps) {
  EXPECT_THAT(problem_of([] { static_cast<void>(read_map_folder("nowhere")); }), "nowhere: is no folder");
  const fs::path empty = test_folder("empty");
  EXPECT_THAT(problem_of([&] { static_cast<void>(read_map_folder(empty)); }),
              testing::EndsWith("empty: holds no map: no YAML file with the key image"));
}

TEST(MapFolder, PairsBearTheTruthThatTheWorldTells) {
  const std::vector<ManifestPair> pairs = pairs_of(read_map_folder(three_maps()));
  ASSERT_EQ(pairs.size(), 3U);
  const ManifestPair& a_b = pairs[0];
  EXPECT_EQ(a_b.target_name + a_b.source_name, "a.yamlb.yaml");
  ASSERT_TRUE(a_b.truth);
  // b covers x 4..8, y 0..8 of the world: half of its cells lie on a.
  EXPECT_DOUBLE_EQ(*a_b.overlap, 0.5);
  EXPECT_EQ(*a_b.source_centre, (Point2{4, 2}));
  const Point2 corner = a_b.truth->target_from_source * Point2{8, 0};
  EXPECT_NEAR(corner.x_m, 4, 1e-9);
  EXPECT_NEAR(corner.y_m, 0, 1e-9);
  EXPECT_EQ(pairs[1].source_name, "c.yaml");
  EXPECT_FALSE(pairs[1].truth);
  EXPECT_TRUE(pairs[1].truth_known);
  EXPECT_EQ(*pairs[1].overlap, 0);
}

TEST(MapFolder, BothOrdersAreInverseToEachOther) {
  const std::vector<ManifestPair> pairs = pairs_of(read_map_folder(three_maps()), {.both_orders = true}, 3);
  ASSERT_EQ(pairs.size(), 6U);
  const ManifestPair& b_a = pairs[2];
  EXPECT_EQ(b_a.target_name + b_a.source_name, "b.yamla.yaml");
  const Pose2 round = pairs[0].truth->target_from_source * b_a.truth->target_from_source;
  EXPECT_NEAR(norm(round.translation()), 0, 1e-9);
}

TEST(MapFolder, AnswersTheSameAtAnyNumberOfThreads) {
  const MapFolder folder = read_map_folder(three_maps());
  EXPECT_EQ(pairs_of(folder, {}, 1), pairs_of(folder, {}, 4));
}

TEST(MapFolder, CallsNoPoseRightWhereTooLittleIsShared) {
  const std::vector<ManifestPair> pairs = pairs_of(read_map_folder(three_maps()), {.least_overlap = 0.6});
  EXPECT_FALSE(pairs[0].truth_known);
  EXPECT_FALSE(pairs[0].truth);
}

TEST(MapFolder, KnowsNoTruthWithoutTheWorld) {
  const fs::path folder = three_maps();
  fs::remove(folder / "world.csv");
  for (const ManifestPair& pair : pairs_of(read_map_folder(folder))) {
    EXPECT_FALSE(pair.truth_known);
    EXPECT_FALSE(pair.overlap);
  }
}

TEST(FolderConversion, WritesMapsAndAManifestThatReadBack) {
  const fs::path folder = three_maps();
  const fs::path out = test_folder("out");
  const Conversion result = convert_folder(folder, out);
  EXPECT_EQ(result.maps, 3U);
  EXPECT_EQ(result.pairs, 3U);
  EXPECT_TRUE(result.left_out.empty());
  EXPECT_EQ(read_map(out / "b.yaml"), read_map(folder / "b.yaml"));
  const std::vector<ManifestPair> pairs = read_manifest(out / "pairs.csv");
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_TRUE(pairs[0].truth);
  EXPECT_EQ(read_map(pairs[0].source_yaml), read_map(folder / "b.yaml"));
}

TEST(FolderConversion, NamesThePairsThatItLeavesOut) {
  const fs::path folder = three_maps();
  fs::remove(folder / "world.csv");
  const fs::path out = test_folder("out");
  const Conversion result = convert_folder(folder, out);
  EXPECT_EQ(result.pairs, 0U);
  EXPECT_FALSE(fs::exists(out / "pairs.csv"));
  ASSERT_EQ(result.left_out.size(), 3U);
  EXPECT_THAT(result.left_out[0], testing::EndsWith("a.yaml, b.yaml: world.csv does not tell both poses"));
}

TEST(FolderConversion, NeverWritesOverWhatItReads) {
  const fs::path folder = three_maps();
  EXPECT_THAT(problem_of([&] { convert_folder(folder, folder / "."); }),
              testing::HasSubstr("is the folder that is read"));
}

}  // namespace
}  // namespace gridmerge
