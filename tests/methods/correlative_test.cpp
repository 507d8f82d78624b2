#include "methods/correlative/correlative.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "gridmerge/align/pipeline.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

using testing::HasSubstr;

/// Every pose of the lattice, one after the other.
struct BruteForce {
  LatticePose best;
  std::int64_t best_score = 0;
  double poses = 0;

  explicit BruteForce(const PoseLattice& lattice) {
    const MapLevel& level = lattice.fixed_level();
    const int reach = lattice.reach();
    for (int angle = 0; angle < lattice.angles(); ++angle) {
      const TurnedMap turned = lattice.turned(angle / lattice.turns());
      for (int column = -reach; column < level.width + reach; ++column) {
        for (int row = -reach; row < level.height + reach; ++row) {
          ++poses;
          const LatticePose at{angle, column, row};
          if (!lattice.holds(at)) {
            continue;
          }
          const std::int64_t score = lattice.score(at, turned);
          if (score > best_score) {
            best = at;
            best_score = score;
          }
        }
      }
    }
  }
};

LatticeOptions small_lattice(bool both_ways = true) {
  return {.angle_step_rad = radians(15), .finest_level = 1, .both_ways = both_ways};
}

TEST(SearchLattice, FindsWhatBruteForceFinds) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const PreparedMap fixed = posts_and_walls(seed, 60, 44);
    const PreparedMap moving = posts_and_walls(seed + 50, 30 + 4 * static_cast<int>(seed), 40);
    const PoseWindow window{.centre = {0.6, -0.4, 2}, .radius_m = 0.8, .angle_rad = 0.7};
    for (const bool both_ways : {true, false}) {
      for (const std::optional<PoseWindow>& within : {std::optional<PoseWindow>(), {window}}) {
        const PoseLattice lattice(fixed, moving, within, small_lattice(both_ways));
        const BruteForce expected(lattice);
        const LatticeProof proof = search_lattice(lattice, 5, {.num_threads = 2});
        if (expected.best_score == 0) {
          EXPECT_EQ(proof.best_score, 0);
          continue;
        }
        ++compared;
        EXPECT_EQ(proof.best_score, expected.best_score) << "seed " << seed;
        EXPECT_EQ(proof.best, expected.best) << "seed " << seed;
        EXPECT_EQ(proof.poses, expected.poses);
        EXPECT_GE(proof.added_up, 1);
        EXPECT_FALSE(proof.stopped);
      }
    }
  }
  EXPECT_GE(compared, 20);
}

TEST(SearchLattice, TakesTheFirstOfPosesThatScoreAlike) {
  // A cross fits itself at four angles, equally well to the last digit.
  OccupancyGrid grid = unknown_grid({.width = 41, .height = 41, .resolution_m = 0.05, .map_from_grid = {}});
  std::fill(grid.cells.begin(), grid.cells.end(), kFree);
  for (int i = 8; i < 33; ++i) {
    grid.at({i, 20}) = kOccupied;
    grid.at({20, i}) = kOccupied;
  }
  const PreparedMap cross(grid, 0.05);
  const PoseLattice lattice(cross, cross, std::nullopt, small_lattice());
  const LatticeProof proof = search_lattice(lattice, 5, {});
  const BruteForce expected(lattice);
  EXPECT_EQ(proof.best, expected.best);
  EXPECT_EQ(proof.best_score, expected.best_score);
  EXPECT_GE(proof.added_up, 2);  // the transforms could not tell them apart
}

TEST(SearchLattice, LeavesNoPeakOutThatScoresAboveItsBound) {
  const PreparedMap fixed = posts_and_walls(11, 90, 80);
  const PreparedMap moving = posts_and_walls(12, 70, 60);
  const PoseLattice lattice(fixed, moving, std::nullopt, small_lattice());
  const LatticeProof few = search_lattice(lattice, 2, {});
  const LatticeProof all = search_lattice(lattice, 1000000, {});
  EXPECT_EQ(all.left_out_below, 0);
  ASSERT_GT(few.left_out_below, 0);
  ASSERT_GT(all.peaks.size(), few.peaks.size());
  for (const LatticePeak& peak : all.peaks) {
    const bool listed =
        std::any_of(few.peaks.begin(), few.peaks.end(), [&](const LatticePeak& other) { return other.at == peak.at; });
    if (!listed) {
      EXPECT_LE(static_cast<double>(peak.score), few.left_out_below);
    }
  }
}

TEST(Correlative, SaysWhatItHasProved) {
  const worlds::MapPair pair = worlds::make_scene(known_pair("flat", 1));
  const Alignment alignment =
      align({.target = pair.target, .source = pair.source, .prior = {}}, CorrelativeMerger({}), {}, {});
  EXPECT_EQ(alignment.outcome, Outcome::kMerged);
  ASSERT_EQ(alignment.remarks.size(), 1U);
  EXPECT_THAT(alignment.remarks.front(), HasSubstr("180 angles, 2.00 deg apart, and cells of 0.20 m"));
  EXPECT_THAT(alignment.remarks.front(), HasSubstr("none scores above"));
  EXPECT_THAT(alignment.remarks.front(), HasSubstr("of its other peaks, 0.6 m or 4 deg away, none scores above"));
  EXPECT_THAT(alignment.remarks.front(), HasSubstr("whole numbers"));
}

TEST(Correlative, ProvesNothingWhereItIsStopped) {
  const worlds::MapPair pair = worlds::make_scene(known_pair("flat", 1));
  const StopToken stop;
  stop.cancel();
  const Alignment alignment =
      align({.target = pair.target, .source = pair.source, .prior = {}}, CorrelativeMerger({}), {}, {.stop = stop});
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  EXPECT_TRUE(alignment.remarks.empty());
}

/// Keeps what a method shows.
class Views final : public TraceSink {
 public:
  [[nodiscard]] bool wants_views() const override { return true; }
  void on_view(const View& view) override { views.push_back(view); }
  std::vector<View> views;
};

TEST(Correlative, ShowsASurfaceThatPeaksAtItsBestPose) {
  // The source larger than the target as well: then it is the target that is turned.
  for (const bool larger_source : {false, true}) {
    const PreparedMap large = posts_and_walls(21, 120, 100);
    const PreparedMap small = posts_and_walls(21, 60, 50);
    const PreparedMap& target = larger_source ? small : large;
    const PreparedMap& source = larger_source ? large : small;
    Views watch;
    CorrelativeOptions options;
    options.climb = false;
    const Proposal watched =
        CorrelativeMerger(options).propose({.target = target, .source = source, .prior = {}}, {.trace = &watch});
    ASSERT_EQ(watch.views.size(), 4U);
    EXPECT_EQ(watch.views[0].name, "best_angle");
    const auto& surface = std::get<SurfaceView>(watch.views[0].content);
    ASSERT_EQ(surface.values.size(),
              static_cast<std::size_t>(surface.width) * static_cast<std::size_t>(surface.height));
    const auto top = std::max_element(surface.values.begin(), surface.values.end()) - surface.values.begin();
    ASSERT_EQ(surface.marks.size(), 1U);
    const double cell = (surface.x_high - surface.x_low) / surface.width;
    EXPECT_NEAR(surface.marks[0].x_m, surface.x_low + (static_cast<double>(top % surface.width) + 0.5) * cell, 1e-6);
    EXPECT_NEAR(surface.marks[0].y_m, surface.y_low + (static_cast<double>(top / surface.width) + 0.5) * cell, 1e-6);
    EXPECT_NEAR(static_cast<double>(*std::max_element(surface.values.begin(), surface.values.end())),
                watched.candidates.front().method_score, 1e-3);
    const auto& places = std::get<MapView>(watch.views[3].content);
    EXPECT_EQ(from_local(places.local_target_from_source, target, source),
              watched.candidates.front().target_from_source);
    const Proposal alone = CorrelativeMerger(options).propose({.target = target, .source = source, .prior = {}}, {});
    EXPECT_EQ(alone.candidates.front().target_from_source, watched.candidates.front().target_from_source);
  }
}

}  // namespace
}  // namespace gridmerge
