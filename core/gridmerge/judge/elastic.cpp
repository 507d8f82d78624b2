#include "gridmerge/judge/elastic.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace gridmerge {
namespace {

constexpr double kPatch = 4;                // [m] side of a patch
constexpr double kReach = 0.6;              // [m] how far a patch may shift
constexpr double kStep = 0.1;               // [m]
constexpr double kLeastWalls = 1;           // [m] of a patch that counts
constexpr std::size_t kMostInAPatch = 120;  // walls that are looked at

struct Shift {
  int columns = 0;
  int rows = 0;
};

/// All shifts within reach, the shortest first.
std::vector<Shift> shifts_of(const MapLevel& level) {
  const int step = std::max(1, static_cast<int>(std::lround(kStep / level.resolution_m)));
  const int reach = static_cast<int>(kReach / level.resolution_m) / step * step;
  std::vector<Shift> shifts;
  for (int rows = -reach; rows <= reach; rows += step) {
    for (int columns = -reach; columns <= reach; columns += step) {
      if (columns * columns + rows * rows <= reach * reach) {
        shifts.push_back({columns, rows});
      }
    }
  }
  const auto length2 = [](const Shift& shift) { return shift.columns * shift.columns + shift.rows * shift.rows; };
  std::stable_sort(shifts.begin(), shifts.end(),
                   [&](const Shift& a, const Shift& b) { return length2(a) < length2(b); });
  return shifts;
}

using PatchIndex = std::pair<int, int>;

/// A wall of the moving map, in the fixed map's cells.
struct PlacedWall {
  int column = 0;
  int row = 0;
  const SidedWall* wall = nullptr;
};

/// The walls of the moving map that fall on what the fixed one knows, by patch.
std::map<PatchIndex, std::vector<PlacedWall>> patches_of(const SidedMap& moving, const MapLevel& level,
                                                         const ToCells& to) {
  std::map<PatchIndex, std::vector<PlacedWall>> patches;
  for (const SidedWall& wall : moving.walls) {
    const int column = to.column(wall.at);
    const int row = to.row(wall.at);
    if (level.contains(column, row) && level.state[level.offset(column, row)] != CellState::kUnseen) {
      patches[{static_cast<int>(std::floor(wall.at.x_m / kPatch)), static_cast<int>(std::floor(wall.at.y_m / kPatch))}]
          .push_back({column, row, &wall});
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

bool is_fixture(const SidedWall& wall) { return wall.piece == Piece::kFittings || wall.piece == Piece::kWall; }

}  // namespace

ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving,
                                double tolerance_m) {
  const MapLevel& level = fixed.map->level(0);
  const ToCells to(level, fixed_from_moving);
  const int turn = turn_64ths(fixed_from_moving);
  const auto clear_m = static_cast<float>(0.5 * tolerance_m + level.resolution_m);
  const std::vector<Shift> shifts = shifts_of(level);
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
        const double same = same_side(*walls[i].wall, seen_from, turn);
        met.all.same_side += same;
        met.fixtures.same_side += is_fixture(*walls[i].wall) ? same : 0;
      } else if (level.state[at] == CellState::kOpen && level.wall_distance_m[at] > clear_m) {
        met.all.in_free += 1;
        met.fixtures.in_free += is_fixture(*walls[i].wall) ? 1 : 0;
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
  for (const auto& [patch, walls] : patches_of(moving, level, to)) {
    const double walls_m = static_cast<double>(walls.size()) * moving.metres_a_wall;
    if (walls_m < kLeastWalls) {
      continue;
    }
    const std::size_t every = (walls.size() + kMostInAPatch - 1) / kMostInAPatch;
    Met best;
    Shift of_fixtures;
    double most = -std::numeric_limits<double>::infinity();
    double most_of_fixtures = most;
    for (const Shift& shift : shifts) {
      const MetBy met = met_at(walls, every, shift);
      if (met.all.gain() > most) {
        most = met.all.gain();
        best = met.all;
      }
      if (met.fixtures.gain() > most_of_fixtures) {
        most_of_fixtures = met.fixtures.gain();
        of_fixtures = shift;
      }
    }
    const double unit_m = moving.metres_a_wall * static_cast<double>(every);
    all.same_side_m += best.same_side * unit_m;
    all.in_free_m += best.in_free * unit_m;
    const auto fixtures =
        std::count_if(walls.begin(), walls.end(), [](const PlacedWall& one) { return is_fixture(*one.wall); });
    const double fixtures_m = static_cast<double>(fixtures) * moving.metres_a_wall;
    if (fixtures_m >= kLeastWalls) {
      shifted[patch] = {of_fixtures, fixtures_m};
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
