#include "gridmerge/judge/elastic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace gridmerge {
namespace {

constexpr float kPatch = 4;                // [m] side of a patch
constexpr double kReach = 0.4;             // [m] how far off its expected place a patch is looked for ...
constexpr double kStep = 0.1;              // [m]
constexpr double kTurn = 0.035;            // [rad] ... and how far turned
constexpr double kTurnUnit = kTurn / 8;    // [rad] of an expected turn: the far end of a patch moves by 1 cm
constexpr double kLeastWalls = 1;          // [m] of a patch that counts
constexpr std::size_t kMostInAPatch = 60;  // walls that are looked at
constexpr double kLeastSaid = 0.05;        // [m] of others, by a patch without walls or fittings that fit
constexpr std::size_t kSeeds = 2;          // patches from which the others are laid
constexpr double kSeedsApart = 12;         // [m]

/// Where a patch went: its centre by so many cells of the fixed map, and turned about it.
struct Bend {
  int columns = 0;
  int rows = 0;
  double turn_rad = 0;

  [[nodiscard]] bool at_the_place_of(const Bend& other) const { return columns == other.columns && rows == other.rows; }
};

/// What is asked of pieces: walls and fittings alone say where a patch goes.
enum class Part : std::uint8_t { kFixtures, kFurniture, kLegs };

Part part_of(Piece piece) {
  switch (piece) {
    case Piece::kLegs:
      return Part::kLegs;
    case Piece::kFurniture:
      return Part::kFurniture;
    default:
      return Part::kFixtures;
  }
}

/// A wall of the moving map, in the fixed map's cells.
struct PlacedWall {
  int column = 0;
  int row = 0;
  std::uint8_t sides = 0;   ///< bits of SidedMap::seen_from that are its own; all where its side is not known
  std::uint8_t halves = 0;  ///< of a wall, that it counts where one of them is set
  Part part = Part::kFixtures;
};

/// What walls meet as they lie, in half walls.
struct Met {
  int same_side = 0;
  int in_free = 0;

  [[nodiscard]] int gain() const { return same_side - in_free; }
};

/// The same of a patch.
struct PatchMet {
  std::array<Met, 3> parts;  ///< by Part

  [[nodiscard]] const Met& of(Part part) const { return parts[static_cast<std::size_t>(part)]; }
  [[nodiscard]] Met all() const {
    return {parts[0].same_side + parts[1].same_side + parts[2].same_side,
            parts[0].in_free + parts[1].in_free + parts[2].in_free};
  }
};

struct BestBend {
  Bend bend;
  PatchMet met;
  int gain = std::numeric_limits<int>::min();

  void try_one(const Bend& other, const PatchMet& met_there, int gain_there) {
    if (gain_there > gain) {
      *this = {other, met_there, gain_there};
    }
  }
};

struct Patch {
  int column = 0;  ///< of its centre
  int row = 0;
  std::vector<PlacedWall> walls;  ///< of many, every so many-th; by part
  double half_wall_m = 0;         ///< that half of one of them stands for
  // As the pose has it, where the fixed map knows:
  double known_m = 0;
  double fixtures_m = 0;

  [[nodiscard]] bool has_fixtures() const { return fixtures_m >= kLeastWalls; }
};

/// Keeps every so many-th wall, so that there are not too many, in the order of their parts.
void thin_out(Patch& patch, double metres_a_wall) {
  const std::size_t every = (patch.walls.size() + kMostInAPatch - 1) / kMostInAPatch;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < patch.walls.size(); i += every) {
    patch.walls[kept++] = patch.walls[i];
  }
  patch.walls.resize(kept);
  std::stable_sort(patch.walls.begin(), patch.walls.end(),
                   [](const PlacedWall& a, const PlacedWall& b) { return a.part < b.part; });
  patch.half_wall_m = 0.5 * metres_a_wall * static_cast<double>(every);
}

/// The walls of the moving map by patch; those patches that count. Of these all walls: what the fixed map does not know
/// as the pose has it (a wall's far side, most often) it may know where the patch goes.
std::vector<Patch> patches_of(const SidedMap& moving, const MapLevel& level, const Pose2& level_from_moving) {
  const ToCells to(level, level_from_moving);
  const int turn = turn_64ths(level_from_moving);
  std::map<std::pair<int, int>, Patch> by_place;
  std::pair<int, int> last;
  Patch* patch = nullptr;
  for (const SidedWall& wall : moving.walls) {
    const int column = to.column(wall.at);
    const int row = to.row(wall.at);
    if (!level.contains(column, row)) {
      continue;
    }
    const std::pair<int, int> place{ToCells::cell(wall.at.x_m / kPatch), ToCells::cell(wall.at.y_m / kPatch)};
    if (patch == nullptr || place != last) {  // walls come row by row: most are of the same patch as the one before
      last = place;
      patch = &by_place[place];
    }
    if (patch->walls.empty()) {
      const Point2f centre{kPatch * (static_cast<float>(place.first) + 0.5F),
                           kPatch * (static_cast<float>(place.second) + 0.5F)};
      patch->column = to.column(centre);
      patch->row = to.row(centre);
    }
    const Part part = part_of(wall.piece);
    patch->walls.push_back(
        {column, row, sides_of(wall, turn), wall.side.known ? std::uint8_t{2} : std::uint8_t{1}, part});
    if (level.state[level.offset(column, row)] != CellState::kUnseen) {
      patch->known_m += moving.metres_a_wall;
      patch->fixtures_m += part == Part::kFixtures ? moving.metres_a_wall : 0;
    }
  }
  std::vector<Patch> patches;
  for (auto& [place, found] : by_place) {
    if (found.known_m >= kLeastWalls) {
      thin_out(found, moving.metres_a_wall);
      patches.push_back(std::move(found));
    }
  }
  return patches;
}

/// Its walls when it is turned about its centre.
std::vector<PlacedWall> turned(const Patch& patch, double turn_rad) {
  const auto nearest = [turn = static_cast<float>(turn_rad)](int cells) {
    return ToCells::cell(turn * static_cast<float>(cells) + 0.5F);
  };
  std::vector<PlacedWall> walls = patch.walls;
  for (PlacedWall& wall : walls) {
    const int right = wall.column - patch.column;
    const int up = wall.row - patch.row;
    wall.column -= nearest(up);
    wall.row += nearest(right);
  }
  return walls;
}

/// Lays patches on the fixed map.
class Ground {
 public:
  explicit Ground(const SidedMap& fixed)
      : fixed_(fixed),
        level_(fixed.map->level(0)),
        step_(std::max(1, static_cast<int>(std::lround(kStep / level_.resolution_m)))) {
    const int reach = static_cast<int>(std::lround(kReach / level_.resolution_m)) / (2 * step_) * (2 * step_);
    for (int rows = -reach; rows <= reach; rows += 2 * step_) {
      for (int columns = -reach; columns <= reach; columns += 2 * step_) {
        if (columns * columns + rows * rows <= reach * reach) {
          wide_.push_back({columns, rows});
        }
      }
    }
    // The shortest first: of equal ones it is taken.
    std::stable_sort(wide_.begin(), wide_.end(), [](const Bend& a, const Bend& b) {
      return a.columns * a.columns + a.rows * a.rows < b.columns * b.columns + b.rows * b.rows;
    });
  }

  [[nodiscard]] PatchMet met(const std::vector<PlacedWall>& walls, const Bend& shifted) const {
    PatchMet met;
    // Nothing here is decided by a branch that could be mispredicted: it is asked for millions of walls.
    for (auto wall = walls.begin(); wall != walls.end();) {
      const Part part = wall->part;
      Met here;
      for (; wall != walls.end() && wall->part == part; ++wall) {
        const int column = wall->column + shifted.columns;
        const int row = wall->row + shifted.rows;
        if (level_.contains(column, row)) {
          const std::size_t at = level_.offset(column, row);
          here.same_side += static_cast<int>((fixed_.seen_from_near[at] & wall->sides) != 0) * wall->halves;
          here.in_free += 2 * fixed_.clear_of_near[at];
        }
      }
      met.parts[static_cast<std::size_t>(part)] = here;
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
    const auto look_at = [&](const std::vector<PlacedWall>& walls, const Bend& bend) {
      const PatchMet here = met(walls, bend);
      laid.by_all.try_one(bend, here, here.all().gain());
      laid.by_fixtures.try_one(bend, here, here.of(Part::kFixtures).gain());
    };
    const std::vector<PlacedWall> as_expected = turned(patch, expected.turn_rad);
    for (const Bend& off : wide_) {
      look_at(as_expected, {expected.columns + off.columns, expected.rows + off.rows, expected.turn_rad});
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
            look_at(as_expected, {best.columns + columns, best.rows + rows, best.turn_rad});
          }
        }
      }
    });
    for (const double turn_rad : {expected.turn_rad - kTurn, expected.turn_rad + kTurn}) {
      const std::vector<PlacedWall> more_turned = turned(patch, turn_rad);
      beside_the_best([&](const Bend& best) { look_at(more_turned, {best.columns, best.rows, turn_rad}); });
    }
    return laid;
  }

  [[nodiscard]] double cells(double metres) const { return metres / level_.resolution_m; }
  [[nodiscard]] double metres(int columns, int rows) const { return level_.resolution_m * std::hypot(columns, rows); }

 private:
  const SidedMap& fixed_;
  const MapLevel& level_;
  int step_;  ///< [cells]
  std::vector<Bend> wide_;
};

/// Lays all patches, from one of them on.
class Layout {
 public:
  Layout(const Ground& ground, const std::vector<Patch>& patches)
      : ground_(ground), patches_(patches), patch_cells_(ground.cells(kPatch)) {}

  [[nodiscard]] ElasticMeeting from(std::size_t seed) {
    lying_.assign(patches_.size(), {});
    std::vector<std::size_t> order;
    std::vector<double> told(patches_.size());  // the most that one of those that lie says about each
    for (std::size_t next = seed; order.size() < patches_.size();
         next = static_cast<std::size_t>(std::max_element(told.begin(), told.end()) - told.begin())) {
      lay(next);
      order.push_back(next);
      for (std::size_t other = 0; other < patches_.size(); ++other) {
        told[other] = lying_[other].lies() ? -1 : std::max(told[other], said(next, other));
      }
    }
    // Once more, each where all others put it: the first ones were laid by few.
    for (const std::size_t patch : order) {
      lay(patch);
    }
    ElasticMeeting all;
    for (const Lying& one : lying_) {
      all += one.meeting;
    }
    return all;
  }

 private:
  struct Lying {
    Bend bend;
    double says_m = 0;  ///< to others; 0: it does not lie yet
    ElasticMeeting meeting;

    [[nodiscard]] bool lies() const { return says_m > 0; }
  };

  /// By how much the one is heard by the other.
  [[nodiscard]] double said(std::size_t from, std::size_t to) const {
    const double right = (patches_[to].column - patches_[from].column) / patch_cells_;
    const double up = (patches_[to].row - patches_[from].row) / patch_cells_;
    const double square = std::max(1.0, right * right + up * up);
    return lying_[from].says_m / (square * square);
  }

  /// Where those that lie put it, moved and turned as they are: the mean, by how much they say. None: no other
  /// lies.
  [[nodiscard]] std::optional<Bend> expected(std::size_t patch) const {
    double columns = 0;
    double rows = 0;
    double turn_rad = 0;
    double weight = 0;
    for (std::size_t other = 0; other < patches_.size(); ++other) {
      if (other == patch) {
        continue;
      }
      const Bend& went = lying_[other].bend;
      const double right = patches_[patch].column - patches_[other].column;
      const double up = patches_[patch].row - patches_[other].row;
      const double says = said(other, patch);
      columns += says * (went.columns - went.turn_rad * up);
      rows += says * (went.rows + went.turn_rad * right);
      turn_rad += says * went.turn_rad;
      weight += says;
    }
    if (weight <= 0) {
      return std::nullopt;
    }
    return Bend{static_cast<int>(std::lround(columns / weight)), static_cast<int>(std::lround(rows / weight)),
                kTurnUnit * std::round(turn_rad / weight / kTurnUnit)};
  }

  void lay(std::size_t index) {
    const Patch& patch = patches_[index];
    const std::optional<Bend> told = expected(index);
    const Bend where = told.value_or(Bend{});
    const Ground::Laid best = ground_.lay(patch, where);
    const Met all = best.by_all.met.all();
    const Met& furniture = best.by_all.met.of(Part::kFurniture);
    const BestBend& went = patch.has_fixtures() ? best.by_fixtures : best.by_all;
    Lying& lying = lying_[index];
    lying.meeting = {.same_side_m = patch.half_wall_m * all.same_side,
                     .in_free_m = patch.half_wall_m * all.in_free,
                     .furniture_same_side_m = patch.half_wall_m * furniture.same_side,
                     .furniture_in_free_m = patch.half_wall_m * furniture.in_free};
    if (patch.has_fixtures() && told) {
      lying.meeting.astray_m2 =
          patch.fixtures_m * ground_.metres(went.bend.columns - where.columns, went.bend.rows - where.rows);
      lying.meeting.expected_m = patch.fixtures_m;
    }
    lying.bend = went.bend;
    lying.says_m = kLeastSaid + (patch.has_fixtures() ? patch.half_wall_m * std::max(0, went.gain) : 0);
  }

  const Ground& ground_;
  const std::vector<Patch>& patches_;
  double patch_cells_;
  std::vector<Lying> lying_;
};

/// The patches that fit best as the pose has it, far from each other: a layout that went astray from one need not from
/// another.
std::vector<std::size_t> seeds(const Ground& ground, const std::vector<Patch>& patches) {
  std::vector<std::pair<double, double>> gains;  // of fixtures, and of all [m]
  for (const Patch& patch : patches) {
    const PatchMet met = ground.met(patch.walls, {});
    gains.emplace_back(patch.half_wall_m * met.of(Part::kFixtures).gain(), patch.half_wall_m * met.all().gain());
  }
  std::vector<std::size_t> ranked(patches.size());
  std::iota(ranked.begin(), ranked.end(), std::size_t{0});
  std::stable_sort(ranked.begin(), ranked.end(), [&](std::size_t a, std::size_t b) { return gains[a] > gains[b]; });
  std::vector<std::size_t> seeds;
  for (const std::size_t one : ranked) {
    const bool far = std::all_of(seeds.begin(), seeds.end(), [&](std::size_t seed) {
      return ground.metres(patches[seed].column - patches[one].column, patches[seed].row - patches[one].row) >=
             kSeedsApart;
    });
    if (far && seeds.size() < kSeeds) {
      seeds.push_back(one);
    }
  }
  return seeds;
}

}  // namespace

void ElasticMeeting::operator+=(const ElasticMeeting& other) {
  same_side_m += other.same_side_m;
  in_free_m += other.in_free_m;
  furniture_same_side_m += other.furniture_same_side_m;
  furniture_in_free_m += other.furniture_in_free_m;
  astray_m2 += other.astray_m2;
  expected_m += other.expected_m;
}

ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving) {
  const Ground ground(fixed);
  const std::vector<Patch> patches = patches_of(moving, fixed.map->level(0), fixed_from_moving);
  Layout layout(ground, patches);
  ElasticMeeting best;
  double most_m = -std::numeric_limits<double>::infinity();
  for (const std::size_t seed : seeds(ground, patches)) {
    const ElasticMeeting meeting = layout.from(seed);
    if (const double gain_m = meeting.same_side_m - meeting.in_free_m; gain_m > most_m) {
      most_m = gain_m;
      best = meeting;
    }
  }
  return best;
}

}  // namespace gridmerge
