#include "gridmerge/judge/elastic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace gridmerge {
namespace {

constexpr double kPatch = 4;               // [m] side of a patch
constexpr double kReach = 0.4;             // [m] how far off its expected place a patch is looked for ...
constexpr double kStep = 0.1;              // [m]
constexpr double kTurn = 0.035;            // [rad] ... and how far turned
constexpr double kLeastWalls = 1;          // [m] of a patch that counts
constexpr std::size_t kMostInAPatch = 60;  // walls that are looked at
constexpr double kLeastSaid = 0.05;        // [m] of others, by a patch without walls or fittings that fit

/// Where a patch went: its centre by so many cells of the fixed map, and turned about it.
struct Bend {
  double columns = 0;
  double rows = 0;
  double turn_rad = 0;

  [[nodiscard]] bool at_the_place_of(const Bend& other) const { return columns == other.columns && rows == other.rows; }
};

/// A wall of the moving map, in the fixed map's cells.
struct PlacedWall {
  int column = 0;
  int row = 0;
  float right = 0;         ///< of the patch's centre, by so many cells
  float up = 0;            ///< likewise
  std::uint8_t sides = 0;  ///< bits of SidedMap::seen_from that are its own; all where its side is not known
  double same_side = 0;    ///< what it counts where one of them is set
  Piece piece = Piece::kWall;
};

bool is_fixture(Piece piece) { return piece == Piece::kFittings || piece == Piece::kWall; }

/// What walls meet as they lie, in walls.
struct Met {
  double same_side = 0;
  double in_free = 0;

  [[nodiscard]] double gain() const { return same_side - in_free; }
  void operator+=(const Met& other) {
    same_side += other.same_side;
    in_free += other.in_free;
  }
};

/// The same of a patch, and of some of its pieces.
struct PatchMet {
  Met all;
  Met fixtures;
  Met furniture;
};

struct BestBend {
  Bend bend;
  PatchMet met;
  double gain = -std::numeric_limits<double>::infinity();

  void try_one(const Bend& other, const PatchMet& met_there, double gain_there) {
    if (gain_there > gain) {
      *this = {other, met_there, gain_there};
    }
  }
};

/// Where the patches that lie already put another: the mean, by how much they say.
class Expectation {
 public:
  void hear(const Bend& bend, double weight) {
    sum_.columns += weight * bend.columns;
    sum_.rows += weight * bend.rows;
    sum_.turn_rad += weight * bend.turn_rad;
    weight_ += weight;
    loudest_ = std::max(loudest_, weight);
  }
  [[nodiscard]] double loudest() const { return loudest_; }
  [[nodiscard]] Bend bend() const {
    return weight_ > 0 ? Bend{sum_.columns / weight_, sum_.rows / weight_, sum_.turn_rad / weight_} : Bend{};
  }

 private:
  Bend sum_;
  double weight_ = 0;
  double loudest_ = 0;
};

struct Patch {
  int column = 0;  ///< of its centre
  int row = 0;
  std::vector<PlacedWall> walls;
  double fixtures_m = 0;
  std::pair<double, double> unbent;  ///< gain of fixtures, and of all, as the pose has it [walls]
  Expectation expected;

  /// Every so many-th wall is looked at.
  [[nodiscard]] std::size_t every() const { return (walls.size() + kMostInAPatch - 1) / kMostInAPatch; }
};

/// The walls of the moving map that fall on what the fixed one knows, by patch; those patches that count.
std::vector<Patch> patches_of(const SidedMap& moving, const MapLevel& level, const Pose2& level_from_moving) {
  const ToCells to(level, level_from_moving);
  const int turn = turn_64ths(level_from_moving);
  std::map<std::pair<int, int>, Patch> by_place;
  for (const SidedWall& wall : moving.walls) {
    const int column = to.column(wall.at);
    const int row = to.row(wall.at);
    if (!level.contains(column, row) || level.state[level.offset(column, row)] == CellState::kUnseen) {
      continue;
    }
    const double across = std::floor(wall.at.x_m / kPatch);
    const double along = std::floor(wall.at.y_m / kPatch);
    Patch& patch = by_place[{static_cast<int>(across), static_cast<int>(along)}];
    if (patch.walls.empty()) {
      const Point2f centre{static_cast<float>((across + 0.5) * kPatch), static_cast<float>((along + 0.5) * kPatch)};
      patch.column = to.column(centre);
      patch.row = to.row(centre);
    }
    patch.walls.push_back({column, row, static_cast<float>(column - patch.column), static_cast<float>(row - patch.row),
                           sides_of(wall, turn), wall.side.known ? 1 : 0.5, wall.piece});
    patch.fixtures_m += is_fixture(wall.piece) ? moving.metres_a_wall : 0;
  }
  std::vector<Patch> patches;
  for (auto& [place, patch] : by_place) {
    if (static_cast<double>(patch.walls.size()) * moving.metres_a_wall >= kLeastWalls) {
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

/// Lays patches on the fixed map.
class Ground {
 public:
  Ground(const SidedMap& fixed, double tolerance_m)
      : fixed_(fixed),
        level_(fixed.map->level(0)),
        clear_m_(static_cast<float>(0.5 * tolerance_m + level_.resolution_m)),
        step_(std::max(1, static_cast<int>(std::lround(kStep / level_.resolution_m)))) {
    const int reach = static_cast<int>(std::lround(kReach / level_.resolution_m)) / (2 * step_) * (2 * step_);
    for (int rows = -reach; rows <= reach; rows += 2 * step_) {
      for (int columns = -reach; columns <= reach; columns += 2 * step_) {
        if (columns * columns + rows * rows <= reach * reach) {
          wide_.push_back({static_cast<double>(columns), static_cast<double>(rows), 0});
        }
      }
    }
    // The shortest first: of equal ones it is taken.
    std::stable_sort(wide_.begin(), wide_.end(), [](const Bend& a, const Bend& b) {
      return a.columns * a.columns + a.rows * a.rows < b.columns * b.columns + b.rows * b.rows;
    });
  }

  [[nodiscard]] PatchMet met(const Patch& patch, const Bend& bend) const {
    PatchMet met;
    const int columns = static_cast<int>(std::lround(bend.columns));
    const int rows = static_cast<int>(std::lround(bend.rows));
    const auto turn = static_cast<float>(bend.turn_rad);
    const std::size_t every = patch.every();
    for (std::size_t i = 0; i < patch.walls.size(); i += every) {
      const PlacedWall& wall = patch.walls[i];
      const int column = wall.column + columns - static_cast<int>(std::lrint(turn * wall.up));
      const int row = wall.row + rows + static_cast<int>(std::lrint(turn * wall.right));
      if (!level_.contains(column, row)) {
        continue;
      }
      const std::size_t at = level_.offset(column, row);
      Met here;
      if (const std::uint8_t seen_from = fixed_.seen_from_near[at]; seen_from != 0) {
        here.same_side = (seen_from & wall.sides) != 0 ? wall.same_side : 0;
      } else if (level_.state[at] == CellState::kOpen && level_.wall_distance_m[at] > clear_m_) {
        here.in_free = 1;
      }
      met.all += here;
      if (is_fixture(wall.piece)) {
        met.fixtures += here;
      } else if (wall.piece == Piece::kFurniture) {
        met.furniture += here;
      }
    }
    return met;
  }

  struct Laid {
    BestBend by_all;
    BestBend by_fixtures;
  };

  /// By two steps around where it is expected, then by one and turned beside the best. Walls are as wide as the
  /// tolerance makes them, so none is stepped over.
  [[nodiscard]] Laid lay(const Patch& patch, const Bend& expected) const {
    Laid laid;
    const auto look_at = [&](const Bend& bend) {
      const PatchMet here = met(patch, bend);
      laid.by_all.try_one(bend, here, here.all.gain());
      laid.by_fixtures.try_one(bend, here, here.fixtures.gain());
    };
    for (const Bend& off : wide_) {
      look_at({expected.columns + off.columns, expected.rows + off.rows, expected.turn_rad});
    }
    const auto beside_the_best = [&](const auto& look_beside) {
      const Bend of_all = laid.by_all.bend;
      const Bend of_fixtures = laid.by_fixtures.bend;
      look_beside(of_all);
      if (!of_fixtures.at_the_place_of(of_all)) {
        look_beside(of_fixtures);
      }
    };
    beside_the_best([&](const Bend& best) {
      for (const int rows : {0, -step_, step_}) {
        for (const int columns : {0, -step_, step_}) {
          if (rows != 0 || columns != 0) {
            look_at({best.columns + columns, best.rows + rows, best.turn_rad});
          }
        }
      }
    });
    beside_the_best([&](const Bend& best) {
      look_at({best.columns, best.rows, best.turn_rad - kTurn});
      look_at({best.columns, best.rows, best.turn_rad + kTurn});
    });
    return laid;
  }

  /// Tells those that are left where they would be if they hung together with this one.
  void tell(std::vector<Patch*>& left, const Patch& from, const Bend& went, double said_m) const {
    const double patch_cells = kPatch / level_.resolution_m;
    for (Patch* other : left) {
      const double right = other->column - from.column;
      const double up = other->row - from.row;
      const double patches_away = std::max(1.0, std::hypot(right, up) / patch_cells);
      other->expected.hear({went.columns - went.turn_rad * up, went.rows + went.turn_rad * right, went.turn_rad},
                           said_m / std::pow(patches_away, 4));
    }
  }

  [[nodiscard]] double metres(double columns, double rows) const {
    return level_.resolution_m * std::hypot(columns, rows);
  }

 private:
  const SidedMap& fixed_;
  const MapLevel& level_;
  float clear_m_;
  int step_;  ///< [cells]
  std::vector<Bend> wide_;
};

/// Takes out the one that has the most of something; of equal ones the first.
template <typename Much>
Patch* take_most(std::vector<Patch*>& left, const Much& much) {
  const auto most =
      std::max_element(left.begin(), left.end(), [&](const Patch* a, const Patch* b) { return much(*a) < much(*b); });
  Patch* const taken = *most;
  left.erase(most);
  return taken;
}

}  // namespace

ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving,
                                double tolerance_m) {
  const Ground ground(fixed, tolerance_m);
  std::vector<Patch> patches = patches_of(moving, fixed.map->level(0), fixed_from_moving);
  std::vector<Patch*> left;
  for (Patch& patch : patches) {
    const PatchMet met = ground.met(patch, {});
    const auto every = static_cast<double>(patch.every());
    patch.unbent = {every * met.fixtures.gain(), every * met.all.gain()};
    left.push_back(&patch);
  }
  ElasticMeeting all;
  for (bool first = true; !left.empty(); first = false) {
    const Patch& patch = *take_most(left, [&](const Patch& one) {
      return first ? one.unbent : std::pair{one.expected.loudest(), 0.0};
    });
    const Bend expected = patch.expected.bend();
    const Ground::Laid laid = ground.lay(patch, expected);
    const double unit_m = moving.metres_a_wall * static_cast<double>(patch.every());
    const PatchMet& met = laid.by_all.met;
    all.same_side_m += met.all.same_side * unit_m;
    all.in_free_m += met.all.in_free * unit_m;
    all.furniture_same_side_m += met.furniture.same_side * unit_m;
    all.furniture_in_free_m += met.furniture.in_free * unit_m;
    const bool has_fixtures = patch.fixtures_m >= kLeastWalls;
    const BestBend& went = has_fixtures ? laid.by_fixtures : laid.by_all;
    if (has_fixtures && !first) {
      all.astray_m2 +=
          patch.fixtures_m * ground.metres(went.bend.columns - expected.columns, went.bend.rows - expected.rows);
      all.expected_m += patch.fixtures_m;
    }
    ground.tell(left, patch, went.bend, kLeastSaid + (has_fixtures ? std::max(0.0, went.gain) * unit_m : 0));
  }
  return all;
}

}  // namespace gridmerge
