#include "gridmerge/align/lattice_scores.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>

#include "support/scenes.hpp"

namespace gridmerge {
namespace {

/// What a lattice says of itself, told apart from how it is computed: walls and rewards at one angle, in whole numbers,
/// and sums over them.
class ByHand {
 public:
  ByHand(const PreparedMap& fixed, const PreparedMap& moving, double base_angle_rad, int quarters)
      : level_(fixed.level(2)), quarters_(quarters), turn_{0, 0, base_angle_rad}, from_(moving.level(2)) {
    fixed_reward_ = FitTable(level_, {}).value;
    moving_reward_ = FitTable(from_, {}).value;
    for (const ThinnedWall& wall : thinned_walls(moving, from_)) {
      const Point2 at = 1 / level_.resolution_m * (turn_ * Point2{wall.at.x_m, wall.at.y_m});
      Cell cell{static_cast<int>(std::lround(at.x_m)), static_cast<int>(std::lround(at.y_m))};
      for (int q = 0; q < quarters; ++q) {
        cell = {-cell.second, cell.first};
      }
      walls_.emplace_back(cell, std::lround(16 * wall.weight));
    }
    for (const ThinnedWall& wall : thinned_walls(fixed, level_)) {
      fixed_walls_.emplace_back(Cell{static_cast<int>((wall.at.x_m - level_.lower_left.x_m) / level_.resolution_m),
                                     static_cast<int>((wall.at.y_m - level_.lower_left.y_m) / level_.resolution_m)},
                                std::lround(16 * wall.weight));
    }
  }

  [[nodiscard]] std::int64_t score(int column, int row) const {
    std::int64_t sum = 0;
    for (const auto& [cell, weight] : walls_) {
      const int c = cell.first + column;
      const int r = cell.second + row;
      sum += level_.contains(c, r) ? weight * fixed_reward_[level_.offset(c, r)] : 0;
    }
    for (const auto& [cell, weight] : fixed_walls_) {
      Cell off{cell.first - column, cell.second - row};
      for (int q = 0; q < quarters_; ++q) {
        off = {off.second, -off.first};
      }
      const Point2 centre{off.first * from_.resolution_m, off.second * from_.resolution_m};
      const Point2 at = 1 / from_.resolution_m * (inverse(turn_) * centre - from_.lower_left);
      const int c = static_cast<int>(std::floor(at.x_m));
      const int r = static_cast<int>(std::floor(at.y_m));
      sum += from_.contains(c, r) ? weight * moving_reward_[from_.offset(c, r)] : 0;
    }
    return sum;
  }

 private:
  using Cell = std::pair<int, int>;
  const MapLevel& level_;
  int quarters_;
  Pose2 turn_;
  const MapLevel& from_;
  std::vector<std::int8_t> fixed_reward_;
  std::vector<std::int8_t> moving_reward_;
  std::vector<std::pair<Cell, std::int64_t>> walls_;
  std::vector<std::pair<Cell, std::int64_t>> fixed_walls_;
};

/// Angles of 30 degrees: twelve of them.
LatticeOptions coarse() { return {.angle_step_rad = radians(30)}; }

TEST(PoseLattice, SpansTheTurnInGroupsOfFourQuarters) {
  const PreparedMap map = posts_and_walls(1, 60, 50);
  const PoseLattice lattice(map, map, std::nullopt, {.angle_step_rad = radians(25)});
  EXPECT_EQ(lattice.turns(), 4);
  EXPECT_EQ(lattice.groups(), 4);  // 90 / 25, rounded up
  EXPECT_NEAR(degrees(lattice.angle_step_rad()), 22.5, 1e-9);
  std::vector<double> angles;
  for (int i = 0; i < lattice.angles(); ++i) {
    angles.push_back(degrees(lattice.angle_rad(i)));
    if (i % 4 != 0) {
      EXPECT_NEAR(std::abs(wrap_angle(lattice.angle_rad(i) - lattice.angle_rad(i - 1))), kPi / 2, 1e-12);
    }
  }
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 1; i < angles.size(); ++i) {
    EXPECT_NEAR(angles[i] - angles[i - 1], 22.5, 1e-9);
  }
}

TEST(PoseLattice, KeepsToAWindowOfAngles) {
  const PreparedMap map = posts_and_walls(1, 60, 50);
  const PoseWindow window{.centre = {0.5, 0, 3}, .radius_m = 1, .angle_rad = 0.3};
  const PoseLattice lattice(map, map, window, {.angle_step_rad = 0.1});
  ASSERT_EQ(lattice.angles(), 7);
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(wrap_angle(lattice.angle_rad(i) - 3), -0.3 + 0.1 * i, 1e-9);
  }
  const MapLevel& level = lattice.fixed_level();
  const LatticePose centre{3, static_cast<int>((0.5 - level.lower_left.x_m) / level.resolution_m),
                           static_cast<int>((0 - level.lower_left.y_m) / level.resolution_m)};
  EXPECT_TRUE(lattice.holds(centre));
  EXPECT_FALSE(lattice.holds({3, centre.column + 6, centre.row}));
}

TEST(PoseLattice, LeavesOutGroupsWithAllTheirQuarterTurns) {
  const PreparedMap map = posts_and_walls(1, 60, 50);
  PoseLattice lattice(map, map, std::nullopt, coarse());
  lattice.keep_groups([](double angle) { return std::abs(angle - radians(30)) > 1e-9; });
  ASSERT_EQ(lattice.groups(), 2);
  ASSERT_EQ(lattice.angles(), 8);
  for (int i = 0; i < lattice.angles(); ++i) {
    const double in_quarter = std::fmod(degrees(lattice.angle_rad(i)) + 360.5, 90) - 0.5;
    EXPECT_NEAR(in_quarter, i < 4 ? 0 : 60, 1e-9);
  }
  int seen = 0;
  score_lattice(lattice, {}, [&](const ScoreSurface& surface, std::size_t) {
    EXPECT_LT(surface.angle, 8);
    ++seen;
  });
  EXPECT_EQ(seen, 8);
}

TEST(PoseLattice, AddsUpWhatItSays) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const PreparedMap fixed = posts_and_walls(seed, 81, 59);
    const PreparedMap moving = posts_and_walls(seed + 100, 50, 70);
    const PoseLattice lattice(fixed, moving, std::nullopt, coarse());
    for (const int angle : {0, 1, 2, 3, 6, 11}) {
      const ByHand by_hand(fixed, moving, (angle / 4) * radians(30), angle % 4);
      int doubtful = 0;
      for (int row = -8; row < 24; row += 3) {
        for (int column = -8; column < 30; column += 3) {
          doubtful += lattice.score({angle, column, row}) == by_hand.score(column, row) ? 0 : 1;
        }
      }
      // Single precision puts a point on the edge of a cell to either side; at 0 and 90 degrees there are many.
      EXPECT_LE(doubtful, angle < 4 ? 143 : 6) << "seed " << seed << ", angle " << angle;
    }
  }
}

TEST(PoseLattice, OneWayReadsTheMovingWallsOnly) {
  const PreparedMap fixed = posts_and_walls(1, 81, 59);
  const PreparedMap moving = posts_and_walls(2, 50, 70);
  LatticeOptions one_way = coarse();
  one_way.both_ways = false;
  const PoseLattice both(fixed, moving, std::nullopt, coarse());
  const PoseLattice one(fixed, moving, std::nullopt, one_way);
  EXPECT_TRUE(one.fixed_walls().empty());
  int different = 0;
  for (int column = 0; column < 20; ++column) {
    different += one.score({5, column, 8}) != both.score({5, column, 8}) ? 1 : 0;
  }
  EXPECT_GT(different, 10);
}

TEST(LatticeScores, AreTheSumsWithinTheirRounding) {
  // The fixed map the larger one, and the smaller; wide, and high.
  for (const auto& [width, height] : {std::pair{81, 59}, {40, 110}}) {
    const PreparedMap fixed = posts_and_walls(3, width, height);
    const PreparedMap moving = posts_and_walls(4, 70, 50);
    const PoseLattice lattice(fixed, moving, std::nullopt, coarse());
    std::mutex mutex;
    std::map<int, int> visits;
    double farthest = 0;
    double rounding = 0;
    const LatticeScores scores =
        score_lattice(lattice, {.num_threads = 2}, [&](const ScoreSurface& surface, std::size_t) {
          const TurnedMap turned = lattice.turned(surface.angle / lattice.turns());
          const std::scoped_lock lock(mutex);
          ++visits[surface.angle];
          rounding = std::max(rounding, surface.rounding);
          for (int row = 0; row < surface.size; ++row) {
            for (int column = 0; column < surface.size; ++column) {
              const LatticePose at = surface.at(column, row);
              const double exact = static_cast<double>(lattice.score(at, turned));
              const double off = std::abs(static_cast<double>(surface.score[surface.offset(column, row)]) - exact);
              ASSERT_LE(off, surface.rounding) << at.angle << ": " << at.column << ", " << at.row;
              farthest = std::max(farthest, off);
            }
          }
        });
    EXPECT_EQ(visits.size(), 12U);
    EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const auto& visit) { return visit.second == 1; }));
    EXPECT_EQ(scores.rounding, rounding);
    EXPECT_GT(farthest, 0);    // or the test has compared nothing
    EXPECT_LT(rounding, 480);  // less than one wall on one wall: of use
    EXPECT_FALSE(scores.stopped);
  }
}

TEST(LatticeScores, OnASharedTorusAreTheSumsOfThosePosesThatShareAPlace) {
  const PreparedMap fixed = posts_and_walls(3, 200, 200);
  const PreparedMap moving = posts_and_walls(4, 190, 190);
  const PoseLattice lattice(fixed, moving, std::nullopt, {.angle_step_rad = radians(45)});
  int whole_size = 0;
  score_lattice(lattice, {}, [&](const ScoreSurface& surface, std::size_t) { whole_size = surface.size; });
  double rounding = 0;
  int doubly = 0;
  score_lattice(
      lattice, {},
      [&](const ScoreSurface& surface, std::size_t) {
        ASSERT_LT(surface.size, whole_size);
        const TurnedMap turned = lattice.turned(surface.angle / lattice.turns());
        const int size = surface.size;
        for (int row = 0; row < size; row += 3) {
          for (int column = 0; column < size; column += 3) {
            std::int64_t sum = 0;
            int touching = 0;
            for (const int up : {-size, 0, size}) {
              for (const int right : {-size, 0, size}) {
                const std::int64_t one = lattice.score({surface.angle, column + right, row + up}, turned);
                sum += one;
                touching += one != 0 ? 1 : 0;
              }
            }
            doubly += touching > 1 ? 1 : 0;
            ASSERT_NEAR(static_cast<double>(surface.score[surface.offset(column, row)]), static_cast<double>(sum),
                        surface.rounding);
          }
        }
        rounding = std::max(rounding, surface.rounding);
      },
      Torus::kShared);
  EXPECT_GT(doubly, 0);  // or nothing was shared
  EXPECT_GT(rounding, 0);
}

TEST(LatticeScores, StopsBetweenAngles) {
  const PreparedMap map = posts_and_walls(1, 60, 50);
  const PoseLattice lattice(map, map, std::nullopt, coarse());
  const StopToken stop;
  int visits = 0;
  const LatticeScores scores = score_lattice(lattice, {.stop = stop}, [&](const ScoreSurface&, std::size_t) {
    if (++visits == 2) {
      stop.cancel();
    }
  });
  EXPECT_TRUE(scores.stopped);
  EXPECT_EQ(visits, 2);
}

TEST(SurfacePeaks, AreTheHighestLocalMaxima) {
  constexpr int kSize = 8;
  std::vector<float> score(kSize * kSize, 0.0F);
  const auto at = [&](int column, int row) -> float& { return score[static_cast<std::size_t>(row * kSize + column)]; };
  at(2, 2) = 5;
  at(3, 2) = 4;  // on its slope
  at(0, 6) = 3;
  at(7, 6) = 2;  // beside it, across the seam of the torus
  at(5, 5) = 1;
  const ScoreSurface surface{
      .angle = 7, .size = kSize, .width = 4, .height = 4, .reach = 1, .rounding = 0, .score = score};
  const auto any = [](const LatticePose&) { return true; };
  std::vector<LatticePeak> peaks = surface_peaks(surface, 10, any);
  std::sort(peaks.begin(), peaks.end(), [](const LatticePeak& a, const LatticePeak& b) { return a.score > b.score; });
  ASSERT_EQ(peaks.size(), 3U);
  EXPECT_EQ(peaks[0].at, (LatticePose{7, 2, 2}));
  EXPECT_EQ(peaks[1].at, (LatticePose{7, 0, -2}));
  EXPECT_EQ(peaks[2].at, (LatticePose{7, -3, -3}));
  EXPECT_EQ(surface_peaks(surface, 2, any).size(), 2U);
  const auto lower = surface_peaks(surface, 1, [](const LatticePose& one) { return one.row < 0; });
  ASSERT_EQ(lower.size(), 1U);
  EXPECT_EQ(lower.front().score, 3);
}

}  // namespace
}  // namespace gridmerge
