#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "manifest/csv_table.hpp"
#include "map_server/map_files.hpp"
#include "methods/register_all.hpp"

namespace gridmerge {

/// A row of a manifest, by the names of its two maps.
struct RealPair {
  std::string folder;
  std::string target;
  std::string source;
  int seeds = 1;
  bool must_merge = false;  ///< so clear that a refusal by the default method would be a fault as well
};

void PrintTo(const RealPair& pair, std::ostream* out) {
  *out << pair.folder << ": " << pair.target << ", " << pair.source;
}

namespace {

std::filesystem::path data() { return GRIDMERGE_SHARED_DATA; }

/// The manifest's row of that pair; none where there is no such row.
std::optional<CsvRow> row_of(const RealPair& pair) {
  for (const CsvRow& row : read_csv(data() / pair.folder / "pairs.csv")) {
    if (row.text("a") == pair.target + ".yaml" && row.text("b") == pair.source + ".yaml") {
      return row;
    }
  }
  return std::nullopt;
}

class RealPairs : public testing::TestWithParam<RealPair> {};

/// Judges one answer by the manifest's row.
void expect_not_wrong(const CsvRow& row, const Alignment& alignment, bool must_merge) {
  const std::string told = testing::PrintToString(alignment.reasons);
  EXPECT_FALSE(alignment.reasons.empty());
  if (row.text("truth") == "different") {
    EXPECT_NE(alignment.outcome, Outcome::kMerged) << told;
    return;
  }
  if (must_merge) {
    EXPECT_EQ(alignment.outcome, Outcome::kMerged) << told;
  }
  if (alignment.outcome == Outcome::kMerged) {
    const PoseDifference error =
        difference_at({row.number("cx"), row.number("cy")}, alignment.hypotheses.front().target_from_source.pose,
                      {row.number("tx"), row.number("ty"), row.number("theta")});
    EXPECT_LE(error.distance_m, row.number("tol_m")) << told;
    EXPECT_LE(degrees(error.angle_rad), row.number("tol_deg")) << told;
  }
}

TEST_P(RealPairs, AreNeverMergedWronglyByAnyMethod) {
  if (!std::filesystem::is_directory(data())) {
    GTEST_SKIP() << "the real maps are not here: " << data();
  }
  const std::optional<CsvRow> row = row_of(GetParam());
  ASSERT_TRUE(row) << "no such row in the manifest";
  const OccupancyGrid target = read_map(data() / GetParam().folder / row->text("a"));
  const OccupancyGrid source = read_map(data() / GetParam().folder / row->text("b"));
  const MethodRegistry registry = all_methods();
  const PreparedMap prepared_target(target, common_resolution_m(target, source, {}), {}, 2);
  const PreparedMap prepared_source(source, common_resolution_m(target, source, {}), {}, 2);
  for (const MethodEntry& entry : registry.entries()) {
    const bool is_default = &entry == &registry.entries().front();
    const std::unique_ptr<Merger> method = entry.profiles.front().config()->make();
    for (int seed = 1; seed <= (is_default ? GetParam().seeds : 1); ++seed) {
      SCOPED_TRACE(entry.name + ", seed " + std::to_string(seed));
      const Alignment alignment =
          align_prepared({.target = prepared_target, .source = prepared_source, .prior = {}}, *method, {},
                         {.seed = static_cast<std::uint64_t>(seed), .num_threads = 2});
      expect_not_wrong(*row, alignment, is_default && GetParam().must_merge);
    }
  }
}

std::vector<RealPair> pairs() {
  const auto lidar = [](const std::string& place, const std::string& pair) {
    return RealPair{
        .folder = "lidar-" + place, .target = "slam_005/" + pair + "_a", .source = "slam_005/" + pair + "_b"};
  };
  const auto thesis = [](const std::string& target, const std::string& source, int seeds, bool must_merge) {
    return RealPair{
        .folder = "thesis-sim", .target = target, .source = source, .seeds = seeds, .must_merge = must_merge};
  };
  return {
      thesis("maze_center_s1_A", "maze_center_s1_B_turned", 3, true),
      thesis("maze_center_hard_s1_A", "maze_center_hard_s1_B_turned", 3, true),
      thesis("maze_opposite_rnd_s1_A", "maze_opposite_rnd_s1_B", 2, true),
      thesis("forest_far_s1_A", "forest_far_s1_B", 3, true),
      thesis("maze_opposite_eq_s2_A", "neg_walls1_B", 2, false),
      thesis("forest_near_s2_A", "neg_forest_other_s12_B", 2, false),
      {.folder = "halmstad-homes", .target = "HIH_01", .source = "HIH_03", .seeds = 1, .must_merge = true},
      {.folder = "halmstad-homes", .target = "KPT4A_01", .source = "KPT4A_02", .seeds = 1, .must_merge = true},
      {.folder = "halmstad-e5", .target = "E5_01", .source = "E5_03", .seeds = 1, .must_merge = true},
      {.folder = "halmstad-e5", .target = "E5_01", .source = "E5_04"},
      {.folder = "halmstad-e5", .target = "E5_07", .source = "HIH_03"},
      lidar("csail", "p03"),
      lidar("csail", "p09"),
      lidar("intel", "p01"),
      lidar("intel", "p10"),
      lidar("freiburg-079", "p05"),
      lidar("orebro", "p06"),
      lidar("csail", "n01"),
      lidar("intel", "n02"),
      lidar("freiburg-079", "n03"),
      lidar("orebro", "n06"),
  };
}

/// The folder and the maps, in the characters that a test's name may have.
std::string pair_name(const testing::TestParamInfo<RealPair>& info) {
  std::string name = info.param.folder + "_" + std::filesystem::path(info.param.target).filename().string() + "_" +
                     std::filesystem::path(info.param.source).filename().string();
  for (char& c : name) {
    c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(SharedData, RealPairs, testing::ValuesIn(pairs()), pair_name);

}  // namespace
}  // namespace gridmerge
