#include "methods/hough_spectrum/hough_spectrum.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "methods/hough_spectrum/axis_spectra.hpp"
#include "methods/hough_spectrum/paper_hough_spectrum.hpp"
#include "methods/hough_spectrum/spectrum.hpp"
#include "support/flat_pair.hpp"
#include "support/scenes.hpp"
#include "support/text_map.hpp"

namespace gridmerge {
namespace {

using hough::Agreement;
using hough::AxisMatcher;
using hough::Facing;
using hough::HoughTransform;
using hough::OrientedWall;
using hough::Peak;
using hough::Translation;
using testing::IsEmpty;
using testing::Not;

/// A straight wall through `foot`, one point every 0.1 m, that faces along `normal_deg`.
std::vector<OrientedWall> straight_wall(Point2 foot, double normal_deg, double length_m,
                                        Facing facing = Facing::kKnown) {
  const double normal = radians(normal_deg);
  std::vector<OrientedWall> walls;
  for (double along = -length_m / 2; along <= length_m / 2; along += 0.1) {
    walls.push_back({.at = {static_cast<float>(foot.x_m - along * std::sin(normal)),
                            static_cast<float>(foot.y_m + along * std::cos(normal))},
                     .normal_rad = static_cast<float>(normal),
                     .weight = 1,
                     .facing = facing});
  }
  return walls;
}

void append(std::vector<OrientedWall>& walls, const std::vector<OrientedWall>& more) {
  walls.insert(walls.end(), more.begin(), more.end());
}

/// An L-shaped room seen from inside: no turn of it looks like another.
std::vector<OrientedWall> room() {
  std::vector<OrientedWall> walls;
  append(walls, straight_wall({-5, 0}, 0, 8));
  append(walls, straight_wall({5, -2}, 180, 4));
  append(walls, straight_wall({0, -4}, 90, 10));
  append(walls, straight_wall({-2, 4}, 270, 6));
  append(walls, straight_wall({1, 2}, 180, 4));
  append(walls, straight_wall({3, 0}, 270, 4));
  return walls;
}

std::vector<OrientedWall> moved(std::vector<OrientedWall> walls, const Pose2& by) {
  for (OrientedWall& wall : walls) {
    const Point2 at = by * Point2{wall.at.x_m, wall.at.y_m};
    wall.at = {static_cast<float>(at.x_m), static_cast<float>(at.y_m)};
    wall.normal_rad += static_cast<float>(by.theta_rad);
  }
  return walls;
}

double near_deg(double angle_rad, double other_deg) {
  return std::abs(degrees(wrap_angle(angle_rad - radians(other_deg))));
}

TEST(HoughTransform, AStraightWallIsOneBin) {
  // x = 2: angle 0, rho 2; or angle 180, rho -2.
  std::vector<WallPoint> cells;
  for (int i = -20; i <= 20; ++i) {
    cells.push_back({.at = {2, 0.1F * static_cast<float>(i)}, .free_normal = {}, .surface_normal = {}});
  }
  const HoughTransform transform = hough::full_transform(cells, 360, 5, 0.1);
  const auto highest = std::max_element(transform.votes.begin(), transform.votes.end());
  EXPECT_EQ(*highest, static_cast<float>(cells.size()));
  const auto bin = [&](int angle, double rho_m) {
    return transform.row(angle)[static_cast<std::size_t>(std::lround((rho_m - transform.rho_low_m) / 0.1))];
  };
  EXPECT_EQ(bin(0, 2), *highest);
  EXPECT_EQ(bin(180, -2), *highest);
}

TEST(HoughTransform, EveryCellVotesOnceForEachAngle) {
  std::vector<WallPoint> cells(7);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    cells[i].at = {0.3F * static_cast<float>(i), -0.2F * static_cast<float>(i)};
  }
  const HoughTransform transform = hough::full_transform(cells, 90, 3, 0.1);
  for (int k = 0; k < transform.angles; ++k) {
    const auto row = transform.row(k);
    EXPECT_FLOAT_EQ(std::accumulate(row.begin(), row.end(), 0.0F), 7) << "angle " << k;
  }
}

TEST(HoughTransform, AnOrientedWallVotesOnlyAboutItsOwnNormal) {
  const HoughTransform transform = hough::oriented_transform(straight_wall({1, 1}, 40, 3), 360, 5, 0.1, radians(15));
  for (int k = 0; k < transform.angles; ++k) {
    const auto row = transform.row(k);
    const float votes = std::accumulate(row.begin(), row.end(), 0.0F);
    if (std::abs(k - 40) != 15) {  // the edge itself is a matter of rounding
      EXPECT_EQ(votes > 0, std::abs(k - 40) < 15) << "angle " << k;
    }
  }
}

TEST(HoughSpectrum, IsTheSumOfSquares) {
  HoughTransform transform(4, 1, 1);
  transform.votes[0] = 3;
  transform.votes[1] = 4;
  EXPECT_THAT(hough::hough_spectrum(transform), testing::ElementsAre(25, 0, 0, 0));
}

TEST(HoughSpectrum, HasPeriodPiWithoutFacings) {
  std::vector<WallPoint> cells;
  for (const OrientedWall& wall : room()) {
    cells.push_back({.at = wall.at, .free_normal = {}, .surface_normal = {}});
  }
  const std::vector<float> spectrum = hough::hough_spectrum(hough::full_transform(cells, 360, 10, 0.1));
  for (std::size_t k = 0; k < 180; ++k) {
    EXPECT_NEAR(spectrum[k], spectrum[k + 180], 0.1 * spectrum[k]) << "angle " << k;
  }
}

TEST(HoughSpectrum, PeaksAtTheDirectionOfAWallToAFractionOfABin) {
  for (const double normal_deg : {0.0, 17.3, 133.6, 271.5, 359.8}) {
    const std::vector<float> spectrum = hough::hough_spectrum(
        hough::oriented_transform(straight_wall({1, -2}, normal_deg, 8), 360, 12, 0.1, radians(15)));
    EXPECT_LT(near_deg(radians(hough::periodic_peaks(spectrum).front().at), normal_deg), 0.3) << normal_deg;
  }
}

TEST(HoughSpectrum, KnowsStraightWallsFromNone) {
  std::vector<OrientedWall> round;
  for (int i = 0; i < 360; ++i) {
    append(round, moved(straight_wall({4, 0}, 0, 0.1), {0, 0, radians(i)}));
  }
  const auto contrast_of = [](const std::vector<OrientedWall>& walls) {
    return hough::contrast(hough::hough_spectrum(hough::oriented_transform(walls, 360, 12, 0.1, radians(15))));
  };
  EXPECT_LT(contrast_of(round), 1.5);
  EXPECT_GT(contrast_of(room()), 8);
  EXPECT_EQ(hough::contrast(std::vector<float>(10, 0.0F)), 1);
}

TEST(PeriodicPeaks, AreTheMaximaHighestFirstAndGoRound) {
  const std::vector<float> values{5, 1, 0, 2, 3, 2, 0, 1};
  const std::vector<Peak> peaks = hough::periodic_peaks(values);
  ASSERT_EQ(peaks.size(), 2U);
  EXPECT_NEAR(peaks[0].at, 0, 1e-6);
  EXPECT_NEAR(peaks[1].at, 4, 1e-6);
  EXPECT_THAT(hough::periodic_peaks(std::vector<float>(6, 1.0F)), IsEmpty());
}

TEST(AxisMatcher, FindsATranslationAtItsRotation) {
  for (const Pose2& truth : {Pose2{}, Pose2{2.3, -1.1, 0}, Pose2{-4, 3, radians(63)}, Pose2{1, 1, radians(-170)}}) {
    const std::vector<OrientedWall> source = room();
    const std::vector<OrientedWall> target = moved(source, truth);
    const AxisMatcher matcher(12, 8, {});
    const double axis = truth.theta_rad;
    const Agreement agreement =
        matcher.agreement(matcher.spectra(target, axis), matcher.spectra(source, axis - truth.theta_rad), axis);
    const std::vector<Translation> best = hough::best_translations(agreement, 5, {});
    ASSERT_THAT(best, Not(IsEmpty()));
    EXPECT_LT(norm(best.front().at - truth.translation()), 0.3) << testing::PrintToString(truth.theta_rad);
    for (std::size_t i = 1; i < best.size(); ++i) {
      EXPECT_LE(best[i].value, best[i - 1].value);
    }
  }
}

TEST(AxisMatcher, AWallMeetsNoWallThatFacesTheOtherWay) {
  const AxisMatcher matcher(6, 6, {});
  const auto highest = [&](const std::vector<OrientedWall>& target, const std::vector<OrientedWall>& source) {
    const Agreement agreement = matcher.agreement(matcher.spectra(target, 0), matcher.spectra(source, 0), 0);
    return *std::max_element(agreement.value.begin(), agreement.value.end());
  };
  const auto right = straight_wall({0, 0}, 0, 4);
  const auto left = straight_wall({0, 0}, 180, 4);
  const auto either = straight_wall({0, 0}, 0, 4, Facing::kEither);
  const float full = highest(right, right);
  EXPECT_GT(full, 0);
  EXPECT_LT(highest(right, left), 0.01F * full);
  EXPECT_NEAR(highest(left, either), full, 0.01F * full);
}

TEST(AxisMatcher, KeepsToAWindow) {
  const std::vector<OrientedWall> walls = room();
  const AxisMatcher matcher(8, 8, {});
  const Agreement agreement = matcher.agreement(matcher.spectra(walls, 0), matcher.spectra(walls, 0), 0);
  const PoseWindow window{.centre = {3, 2, 0}, .radius_m = 1.5};
  for (const Translation& one : hough::best_translations(agreement, 20, window)) {
    EXPECT_LE(norm(one.at - Point2{3, 2}), 1.5);
  }
}

class HoughSpectrumOnKnownPairs : public testing::TestWithParam<KnownPair> {};

TEST_P(HoughSpectrumOnKnownPairs, IsRightWhereTheMapsSayItAndNeverMergesWhereTheyDoNot) {
  const KnownPair& known = GetParam();
  const bool bent = known.options.drift_m > 0;
  const int scenes = known.overlaps && !known.ambiguous ? 1 : 2;
  for (int seed = 1; seed <= scenes; ++seed) {
    const worlds::MapPair pair = worlds::make_scene(known_pair(known.name, seed));
    const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = {}},
                                      HoughSpectrumMerger({}), {}, {.seed = 1, .num_threads = 2});
    const std::string told = "scene " + std::to_string(seed) + ": " + testing::PrintToString(alignment.reasons);
    if (!known.overlaps || known.ambiguous) {
      EXPECT_NE(alignment.outcome, Outcome::kMerged) << told;
    } else {
      EXPECT_EQ(alignment.outcome, Outcome::kMerged) << told;
      ASSERT_THAT(alignment.hypotheses, Not(IsEmpty()));
      const PoseDifference error = pose_error(pair, alignment.hypotheses.front().target_from_source.pose);
      EXPECT_LT(error.distance_m, bent ? 1 : 0.2) << told;
      EXPECT_LT(degrees(error.angle_rad), bent ? 3 : 0.7) << told;
    }
  }
}

std::string pair_name(const testing::TestParamInfo<KnownPair>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Scenes, HoughSpectrumOnKnownPairs, testing::ValuesIn(known_pairs()), pair_name);

TEST(HoughSpectrum, HasTheTruthFirst) {
  const Proposal proposal = HoughSpectrumMerger({}).propose(flat().request(), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_TRUE(flat().right(proposal.candidates.front().target_from_source, 0.5, 3));
}

TEST(HoughSpectrum, ProposesDistinctPoses) {
  const HoughSpectrumOptions options;
  const Proposal proposal = HoughSpectrumMerger(options).propose(flat().request(), {});
  EXPECT_GT(proposal.candidates.size(), 4U);
  EXPECT_LE(proposal.candidates.size(), static_cast<std::size_t>(options.candidates));
  for (std::size_t i = 0; i < proposal.candidates.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const PoseDifference apart =
          difference_at(flat().source.centre_in_map(), proposal.candidates[i].target_from_source,
                        proposal.candidates[k].target_from_source);
      EXPECT_TRUE(apart.distance_m >= options.distinct_m - 1e-6 ||
                  apart.angle_rad >= radians(options.distinct_deg) - 1e-6);
    }
  }
}

TEST(HoughSpectrum, DoesNotClaimToHaveLookedEverywhere) {
  EXPECT_FALSE(HoughSpectrumMerger({}).propose(flat().request(), {}).surveyed);
}

TEST(HoughSpectrum, TriesRotationsAllRoundWhereSpectraAreFlat) {
  HoughSpectrumOptions options;
  const int of_maxima = HoughSpectrumMerger(options).propose(flat().request(), {}).iterations;
  options.flat_contrast = 1000;
  EXPECT_LE(of_maxima, options.rotations + 1);
  EXPECT_GE(HoughSpectrumMerger(options).propose(flat().request(), {}).iterations, 90);
}

TEST(HoughSpectrum, FindsTheTruthInANarrowFence) {
  const PosePrior fence{
      .target_from_source = flat().pair.target_from_source, .radius_m = 0.25, .angle_rad = radians(1.5)};
  const Proposal proposal = HoughSpectrumMerger({}).propose(flat().request(fence), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_TRUE(flat().right(proposal.candidates.front().target_from_source, 0.5, 3));
}

TEST(HoughSpectrum, APriorWithoutAFenceIsOnlyAStart) {
  const PosePrior start{.target_from_source = {500, -300, 1}, .radius_m = {}, .angle_rad = {}};
  const Proposal proposal = HoughSpectrumMerger({}).propose(flat().request(start), {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_TRUE(flat().right(proposal.candidates.front().target_from_source, 0.5, 3));
}

TEST(HoughSpectrum, GivesItsBestSoFarWhenItIsStoppedAfterItsRotations) {
  /// Cancels once the first rotation has been recorded: nothing has climbed yet.
  struct Impatient : TraceSink {
    StopToken stop;
    void on_iteration(const IterationRecord& /*record*/) override { stop.cancel(); }
  };
  Impatient watcher;
  const Proposal proposal =
      HoughSpectrumMerger({}).propose(flat().request(), {.stop = watcher.stop, .trace = &watcher});
  EXPECT_TRUE(proposal.stopped);
  EXPECT_TRUE(std::any_of(proposal.candidates.begin(), proposal.candidates.end(),
                          [](const Candidate& one) { return flat().right(one.target_from_source, 0.5, 3); }));
}

/// Keeps the names of the views, and checks that each is whole.
struct Gallery : TraceSink {
  std::set<std::string> names;

  [[nodiscard]] bool wants_views() const override { return true; }
  void on_view(const View& view) override {
    EXPECT_TRUE(names.insert(view.name).second) << view.name << " comes twice";
    EXPECT_THAT(view.title, Not(IsEmpty()));
    if (const auto* surface = std::get_if<SurfaceView>(&view.content)) {
      EXPECT_EQ(surface->values.size(),
                static_cast<std::size_t>(surface->width) * static_cast<std::size_t>(surface->height));
      EXPECT_LT(surface->x_low, surface->x_high);
      EXPECT_LT(surface->y_low, surface->y_high);
    } else if (const auto* curves = std::get_if<CurvesView>(&view.content)) {
      EXPECT_THAT(curves->curves, Not(IsEmpty()));
      for (const Curve& curve : curves->curves) {
        EXPECT_EQ(curve.x.size(), curve.y.size()) << view.name;
      }
    }
  }
};

TEST(HoughSpectrum, ShowsWhatItSees) {
  Gallery gallery;
  (void)HoughSpectrumMerger({}).propose(flat().request(), {.trace = &gallery});
  EXPECT_THAT(gallery.names, testing::IsSupersetOf({"hough_transform_target", "hough_transform_source", "hough_spectra",
                                                    "spectrum_correlation", "x_spectra", "x_correlation", "y_spectra",
                                                    "y_correlation", "agreement", "hypotheses"}));
}

TEST(HoughSpectrum, RefusesOptionsOutOfRange) {
  HoughSpectrumOptions options;
  options.translations = 0;
  EXPECT_THROW(HoughSpectrumMerger{options}, std::invalid_argument);
  options = {};
  options.fit.tolerance_m = 0;
  EXPECT_THROW(HoughSpectrumMerger{options}, std::invalid_argument);
}

TEST(PaperHoughSpectrum, PutsAMapOnItselfExactly) {
  const AlignRequest request{.target = flat().target, .source = flat().target, .prior = {}};
  const Proposal proposal = PaperHoughSpectrumMerger({}).propose(request, {});
  ASSERT_THAT(proposal.candidates, Not(IsEmpty()));
  EXPECT_NEAR(proposal.candidates.front().method_score, 1, 1e-3);
  const PoseDifference off =
      difference_at(flat().target.centre_in_map(), proposal.candidates.front().target_from_source, {});
  EXPECT_LT(off.distance_m, 0.01);
}

TEST(PaperHoughSpectrum, GivesOneHypothesisForEachRotation) {
  PaperHoughSpectrumOptions options;
  options.rotations = 3;
  const Proposal plain = PaperHoughSpectrumMerger(options).propose(flat().request(), {});
  EXPECT_EQ(plain.candidates.size(), 3U);
  options.robust = true;
  const Proposal robust = PaperHoughSpectrumMerger(options).propose(flat().request(), {});
  EXPECT_EQ(robust.candidates.size(), 9U);
  for (const Candidate& one : robust.candidates) {
    EXPECT_GE(one.method_score, 0);
    EXPECT_LE(one.method_score, 1);
  }
}

TEST(PaperHoughSpectrum, ShowsWhatItSees) {
  Gallery gallery;
  (void)PaperHoughSpectrumMerger({}).propose(flat().request(), {.trace = &gallery});
  EXPECT_THAT(gallery.names, testing::IsSupersetOf({"hough_transform_target", "hough_spectra", "spectrum_correlation",
                                                    "x_spectra", "hypotheses"}));
}

TEST(PaperHoughSpectrum, RefusesOptionsOutOfRange) {
  PaperHoughSpectrumOptions options;
  options.rotations = 0;
  EXPECT_THROW(PaperHoughSpectrumMerger{options}, std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
