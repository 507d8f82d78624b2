/// What must not be merged, whoever proposes: symmetric, bare, mirrored, other places. And that it is said why.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "gridmerge/align/pipeline.hpp"
#include "methods/register_all.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;

class HardCases : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static Alignment run(const OccupancyGrid& target, const OccupancyGrid& source) {
    const std::unique_ptr<Merger> method = all_methods().method(GetParam()).profiles.front().config()->make();
    return align({.target = target, .source = source, .prior = {}}, *method, {}, {.seed = 1, .num_threads = 2});
  }
  [[nodiscard]] static Alignment run(const worlds::SceneOptions& scene) {
    const worlds::MapPair pair = worlds::make_scene(scene);
    return run(pair.target, pair.source);
  }
};

/// Free inside of a frame, unknown outside; `sides` of its four walls are drawn.
OccupancyGrid bare_room(int side_cells, int sides) {
  constexpr int kBorder = 10;
  const int size = side_cells + 2 * kBorder;
  OccupancyGrid grid = unknown_grid({.width = size, .height = size, .resolution_m = 0.05, .map_from_grid = {3, -2, 0}});
  for (int i = 0; i < side_cells; ++i) {
    for (int k = 0; k < side_cells; ++k) {
      const bool wall = (i < 2 && sides > 0) || (i >= side_cells - 2 && sides > 1) || (k < 2 && sides > 2) ||
                        (k >= side_cells - 2 && sides > 3);
      grid.at({kBorder + k, kBorder + i}) = wall ? kOccupied : kFree;
    }
  }
  return grid;
}

TEST_P(HardCases, ASquareRoomListsAllItsPoses) {
  const OccupancyGrid room = bare_room(160, 4);
  const Alignment alignment = run(room, room);
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous) << testing::PrintToString(alignment.reasons);
  EXPECT_THAT(alignment.reasons.front(), HasSubstr("another pose fits about as well"));
  EXPECT_GE(alignment.hypotheses.size(), 4U);
  EXPECT_LE(alignment.confidence, 0.5);
}

TEST_P(HardCases, OneWallIsNotEnough) {
  const OccupancyGrid wall = bare_room(160, 1);
  const Alignment alignment = run(wall, wall);
  EXPECT_NE(alignment.outcome, Outcome::kMerged) << testing::PrintToString(alignment.reasons);
}

TEST_P(HardCases, ACorridorIsAmbiguousAndSaysAlongWhat) {
  const Alignment alignment = run(worlds::SceneOptions{.kind = "corridor", .seed = 2});
  EXPECT_NE(alignment.outcome, Outcome::kMerged);
  EXPECT_THAT(alignment.reasons, Contains(AnyOf(HasSubstr("another pose fits"), HasSubstr("hardly fix"))));
}

TEST_P(HardCases, ASymmetricHallIsAmbiguous) {
  const Alignment alignment = run(worlds::SceneOptions{.kind = "hall", .seed = 2});
  EXPECT_EQ(alignment.outcome, Outcome::kAmbiguous) << testing::PrintToString(alignment.reasons);
  EXPECT_GE(alignment.hypotheses.size(), 2U);
}

TEST_P(HardCases, MirroredAndOtherPlacesAreNotMerged) {
  for (const char* kind : {"flat", "office", "maze", "forest"}) {
    for (const char* relation : {"mirrored", "two_worlds", "two_ends"}) {
      for (int seed = 1; seed <= 2; ++seed) {
        const Alignment alignment = run(worlds::SceneOptions{.kind = kind, .seed = seed, .relation = relation});
        EXPECT_NE(alignment.outcome, Outcome::kMerged)
            << kind << " " << relation << " " << seed << " " << testing::PrintToString(alignment.reasons);
        EXPECT_FALSE(alignment.reasons.empty());
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, HardCases, testing::Values("genetic", "hough_spectrum", "correlative"),
                         [](const auto& method) { return method.param; });

}  // namespace
}  // namespace gridmerge
