#include "gridmerge/judge/elastic.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

namespace gridmerge {
namespace {

constexpr int kReach = PatchGround::kSteps;  // [steps] how far off its expected place a patch is looked for ...
constexpr double kTurn = 0.035;              // [rad] ... and how far turned
constexpr double kTurnUnit = kTurn / 8;      // [rad] of an expected turn: the far end of a patch moves by 1 cm
constexpr double kLeastWalls = 1;            // [m] of a patch that counts
constexpr double kLeastSaid = 0.05;          // [m] of others, by a patch without walls or fittings that fit
constexpr std::size_t kSeeds = 2;            // patches from which the others are laid
constexpr double kSeedsApart = 12;           // [m]
static_assert(2 * WallPatch::kMostWalls <= 255, "PatchGround counts half walls in bytes");

/// Where a patch went: its centre by so many cells of the fixed map, and turned about it.
struct Bend {
  int columns = 0;
  int rows = 0;
  double turn_rad = 0;

  [[nodiscard]] bool at_the_place_of(const Bend& other) const { return columns == other.columns && rows == other.rows; }
};

/// A wall of the moving map, in the fixed map's cells.
struct PlacedWall {
  int column = 0;
  int row = 0;
  std::uint8_t sides = 0;   ///< sides_of
  std::uint8_t halves = 0;  ///< of a wall, that it counts where one of them is set
  Part part = Part::kFixtures;
};

/// Of a patch.
struct PatchMet {
  std::array<Met, kParts> parts;  ///< by Part

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
  std::size_t index = 0;  ///< of SidedMap::patches
  int column = 0;         ///< of its centre
  int row = 0;
  double half_wall_m = 0;  ///< that half of one of its walls stands for
  std::vector<PlacedWall> walls;
  // As the pose has it, where the fixed map knows:
  double known_m = 0;
  double fixtures_m = 0;

  [[nodiscard]] bool has_fixtures() const { return fixtures_m >= kLeastWalls; }
};

/// Those that count, where the pose has them. Of these all walls: what the fixed map does not know as the pose has it
/// (a wall's far side, most often) it may know where the patch goes.
std::vector<Patch> placed(const std::vector<WallPatch>& moving, const MapLevel& level, const Pose2& level_from_moving) {
  const ToCells to(level, level_from_moving);
  const int turn = turn_64ths(level_from_moving);
  std::vector<Patch> patches;
  Patch patch;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const WallPatch& one = moving[i];
    patch = {.index = i,
             .column = to.column(one.centre),
             .row = to.row(one.centre),
             .half_wall_m = 0.5 * one.metres_a_wall,
             .walls = {}};
    for (const SidedWall& wall : one.walls) {
      const int column = to.column(wall.at);
      const int row = to.row(wall.at);
      if (!level.contains(column, row)) {
        continue;
      }
      const Part part = part_of(wall.piece);
      patch.walls.push_back(
          {column, row, sides_of(wall, turn), wall.side.known ? std::uint8_t{2} : std::uint8_t{1}, part});
      if (level.state[level.offset(column, row)] != CellState::kUnseen) {
        patch.known_m += one.metres_a_wall;
        patch.fixtures_m += part == Part::kFixtures ? one.metres_a_wall : 0;
      }
    }
    if (patch.known_m >= kLeastWalls) {
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

/// A patch on the ground: its walls where they touch, by part.
class Laid {
 public:
  void lay(const PatchGround& ground, const Patch& patch, const Bend& bend) {
    spots_.clear();
    ends_.fill(0);
    // Of some cells up or right, turned by a few degrees: rounded with a whole number of cells added, so that none is
    // negative.
    const auto nearest = [turn = static_cast<float>(bend.turn_rad)](int cells) {
      constexpr int kAdded = 1024;
      return static_cast<int>(turn * static_cast<float>(cells) + (kAdded + 0.5F)) - kAdded;
    };
    for (const PlacedWall& wall : patch.walls) {
      const int column = wall.column + bend.columns - nearest(wall.row - patch.row);
      const int row = wall.row + bend.rows + nearest(wall.column - patch.column);
      if (ground.touches(column, row)) {
        spots_.push_back({ground.first_of(column, row), wall.sides, wall.halves});
        ends_[static_cast<std::size_t>(wall.part)] = spots_.size();
      }
    }
    for (std::size_t part = 1; part < kParts; ++part) {
      ends_[part] = std::max(ends_[part], ends_[part - 1]);
    }
  }

  /// Its spots of one part; walls come part by part.
  [[nodiscard]] std::span<const PatchGround::Spot> of(std::size_t part) const {
    const std::size_t begin = part > 0 ? ends_[part - 1] : 0;
    return std::span(spots_).subspan(begin, ends_[part] - begin);
  }

 private:
  std::vector<PatchGround::Spot> spots_;
  std::array<std::size_t, kParts> ends_{};
};

/// How far off, in steps.
struct Place {
  int columns = 0;
  int rows = 0;

  [[nodiscard]] int square() const { return columns * columns + rows * rows; }
};

/// The nearest first: of equally good ones it is taken.
const std::vector<Place>& places_in_reach() {
  static const std::vector<Place> all = [] {
    std::vector<Place> places;
    for (int rows = -kReach; rows <= kReach; ++rows) {
      for (int columns = -kReach; columns <= kReach; ++columns) {
        if (const Place place{columns, rows}; place.square() <= kReach * kReach) {
          places.push_back(place);
        }
      }
    }
    std::stable_sort(places.begin(), places.end(),
                     [](const Place& a, const Place& b) { return a.square() < b.square(); });
    return places;
  }();
  return all;
}

/// Lays patches on the fixed map.
class Layer {
 public:
  explicit Layer(const SidedMap& fixed) : ground_(fixed.ground), level_(fixed.map->level(0)) {}

  [[nodiscard]] PatchMet met(const Patch& patch, const Bend& bend) {
    laid_.lay(ground_, patch, bend);
    PatchMet met;
    for (std::size_t part = 0; part < kParts; ++part) {
      met.parts[part] = ground_.met(laid_.of(part));
    }
    return met;
  }

  struct Best {
    BestBend by_all;
    BestBend by_fixtures;
  };

  /// At all places around where it is expected, then turned at the best.
  [[nodiscard]] Best best(const Patch& patch, const Bend& expected) {
    Best best;
    const auto look_at = [&](const Bend& bend, const PatchMet& here) {
      best.by_all.try_one(bend, here, here.all().gain());
      best.by_fixtures.try_one(bend, here, here.of(Part::kFixtures).gain());
    };
    laid_.lay(ground_, patch, expected);
    std::array<PatchGround::Tally, kParts> tallies;
    for (std::size_t part = 0; part < kParts; ++part) {
      tallies[part] = ground_.around(laid_.of(part));
    }
    const int step = ground_.step_cells();
    for (const Place& place : places_in_reach()) {
      PatchMet here;
      for (std::size_t part = 0; part < kParts; ++part) {
        here.parts[part] = tallies[part].at(static_cast<std::size_t>(place.rows + kReach),
                                            static_cast<std::size_t>(place.columns + kReach));
      }
      look_at({expected.columns + step * place.columns, expected.rows + step * place.rows, expected.turn_rad}, here);
    }
    const Bend of_all = best.by_all.bend;
    const Bend of_fixtures = best.by_fixtures.bend;
    for (const double turn_rad : {expected.turn_rad - kTurn, expected.turn_rad + kTurn}) {
      for (const Bend& at : {of_all, of_fixtures}) {
        const Bend turned{at.columns, at.rows, turn_rad};
        look_at(turned, met(patch, turned));
        if (of_fixtures.at_the_place_of(of_all)) {
          break;
        }
      }
    }
    return best;
  }

  /// Local frame.
  [[nodiscard]] Point2 centre_of(CellIndex cell) const {
    return {level_.lower_left.x_m + (cell.column + 0.5) * level_.resolution_m,
            level_.lower_left.y_m + (cell.row + 0.5) * level_.resolution_m};
  }
  [[nodiscard]] double cells(double metres) const { return metres / level_.resolution_m; }
  [[nodiscard]] double metres(int columns, int rows) const { return level_.resolution_m * std::hypot(columns, rows); }

 private:
  const PatchGround& ground_;
  const MapLevel& level_;
  Laid laid_;  ///< what is laid just now
};

/// Lays all patches, from one of them on.
class Layout {
 public:
  Layout(Layer& layer, const std::vector<Patch>& patches) : layer_(layer), patches_(patches) {
    const auto n = static_cast<Eigen::Index>(patches.size());
    Eigen::ArrayXd columns(n);
    Eigen::ArrayXd rows(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      columns(i) = patches[static_cast<std::size_t>(i)].column / layer.cells(WallPatch::kSide_m);
      rows(i) = patches[static_cast<std::size_t>(i)].row / layer.cells(WallPatch::kSide_m);
    }
    heard_.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      heard_.col(i) = ((columns - columns(i)).square() + (rows - rows(i)).square()).max(1).square().inverse();
      heard_(i, i) = 0;
    }
  }

  [[nodiscard]] ElasticMeeting from(std::size_t seed) {
    const Eigen::Index n = heard_.cols();
    lying_.assign(patches_.size(), {});
    says_.setZero(n, 4);
    std::vector<Eigen::Index> order;
    Eigen::ArrayXd told = Eigen::ArrayXd::Zero(n);  // the most that one of those that lie says about each; -1: it lies
    for (auto next = static_cast<Eigen::Index>(seed); std::ssize(order) < n; told.maxCoeff(&next)) {
      lay(next);
      order.push_back(next);
      told = (told < 0).select(told, told.max(says_(next, kWeight) * heard_.col(next).array()));
      told(next) = -1;
    }
    // Once more, each where all others put it: the first ones were laid by few.
    for (const Eigen::Index patch : order) {
      lay(patch);
    }
    return all_told();
  }

 private:
  static constexpr Eigen::Index kWeight = 3;

  struct Lying {
    Bend bend;
    Met all;
    Met furniture;
    std::optional<double> astray_m;  ///< from where it was expected, by fixtures; none: it has none, or was the first
  };

  /// Where those that lie put it, moved and turned as they are: the mean, by how much they say. None: no other lies.
  [[nodiscard]] std::optional<Bend> expected(Eigen::Index index) const {
    const Eigen::RowVector4d sums = heard_.col(index).transpose() * says_;
    const double weight = sums(kWeight);
    if (weight <= 0) {
      return std::nullopt;
    }
    const Patch& patch = patches_[static_cast<std::size_t>(index)];
    const double turn_rad = sums(2) / weight;
    return Bend{static_cast<int>(std::lround(sums(0) / weight - turn_rad * patch.row)),
                static_cast<int>(std::lround(sums(1) / weight + turn_rad * patch.column)),
                kTurnUnit * std::round(turn_rad / kTurnUnit)};
  }

  void lay(Eigen::Index index) {
    const Patch& patch = patches_[static_cast<std::size_t>(index)];
    const std::optional<Bend> told = expected(index);
    const Bend where = told.value_or(Bend{});
    const Layer::Best best = layer_.best(patch, where);
    const BestBend& went = patch.has_fixtures() ? best.by_fixtures : best.by_all;
    const Bend& bend = went.bend;
    Lying& lying = lying_[static_cast<std::size_t>(index)];
    lying = {
        .bend = bend, .all = best.by_all.met.all(), .furniture = best.by_all.met.of(Part::kFurniture), .astray_m = {}};
    if (patch.has_fixtures() && told) {
      lying.astray_m = layer_.metres(bend.columns - where.columns, bend.rows - where.rows);
    }
    const double says_m = kLeastSaid + (patch.has_fixtures() ? patch.half_wall_m * std::max(0, went.gain) : 0);
    says_.row(index) = says_m * Eigen::RowVector4d{bend.columns + bend.turn_rad * patch.row,
                                                   bend.rows - bend.turn_rad * patch.column, bend.turn_rad, 1};
  }

  [[nodiscard]] ElasticMeeting all_told() const {
    ElasticMeeting told;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      const Patch& patch = patches_[i];
      const Lying& lying = lying_[i];
      const double same_side_m = patch.half_wall_m * lying.all.same_side;
      told.same_side_m += same_side_m;
      told.in_free_m += patch.half_wall_m * lying.all.in_free;
      told.furniture_same_side_m += patch.half_wall_m * lying.furniture.same_side;
      told.furniture_in_free_m += patch.half_wall_m * lying.furniture.in_free;
      if (lying.astray_m) {
        told.astray_m2 += patch.fixtures_m * *lying.astray_m;
        told.expected_m += patch.fixtures_m;
      }
      const CellIndex cell{patch.column + lying.bend.columns, patch.row + lying.bend.rows};
      told.layout.push_back({patch.index, layer_.centre_of(cell), same_side_m});
    }
    return told;
  }

  Layer& layer_;
  const std::vector<Patch>& patches_;
  Eigen::MatrixXd heard_;  ///< by how much a patch (row) is heard by another (column)
  /// Of each that lies: how it moved, as a small motion of the whole map (columns and rows at the ground's first cell,
  /// and the turn), and 1; all times how much it says [m].
  Eigen::Matrix<double, Eigen::Dynamic, 4> says_;
  std::vector<Lying> lying_;
};

/// The patches that fit best as the pose has it, far from each other: a layout that went astray from one need not from
/// another.
std::vector<std::size_t> seeds(Layer& layer, const std::vector<Patch>& patches) {
  std::vector<std::pair<double, double>> gains;  // of fixtures, and of all [m]
  for (const Patch& patch : patches) {
    const PatchMet met = layer.met(patch, {});
    gains.emplace_back(patch.half_wall_m * met.of(Part::kFixtures).gain(), patch.half_wall_m * met.all().gain());
  }
  std::vector<std::size_t> ranked(patches.size());
  std::iota(ranked.begin(), ranked.end(), std::size_t{0});
  std::stable_sort(ranked.begin(), ranked.end(), [&](std::size_t a, std::size_t b) { return gains[a] > gains[b]; });
  std::vector<std::size_t> seeds;
  for (const std::size_t one : ranked) {
    const bool far = std::all_of(seeds.begin(), seeds.end(), [&](std::size_t seed) {
      return layer.metres(patches[seed].column - patches[one].column, patches[seed].row - patches[one].row) >=
             kSeedsApart;
    });
    if (far && seeds.size() < kSeeds) {
      seeds.push_back(one);
    }
  }
  return seeds;
}

}  // namespace

ElasticMeeting meet_elastically(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving) {
  Layer layer(fixed);
  const std::vector<Patch> patches = placed(moving.patches, fixed.map->level(0), fixed_from_moving);
  Layout layout(layer, patches);
  ElasticMeeting best;
  double most_m = -std::numeric_limits<double>::infinity();
  for (const std::size_t seed : seeds(layer, patches)) {
    ElasticMeeting meeting = layout.from(seed);
    if (const double gain_m = meeting.same_side_m - meeting.in_free_m; gain_m > most_m) {
      most_m = gain_m;
      best = std::move(meeting);
    }
  }
  return best;
}

}  // namespace gridmerge
