#include "gridmerge/judge/elastic.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace gridmerge {
namespace {

constexpr double kPatch = 4;               // [m] side of a patch
constexpr double kReach = 0.6;             // [m] how far a patch may shift
constexpr double kStep = 0.1;              // [m]
constexpr double kLeastWalls = 1;          // [m] of a patch that counts
constexpr std::size_t kMostInAPatch = 60;  // walls that are looked at

struct Shift {
  int columns = 0;
  int rows = 0;
  friend bool operator==(const Shift&, const Shift&) = default;
};

/// Shifts within reach, by two steps; then those that may follow, to the sides of the best. Walls are as wide as the
/// tolerance makes them, so none is stepped over.
struct Shifts {
  int step = 1;  ///< [cells]
  int reach = 0;
  std::vector<Shift> wide;  ///< the shortest first

  explicit Shifts(const MapLevel& level)
      : step(std::max(1, static_cast<int>(std::lround(kStep / level.resolution_m)))),
        reach(static_cast<int>(kReach / level.resolution_m) / step * step) {
    const int from = -reach / (2 * step) * (2 * step);
    for (int rows = from; rows <= reach; rows += 2 * step) {
      for (int columns = from; columns <= reach; columns += 2 * step) {
        if (length2({columns, rows}) <= reach * reach) {
          wide.push_back({columns, rows});
        }
      }
    }
    std::stable_sort(wide.begin(), wide.end(), [](const Shift& a, const Shift& b) { return length2(a) < length2(b); });
  }

  [[nodiscard]] std::vector<Shift> beside(const Shift& best) const {
    std::vector<Shift> narrow;
    for (const int rows : {0, -step, step}) {
      for (const int columns : {0, -step, step}) {
        const Shift shift{best.columns + columns, best.rows + rows};
        if ((rows != 0 || columns != 0) && length2(shift) <= reach * reach) {
          narrow.push_back(shift);
        }
      }
    }
    return narrow;
  }

 private:
  static int length2(const Shift& shift) { return shift.columns * shift.columns + shift.rows * shift.rows; }
};

using PatchIndex = std::pair<int, int>;

/// A wall of the moving map, in the fixed map's cells.
struct PlacedWall {
  int column = 0;
  int row = 0;
  std::uint8_t sides = 0;  ///< bits of SidedMap::seen_from that are its own; all where its side is not known
  double same_side = 0;    ///< what it counts where one of them is set
  bool is_fixture = false;
};

bool is_fixture(const SidedWall& wall) { return wall.piece == Piece::kFittings || wall.piece == Piece::kWall; }

/// The walls of the moving map that fall on what the fixed one knows, by patch.
std::map<PatchIndex, std::vector<PlacedWall>> patches_of(const SidedMap& moving, const MapLevel& level,
                                                         const Pose2& level_from_moving) {
  const ToCells to(level, level_from_moving);
  const int turn = turn_64ths(level_from_moving);
  std::map<PatchIndex, std::vector<PlacedWall>> patches;
  for (const SidedWall& wall : moving.walls) {
    const int column = to.column(wall.at);
    const int row = to.row(wall.at);
    if (level.contains(column, row) && level.state[level.offset(column, row)] != CellState::kUnseen) {
      patches[{static_cast<int>(std::floor(wall.at.x_m / kPatch)), static_cast<int>(std::floor(wall.at.y_m / kPatch))}]
          .push_back({column, row, sides_of(wall, turn), wall.side.known ? 1 : 0.5, is_fixture(wall)});
    }
  }
  return patches;
}

/// What a patch meets at one shift, in walls.
struct Met {
  double same_side = 0;
  double in_free = 0;

  [[nodiscard]] double gain() const { return same_side - in_free; }
};

/// The same of all of its walls, and of those in pieces that nobody moves.
struct MetBy {
  Met all;
  Met fixtures;
};

/// The best shift so far, and what is met there.
struct BestShift {
  Shift shift;
  Met met;
  double gain = -std::numeric_limits<double>::infinity();

  void try_one(const Shift& other, const Met& met_there) {
    if (met_there.gain() > gain) {
      *this = {other, met_there, met_there.gain()};
    }
  }
};

}  // namespace

ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving,
                                double tolerance_m) {
  const MapLevel& level = fixed.map->level(0);
  const auto clear_m = static_cast<float>(0.5 * tolerance_m + level.resolution_m);
  const Shifts shifts(level);
  const auto met_at = [&](const std::vector<PlacedWall>& walls, std::size_t every, const Shift& shift) {
    MetBy met;
    for (std::size_t i = 0; i < walls.size(); i += every) {
      const int column = walls[i].column + shift.columns;
      const int row = walls[i].row + shift.rows;
      if (!level.contains(column, row)) {
        continue;
      }
      const std::size_t at = level.offset(column, row);
      if (const std::uint8_t seen_from = fixed.seen_from_near[at]; seen_from != 0) {
        const double same = (seen_from & walls[i].sides) != 0 ? walls[i].same_side : 0;
        met.all.same_side += same;
        met.fixtures.same_side += walls[i].is_fixture ? same : 0;
      } else if (level.state[at] == CellState::kOpen && level.wall_distance_m[at] > clear_m) {
        met.all.in_free += 1;
        met.fixtures.in_free += walls[i].is_fixture ? 1 : 0;
      }
    }
    return met;
  };

  struct Shifted {
    Shift shift;
    double walls_m = 0;
  };
  ElasticMeeting all;
  std::map<PatchIndex, Shifted> shifted;
  for (const auto& [patch, walls] : patches_of(moving, level, fixed_from_moving)) {
    const double walls_m = static_cast<double>(walls.size()) * moving.metres_a_wall;
    if (walls_m < kLeastWalls) {
      continue;
    }
    const std::size_t every = (walls.size() + kMostInAPatch - 1) / kMostInAPatch;
    BestShift best;
    BestShift of_fixtures;
    const auto look_at = [&](const std::vector<Shift>& some) {
      for (const Shift& shift : some) {
        const MetBy met = met_at(walls, every, shift);
        best.try_one(shift, met.all);
        of_fixtures.try_one(shift, met.fixtures);
      }
    };
    look_at(shifts.wide);
    const Shift wide = best.shift;
    const Shift wide_of_fixtures = of_fixtures.shift;
    look_at(shifts.beside(wide));
    if (wide_of_fixtures != wide) {
      look_at(shifts.beside(wide_of_fixtures));
    }
    const double unit_m = moving.metres_a_wall * static_cast<double>(every);
    all.same_side_m += best.met.same_side * unit_m;
    all.in_free_m += best.met.in_free * unit_m;
    const auto fixtures =
        std::count_if(walls.begin(), walls.end(), [](const PlacedWall& one) { return one.is_fixture; });
    const double fixtures_m = static_cast<double>(fixtures) * moving.metres_a_wall;
    if (fixtures_m >= kLeastWalls) {
      shifted[patch] = {of_fixtures.shift, fixtures_m};
    }
  }
  for (const auto& [patch, one] : shifted) {
    for (const PatchIndex& beside : {PatchIndex{patch.first + 1, patch.second}, {patch.first, patch.second + 1}}) {
      if (const auto other = shifted.find(beside); other != shifted.end()) {
        const double walls_m = std::min(one.walls_m, other->second.walls_m);
        const double apart_m = level.resolution_m * std::hypot(one.shift.columns - other->second.shift.columns,
                                                               one.shift.rows - other->second.shift.rows);
        all.shift_m += walls_m * apart_m;
        all.beside_m += walls_m;
      }
    }
  }
  return all;
}

}  // namespace gridmerge
