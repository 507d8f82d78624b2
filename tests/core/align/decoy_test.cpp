#include "gridmerge/align/decoy.hpp"

#include <gtest/gtest.h>

#include "support/scenes.hpp"

namespace gridmerge {
namespace {

DecoyLevel level_of(const OccupancyGrid& target, const OccupancyGrid& source) {
  const PreparedMap a(target, 0.05);
  const PreparedMap b(source, 0.05);
  const AlignRequest request{.target = a, .source = b, .prior = {}};
  return decoy_level(correlation_sweep(a, b, std::nullopt, survey_options(), {}), request, {});
}

TEST(Decoy, MapsOfOnePlaceFitBetterThanInAMirror) {
  const worlds::MapPair flat = worlds::make_scene(known_pair("flat"));
  EXPECT_GT(level_of(flat.target, flat.source).log_ratio(), 0.2);
  const worlds::MapPair small = worlds::make_scene(known_pair("office_small_overlap"));
  EXPECT_GT(level_of(small.target, small.source).log_ratio(), 0);
}

TEST(Decoy, AMirroredWorldFitsBetterInAMirror) {
  worlds::SceneOptions options = known_pair("flat");
  options.relation = "mirrored";
  const worlds::MapPair pair = worlds::make_scene(options);
  EXPECT_LT(level_of(pair.target, pair.source).log_ratio(), -0.2);
}

TEST(Decoy, ASymmetricHallFitsAsWellInAMirror) {
  const worlds::MapPair pair = worlds::make_scene({.kind = "hall", .seed = 2, .target_share = 1, .source_share = 1});
  EXPECT_NEAR(level_of(pair.target, pair.source).log_ratio(), 0, 0.1);
}

TEST(Decoy, SpecksSayNothing) {
  EXPECT_EQ(DecoyLevel{}.log_ratio(), 0);
  EXPECT_NEAR((DecoyLevel{.own = 2, .decoy = 0}.log_ratio()), std::log(7.0 / 5), 1e-12);
  EXPECT_EQ((DecoyLevel{.own = -3, .decoy = -9}.log_ratio()), 0);
}

}  // namespace
}  // namespace gridmerge
