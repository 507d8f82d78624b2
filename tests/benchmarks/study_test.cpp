#include "study/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "gridmerge/base/error.hpp"
#include "map_server/map_files.hpp"
#include "study/plan.hpp"
#include "study/window.hpp"
#include "study_folder.hpp"

namespace gridmerge::study {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Study study_of(const std::string& text) { return parse_study(text, "s.yaml", {}); }

std::string problems_of(const std::string& text) {
  try {
    (void)study_of(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::vector<std::string> names_of(const Study& study) {
  std::vector<std::string> names;
  for (const PairChoice& pair : study.pairs) {
    names.push_back(pair.set + "/" + pair.name);
  }
  return names;
}

const std::string kMinimal = "methods: genetic\ndata: [{scenes: {kind: flat}}]\n";

/// Twelve pairs of three sets, two methods, two windows, two seeds.
const std::string kCrossed =
    "methods: [genetic, som]\n"
    "seeds: [1, 2]\n"
    "windows: [none, {name: near, radius_m: 2, angle_deg: 10, around: truth}]\n"
    "data: [{scenes: {kind: [flat, maze, office], seed: 1..4}}]\n";

TEST(StudyFile, TakesDefaultsForWhatItLeavesOut) {
  const Study study = study_of(kMinimal);
  EXPECT_EQ(study.name, "s");
  EXPECT_THAT(study.seeds, ElementsAre(1));
  ASSERT_EQ(study.methods.size(), 1U);
  EXPECT_EQ(study.methods[0].profile, "default");
  ASSERT_EQ(study.windows.size(), 1U);
  EXPECT_EQ(study.windows[0].around, WindowChoice::Around::kAnywhere);
  EXPECT_THAT(names_of(study), ElementsAre("flat/flat-1"));
  EXPECT_EQ(study.threads, 1);
  EXPECT_FALSE(study.curves);
  EXPECT_EQ(study.text, kMinimal);
}

TEST(StudyFile, UnfoldsListsAndRangesIntoEveryCombination) {
  const Study study = study_of(
      "seeds: [1..3, 7]\n"
      "methods:\n"
      "  - {name: [genetic, som], profiles: [default, paper]}\n"
      "  - {name: genetic, set: {genetic.population: [100, 200], evaluator.tolerance_m: 0.3}}\n"
      "data:\n"
      "  - scenes: {kind: flat, seed: 1..2, drift_m: [0, 0.02]}\n"
      "    name: bent\n"
      "    tolerance: {m: 2}\n"
      "  - swarm: {kind: office}\n"
      "    robots: [2, 4]\n");
  EXPECT_THAT(study.seeds, ElementsAre(1, 2, 3, 7));
  ASSERT_EQ(study.methods.size(), 6U);
  EXPECT_EQ(study.methods[1].profile, "paper");
  EXPECT_EQ(study.methods[2].method, "som");
  EXPECT_THAT(study.methods[5].set, ElementsAre("genetic.population=200", "evaluator.tolerance_m=0.3"));
  EXPECT_THAT(names_of(study), ElementsAre("bent/flat-1 drift_m=0", "bent/flat-1 drift_m=0.02", "bent/flat-2 drift_m=0",
                                           "bent/flat-2 drift_m=0.02", "swarm-office/office-1 robots=2",
                                           "swarm-office/office-1 robots=4"));
  EXPECT_EQ(study.pairs[0].tolerance_m, 2);
  EXPECT_EQ(study.pairs[0].tolerance_deg, 3);
  EXPECT_EQ(std::get<SceneMaps>(study.pairs[3].maps).scene.drift_m, 0.02);
  EXPECT_EQ(std::get<SwarmMaps>(study.pairs[5].maps).robots, 4);
}

TEST(StudyFile, KnowsEveryMethodByTheWordAll) {
  const Study study = study_of("methods: all\ndata: [{scenes: {kind: flat}}]\n");
  EXPECT_EQ(study.methods.size(), methods_of({}).entries().size());
}

/// A manifest of four pairs that nobody reads yet.
std::filesystem::path folder_with_manifest() {
  const std::filesystem::path folder = fresh_folder();
  std::ofstream(folder / "pairs.csv") << "set,a,b,truth,tx,ty,theta,tol_m,tol_deg,tags\n"
                                         "one,a.yaml,b.yaml,same,1,2,0.5,0.4,2,easy\n"
                                         "one,c.yaml,d.yaml,different,,,,,,hard far\n"
                                         "two,e.yaml,f.yaml,same,1,2,0.5,0.4,2,easy\n"
                                         "one,g.yaml,h.yaml,same,1,2,0.5,0.4,2,easy\n";
  return folder;
}

TEST(StudyFile, TakesOfAManifestWhatItIsAskedFor) {
  const std::filesystem::path folder = folder_with_manifest();
  const auto pairs = [&](const std::string& more) {
    return names_of(parse_study("methods: som\ndata: [{manifest: pairs.csv" + more + "}]\n", "s.yaml", folder));
  };
  EXPECT_EQ(pairs("").size(), 4U);
  EXPECT_THAT(pairs(", every: 2"), ElementsAre("one/a.yaml b.yaml", "two/e.yaml f.yaml", "one/g.yaml h.yaml"));
  EXPECT_THAT(pairs(", sets: two, name: mine"), ElementsAre("mine/e.yaml f.yaml"));
  EXPECT_THAT(pairs(", scenarios: [hard]"), ElementsAre("one/c.yaml d.yaml"));
  EXPECT_THAT(problems_of("methods: som\ndata: [{manifest: " + (folder / "pairs.csv").string() + ", sets: three}]\n"),
              HasSubstr("sets: the manifest has no 'three'"));
}

TEST(StudyFile, PairsEachTwoMapsOfAFolder) {
  const std::filesystem::path folder = fresh_folder();
  const OccupancyGrid grid = unknown_grid({.width = 4, .height = 4, .resolution_m = 1, .map_from_grid = {}});
  for (const char* name : {"a.yaml", "b.yaml", "c.yaml"}) {
    write_map(grid, folder / name);
  }
  const Study study = parse_study(
      "methods: som\nwindows: [none, {name: near, share: 0.1, around: truth}]\ndata: [{folder: ., name: mine}]\n",
      "s.yaml", folder);
  EXPECT_THAT(names_of(study), ElementsAre("mine/a.yaml b.yaml", "mine/a.yaml c.yaml", "mine/b.yaml c.yaml"));
  EXPECT_EQ(std::get<FileMaps>(study.pairs[0].maps).truth, "unknown");
  EXPECT_EQ(plan_of(study).size(), 3U) << "there is no window round a truth that nobody knows";
}

TEST(StudyFile, TellsEveryMistakeAtOnceWithItsLine) {
  const std::string problems = problems_of(
      "sedes: 3\n"
      "threads: 0\n"
      "seeds: 4..1\n"
      "methods:\n"
      "  - genetc\n"
      "  - {name: genetic, set: {genetic.populaton: 3}}\n"
      "  - {name: som, profiles: papre}\n"
      "windows: [none, {name: far, share: 0.1, radius_m: 3}]\n"
      "data:\n"
      "  - scenes: {kind: castle}\n"
      "  - scenes: {kind: flat, sed: 1}\n"
      "  - manifest: nowhere.csv\n"
      "  - {scenes: {kind: flat}, folder: maps}\n"
      "  - swarm: {kind: flat}\n");
  for (const char* part : {
           "s.yaml:1: unknown key 'sedes'; known keys: name, about, seeds",
           "s.yaml:2: threads = 0 is out of range: 1 .. 1024",
           "s.yaml:3: seeds: '4..1' must run upwards",
           "s.yaml:5: methods: method genetc: is not known; known: genetic",
           "s.yaml:6: methods: genetic.populaton=3: unknown",
           "s.yaml:7: methods: profile papre: is not known; known: default, paper",
           "s.yaml:8: windows: a window has either 'share'",
           "s.yaml:10: kind = 'castle'",
           "s.yaml:11: unknown",
           "s.yaml:12: nowhere.csv: cannot be read",
           "s.yaml:13: data: an entry must have exactly one of scenes, swarm, manifest, folder",
           "s.yaml:14: swarm: 'robots' must say how many",
       }) {
    EXPECT_THAT(problems, HasSubstr(part));
  }
}

TEST(StudyFile, RefusesWhatWouldGiveTwoRunsOneName) {
  EXPECT_THAT(problems_of("methods: som\ndata: [{scenes: {kind: flat}}, {scenes: {kind: flat, drift_m: 0.1}}]\n"),
              HasSubstr("the set 'flat' has a pair 'flat-1' already; give this entry a 'name' of its own"));
  EXPECT_THAT(problems_of("methods: [som, som]\ndata: [{scenes: {kind: flat}}]\n"),
              HasSubstr("som default is given twice"));
  EXPECT_THAT(problems_of("seeds: [1, 1]\n" + kMinimal), HasSubstr("seeds: 1 is given twice"));
}

TEST(StudyFile, RefusesWhatIsNoStudy) {
  EXPECT_THAT(problems_of("methods: som\n"), HasSubstr("s.yaml: 'data' is missing"));
  EXPECT_THAT(problems_of("data: [{scenes: {kind: flat}}]\n"), HasSubstr("'methods' is missing"));
  EXPECT_THAT(problems_of("a: [b"), HasSubstr("is not YAML"));
  EXPECT_THAT(problems_of("methods: som\ndata: [{scenes: {seed: 1..99999999}}]\n"), HasSubstr("at most"));
  EXPECT_THAT(problems_of("methods: som\ndata: [{scenes: {kind: []}}]\n"), HasSubstr("must not be an empty list"));
  EXPECT_THAT(problems_of("methods: []\ndata: []\n"), AllOf(HasSubstr("methods: must"), HasSubstr("data: must")));
}

TEST(StudyFile, EveryShippedStudyLoads) {
  for (const auto& file : std::filesystem::directory_iterator(GRIDMERGE_CONFIGS "/studies")) {
    if (file.path().extension() == ".yaml") {
      EXPECT_GT(plan_of(read_study(file.path())).size(), 50U) << file.path();
    }
  }
}

TEST(StudyPlan, CrossesPairsWindowsMethodsAndSeeds) {
  const std::vector<PlannedRun> plan = plan_of(study_of(kCrossed));
  ASSERT_EQ(plan.size(), 12U * 2 * 2 * 2);
  EXPECT_EQ(plan, plan_of(study_of(kCrossed)));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    EXPECT_EQ(plan[i].run, static_cast<std::int64_t>(i));
  }
}

TEST(StudyPlan, RunsASwarmOnceWithoutAWindow) {
  const Study study = study_of(
      "methods: som\nwindows: [none, {name: near, share: 0.1}]\n"
      "data: [{swarm: {kind: flat}, robots: 3}, {scenes: {kind: flat}, windows: near}]\n");
  const std::vector<PlannedRun> plan = plan_of(study);
  ASSERT_EQ(plan.size(), 2U);
  EXPECT_EQ(plan[0].window, PlannedRun::kNoWindow);
  EXPECT_EQ(plan[1].window, 1U);
}

TEST(StudyPlan, IsMixedByChanceButFixed) {
  const Study study = study_of(kCrossed);
  const std::vector<PlannedRun> order = order_of(study);
  EXPECT_EQ(order, order_of(study));
  EXPECT_FALSE(std::is_sorted(order.begin(), order.end(),
                              [](const PlannedRun& a, const PlannedRun& b) { return a.run < b.run; }));
}

TEST(StudyPlan, KeepsFewPairsInUseAtATime) {
  const Study study = study_of("methods: [genetic, som]\nseeds: 1..3\ndata: [{scenes: {kind: flat, seed: 1..100}}]\n");
  std::map<std::uint32_t, std::pair<std::size_t, std::size_t>> used;  // first, last
  const std::vector<PlannedRun> order = order_of(study);
  for (std::size_t i = 0; i < order.size(); ++i) {
    used.try_emplace(order[i].pair, i, i).first->second.second = i;
  }
  for (const auto& [pair, span] : used) {
    EXPECT_LT(span.second - span.first, 16U * 6);
  }
}

TEST(StudyPlan, ShardsShareNothingAndTogetherAreAllAndAboutAsLong) {
  const Study study = study_of(kCrossed);
  const std::size_t all = plan_of(study).size();
  for (const int shards : {1, 2, 3, 5, 7, 24, 200}) {
    std::set<std::int64_t> seen;
    std::size_t shortest = all;
    std::size_t longest = 0;
    for (int index = 1; index <= shards; ++index) {
      const std::vector<PlannedRun> part = order_of(study, {index, shards});
      shortest = std::min(shortest, part.size());
      longest = std::max(longest, part.size());
      for (const PlannedRun& run : part) {
        EXPECT_TRUE(seen.insert(run.run).second) << "run " << run.run << " twice in " << shards << " shards";
      }
    }
    EXPECT_EQ(seen.size(), all) << shards;
    EXPECT_LE(longest - shortest, 1U) << shards;
  }
  EXPECT_THROW((void)order_of(study, {3, 2}), std::invalid_argument);
}

TEST(StudyPlan, ShardsHaveEachMethodAsOften) {
  const Study study = study_of(kCrossed);
  for (const int shards : {2, 5}) {
    for (int index = 1; index <= shards; ++index) {
      const std::vector<PlannedRun> part = order_of(study, {index, shards});
      const auto of_first = std::count_if(part.begin(), part.end(), [](const auto& run) { return run.method == 0; });
      EXPECT_NEAR(static_cast<double>(of_first), static_cast<double>(part.size()) / 2, 1);
    }
  }
}

TEST(StudyPlan, AFingerprintChangesWithWhatIsRunAndWithNothingElse) {
  const std::string same = fingerprint_of(parts_of(study_of(kMinimal)));
  EXPECT_EQ(same.size(), 16U);
  EXPECT_EQ(same, fingerprint_of(parts_of(study_of("# a remark\nabout: it\n" + kMinimal))));
  for (const char* more :
       {"seeds: 2\n", "curves: true\n", "threads: 2\n", "tolerance: {m: 1}\n", "windows: [{name: a, share: 0.1}]\n"}) {
    EXPECT_NE(same, fingerprint_of(parts_of(study_of(more + kMinimal)))) << more;
  }
  EXPECT_NE(same, fingerprint_of(parts_of(study_of("methods: genetic\ndata: [{scenes: {kind: maze}}]\n"))));
}

/// Two grids of 20 x 10 cells of 0.5 m, the source's centre at (3, 1).
DrawnPair small_pair() {
  DrawnPair pair;
  OccupancyGrid grid = unknown_grid({.width = 20, .height = 10, .resolution_m = 0.5, .map_from_grid = {}});
  pair.maps = {grid, grid};
  pair.maps[0].geometry.map_from_grid = {-5.25, -2.75, 0};
  pair.truth = "same";
  pair.first_from_map = {{}, {4, -2, 1}};
  pair.centre_in_map = {{0, 0}, {3, 1}};
  return pair;
}

TEST(StudyWindow, AShareIsOfHalfTheTargetsSideAndOfHalfATurn) {
  WindowChoice window = {.name = "w", .around = WindowChoice::Around::kStart, .share = 0.1, .least_deg = 0};
  PosePrior prior = *prior_of(window, {}, small_pair(), 1);
  EXPECT_DOUBLE_EQ(*prior.radius_m, 0.5);
  EXPECT_DOUBLE_EQ(*prior.angle_rad, radians(18));
  EXPECT_EQ(prior.target_from_source, Pose2{});
  window.least_deg = 54;
  EXPECT_DOUBLE_EQ(*prior_of(window, {}, small_pair(), 1)->angle_rad, radians(54));
  window.share = 2;
  EXPECT_DOUBLE_EQ(*prior_of(window, {}, small_pair(), 1)->angle_rad, kPi);
  EXPECT_FALSE(prior_of({}, {}, small_pair(), 1));
}

TEST(StudyWindow, TheMiddleIsWhereHectorSlamStarts) {
  const WindowChoice window = {.name = "w", .around = WindowChoice::Around::kMiddle, .share = 0.1};
  const PosePrior prior = *prior_of(window, {}, small_pair(), 1);
  // The target's middle cell is at its origin; the source's at (5.25, 2.75).
  EXPECT_NEAR(prior.target_from_source.x_m, -5.25, 1e-12);
  EXPECT_NEAR(prior.target_from_source.y_m, -2.75, 1e-12);
}

TEST(StudyWindow, RoundTheTruthItHoldsTheTruthAndDependsOnTheSeedAlone) {
  const WindowChoice window = {.name = "w", .around = WindowChoice::Around::kTruth, .radius_m = 2, .angle_deg = 10};
  const DrawnPair pair = small_pair();
  double farthest_m = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const PosePrior prior = *prior_of(window, {}, pair, seed);
    const PoseDifference off = difference_at(pair.centre_in_map[1], prior.target_from_source, pair.first_from_map[1]);
    EXPECT_LE(off.distance_m, 2 + 1e-9);
    EXPECT_LE(off.angle_rad, radians(10) + 1e-9);
    farthest_m = std::max(farthest_m, off.distance_m);
    EXPECT_EQ(prior.target_from_source, prior_of(window, {}, pair, seed)->target_from_source);
  }
  EXPECT_GT(farthest_m, 1.8);
}

}  // namespace
}  // namespace gridmerge::study
