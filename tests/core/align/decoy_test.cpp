#include "gridmerge/align/decoy.hpp"

#include <gtest/gtest.h>

#include "gridmerge/judge/decoy_level.hpp"
#include "support/scenes.hpp"

namespace gridmerge {
namespace {

/// By a pose of the source in the target.
DecoyLevel level_by(const Pose2& pose, const OccupancyGrid& target, const OccupancyGrid& source) {
  const PreparedMap a(target, 0.05);
  const PreparedMap b(source, 0.05);
  const AlignRequest request{.target = a, .source = b, .prior = {}};
  const Decoy decoy(request, {});
  return {.own = decoy.fit_of({{pose, 0}}), .decoy = decoy.best()};
}

DecoyLevel level_of(const worlds::MapPair& pair) { return level_by(pair.target_from_source, pair.target, pair.source); }

TEST(Decoy, MapsOfOnePlaceFitBetterThanInAMirror) {
  EXPECT_GT(level_of(worlds::make_scene(known_pair("flat"))).log_ratio(), 0.2);
  EXPECT_GT(level_of(worlds::make_scene(known_pair("office_small_overlap"))).log_ratio(), 0);
}

TEST(Decoy, APoseThatIsOffFitsWorse) {
  const worlds::MapPair flat = worlds::make_scene(known_pair("flat"));
  const Pose2 off = Pose2{3, -2, radians(40)} * flat.target_from_source;
  EXPECT_LT(level_by(off, flat.target, flat.source).log_ratio(), 0);
}

TEST(Decoy, TakesTheBestOfACandidatesNeighbourhood) {
  const worlds::MapPair flat = worlds::make_scene(known_pair("flat"));
  const DecoyLevel exact = level_of(flat);
  const DecoyLevel near = level_by(Pose2{0.07, -0.05, 0} * flat.target_from_source, flat.target, flat.source);
  EXPECT_NEAR(near.own, exact.own, 0.02 * exact.own);
}

TEST(Decoy, TakesTheBestOfAllCandidates) {
  const worlds::MapPair flat = worlds::make_scene(known_pair("flat"));
  const PreparedMap a(flat.target, 0.05);
  const PreparedMap b(flat.source, 0.05);
  const Decoy decoy({.target = a, .source = b, .prior = {}}, {});
  const Candidate right{flat.target_from_source, 0};
  const Candidate off{Pose2{3, -2, radians(40)} * flat.target_from_source, 9};
  EXPECT_EQ(decoy.fit_of({off, right}), decoy.fit_of({right}));
  EXPECT_LT(decoy.fit_of({off}), decoy.fit_of({right}));
  EXPECT_EQ(decoy.fit_of({}), 0);
}

TEST(Decoy, LooksNowhereButInTheFence) {
  // A hall laid on itself fits as well in a mirror; but far off, where the fence is, nothing meets anything.
  const worlds::MapPair hall = worlds::make_scene({.kind = "hall", .seed = 2, .target_share = 1, .source_share = 1});
  const PreparedMap map(hall.target, 0.05);
  const PosePrior nowhere{.target_from_source = {500, 0, 0}, .radius_m = 2, .angle_rad = radians(20)};
  EXPECT_GT(Decoy({.target = map, .source = map, .prior = {}}, {}).best(), 100);
  EXPECT_EQ(Decoy({.target = map, .source = map, .prior = nowhere}, {}).best(), 0);
}

TEST(Decoy, IsTheSameForSwappedMaps) {
  const worlds::MapPair pair = worlds::make_scene(known_pair("office_small_overlap"));
  const DecoyLevel forth = level_of(pair);
  const DecoyLevel back = level_by(inverse(pair.target_from_source), pair.source, pair.target);
  EXPECT_NEAR(forth.own, back.own, 0.03 * forth.own);
  EXPECT_NEAR(forth.log_ratio(), back.log_ratio(), 0.1);
}

TEST(Decoy, AMirroredWorldFitsBetterInAMirror) {
  worlds::SceneOptions options = known_pair("flat");
  options.relation = "mirrored";
  EXPECT_LT(level_of(worlds::make_scene(options)).log_ratio(), -0.2);
}

TEST(Decoy, ASymmetricHallFitsAsWellInAMirror) {
  const worlds::MapPair pair = worlds::make_scene({.kind = "hall", .seed = 2, .target_share = 1, .source_share = 1});
  EXPECT_NEAR(level_of(pair).log_ratio(), 0, 0.1);
}

TEST(Decoy, SpecksSayNothing) {
  EXPECT_EQ(DecoyLevel{}.log_ratio(), 0);
  EXPECT_NEAR((DecoyLevel{.own = 2, .decoy = 0}.log_ratio()), std::log(7.0 / 5), 1e-12);
  EXPECT_EQ((DecoyLevel{.own = -3, .decoy = -9}.log_ratio()), 0);
}

}  // namespace
}  // namespace gridmerge
