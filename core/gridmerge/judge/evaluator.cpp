#include "gridmerge/judge/evaluator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"
#include "gridmerge/judge/meeting_cells.hpp"

namespace gridmerge {
namespace {

/// What a wall can meet: as in meeting_cells.hpp, all sides as one.
constexpr std::size_t kSides = meets::kFarFree + 1;
constexpr std::size_t kMeetings = kSides + 1;

Point2f cell_centre(const MapLevel& level, int column, int row) {
  return {static_cast<float>(level.lower_left.x_m + (column + 0.5) * level.resolution_m),
          static_cast<float>(level.lower_left.y_m + (row + 0.5) * level.resolution_m)};
}

/// d of Eq. 2.7: mean Manhattan distance [cells] from each cell of that state in `moving` to the nearest such cell of
/// `fixed`. A cell that falls outside `fixed` walks to its border first.
double mean_manhattan(const MapLevel& fixed, const MapLevel& moving, const Pose2& fixed_from_moving, CellState state) {
  std::vector<std::uint8_t> other(fixed.state.size());
  std::transform(fixed.state.begin(), fixed.state.end(), other.begin(),
                 [&](CellState s) { return static_cast<std::uint8_t>(s == state ? 0 : 1); });
  if (std::find(other.begin(), other.end(), 0) == other.end()) {
    return 0;
  }
  cv::Mat distance;
  cv::distanceTransform(cv::Mat(fixed.height, fixed.width, CV_8UC1, other.data()), distance, cv::DIST_L1, 3);
  const ToCells to(fixed, fixed_from_moving);
  double sum = 0;
  double count = 0;
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      if (moving.state[moving.offset(column, row)] != state) {
        continue;
      }
      const Point2f p = cell_centre(moving, column, row);
      const int c = to.column(p);
      const int r = to.row(p);
      const int inside_c = std::clamp(c, 0, fixed.width - 1);
      const int inside_r = std::clamp(r, 0, fixed.height - 1);
      sum +=
          std::abs(c - inside_c) + std::abs(r - inside_r) + static_cast<double>(distance.at<float>(inside_r, inside_c));
      count += 1;
    }
  }
  return count > 0 ? sum / count : 0;
}

double share(double part, double rest) { return part + rest > 0 ? part / (part + rest) : 0; }

/// From how walls meet, what each kind of pieces says.
void add_piece_figures(Figures& f) {
  const auto both_ways = [&](Piece kind) {
    const PieceMeeting& there = f.source_in_target.pieces[static_cast<std::size_t>(kind)];
    const PieceMeeting& back = f.target_in_source.pieces[static_cast<std::size_t>(kind)];
    return share(there.in_free_m + back.in_free_m + 0.5, there.same_side_m + back.same_side_m + 0.5);
  };
  const auto far_of = [](const WallMeeting& met) {
    const PieceMeeting& legs = met.pieces[static_cast<std::size_t>(Piece::kLegs)];
    return share(met.far_in_free_m - legs.far_in_free_m, met.same_side_m - legs.same_side_m + 1);
  };
  f.both_far_conflict_share = std::min(far_of(f.source_in_target), far_of(f.target_in_source));
  f.furniture_conflict_share = both_ways(Piece::kFurniture);
  f.fittings_conflict_share = both_ways(Piece::kFittings);
}

/// From both ways with the maps bent.
void add_elastic_figures(Figures& f, ElasticMeeting there, const ElasticMeeting& back, double conflict_weight) {
  const double same_side = there.same_side_m + back.same_side_m;
  const double in_free = there.in_free_m + back.in_free_m;
  const auto furniture_of = [](const ElasticMeeting& met) {
    return share(met.furniture_in_free_m, met.furniture_same_side_m + 1);
  };
  f.elastic_evidence_m = same_side - conflict_weight * in_free;
  f.elastic_conflict_share = share(in_free, same_side);
  f.elastic_both_furniture_conflict_share = std::min(furniture_of(there), furniture_of(back));
  f.elastic_layout = std::move(there.layout);
  // As rough as two places that are not the same, where there is little to tell by.
  constexpr double kStrange_m = 0.4;
  constexpr double kLittle_m = 2;
  f.elastic_roughness_m =
      (there.astray_m2 + back.astray_m2 + kStrange_m * kLittle_m) / (there.expected_m + back.expected_m + kLittle_m);
}

}  // namespace

void EvaluatorOptions::describe(OptionList& list) {
  list.add("tolerance_m", tolerance_m, 0.02, 2,
           {"m", "A wall is confirmed where the other map has one within this distance.",
            "Raise it for maps bent by drift; wrong poses then find more walls as well."})
      .add("conflict_weight", conflict_weight, 0, 10,
           {"", "Metres of confirmed wall that a metre of wall in the other's free space outweighs.",
            "Lower it where things moved between the two visits."})
      .add(
          "near_conflict_power", near_conflict_power, 0, 20,
          {"",
           "How steeply walls a little off in free space lower a pose's rank, beyond what they take from its evidence.",
           "0 ranks by evidence alone: wrong poses that lay much on much then pass right ones that overlap little."})
      .add("c_lock", c_lock, 0, 1, {"cells", "Weight of dis - agr in the random walk's figure delta (Eq. 2.5).", ""})
      .add("random_poses", random_poses, 2, 10000,
           {"poses", "Poses drawn to learn what chance gives.", "Time grows with it, a little."})
      .add("max_points", max_points, 500, 10000000,
           {"points", "Wall cells of each map that are looked at; of more, every n-th is.",
            "Raise it for very large maps, whose overlap may be a small part of them."});
}

std::vector<std::pair<std::string, double>> Figures::named() const {
  return {{"evidence_m", evidence_m},
          {"support_m", support_m},
          {"conflict_share", conflict_share},
          {"far_conflict_share", far_conflict_share},
          {"same_side_share", same_side_share},
          {"both_far_conflict_share", both_far_conflict_share},
          {"furniture_conflict_share", furniture_conflict_share},
          {"fittings_conflict_share", fittings_conflict_share},
          {"elastic_evidence_m", elastic_evidence_m},
          {"elastic_conflict_share", elastic_conflict_share},
          {"elastic_both_furniture_conflict_share", elastic_both_furniture_conflict_share},
          {"elastic_roughness_m", elastic_roughness_m},
          {"source_walls_m", source_in_target.all_m},
          {"source_confirmed_m", source_in_target.confirmed_m},
          {"source_same_side_m", source_in_target.same_side_m},
          {"source_in_free_m", source_in_target.in_free_m},
          {"source_far_in_free_m", source_in_target.far_in_free_m},
          {"source_unseen_m", source_in_target.unseen_m},
          {"target_walls_m", target_in_source.all_m},
          {"target_confirmed_m", target_in_source.confirmed_m},
          {"target_same_side_m", target_in_source.same_side_m},
          {"target_in_free_m", target_in_source.in_free_m},
          {"target_far_in_free_m", target_in_source.far_in_free_m},
          {"target_unseen_m", target_in_source.unseen_m},
          {"overlap_area_m2", overlap_area_m2},
          {"overlap_share", overlap_share},
          {"agreement_cells", agreement_cells},
          {"disagreement_cells", disagreement_cells},
          {"acceptance_index", acceptance_index},
          {"fitness", fitness},
          {"mutual_information_bit", mutual_information_bit},
          {"psi_cells", psi_cells},
          {"delta", delta}};
}

Evaluator::Evaluator(const PreparedMap& target, const PreparedMap& source, EvaluatorOptions options, int num_threads)
    : options_(options) {
  require_valid(options_, "evaluator");
  parallel_invoke(
      num_threads, [&] { target_ = sided_map(target, options_.tolerance_m, options_.max_points); },
      [&] { source_ = sided_map(source, options_.tolerance_m, options_.max_points); });
}

WallMeeting Evaluator::meet(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving,
                            std::size_t every) const {
  const MapLevel& level = fixed.map->level(0);
  const ToCells to(level, fixed_from_moving);
  const int turn = turn_64ths(fixed_from_moving);
  // Counted without a branch that could be mispredicted: it is asked for millions of walls.
  std::array<std::array<int, kMeetings>, kPieceKinds> counts{};  // by piece and meeting
  std::array<int, kPieceKinds> same_side_halves{};
  int walls = 0;
  for (std::size_t i = 0; i < moving.walls.size(); i += every) {
    const SidedWall& wall = moving.walls[i];
    ++walls;
    const int column = to.column(wall.at);
    const int row = to.row(wall.at);
    if (!level.contains(column, row)) {
      continue;
    }
    const std::uint8_t cell = fixed.cells[level.offset(column, row)];
    const std::size_t meeting = std::min<std::size_t>(cell, kSides);
    const auto piece = static_cast<std::size_t>(wall.piece);
    ++counts[piece][meeting];
    const bool same = meeting == kSides && (cell & sides_of(wall, turn)) != 0;
    same_side_halves[piece] += static_cast<int>(same) * (wall.side.known ? 2 : 1);
  }
  WallMeeting met;  // in walls, to begin with
  met.all_m = walls;
  for (std::size_t piece = 0; piece < kPieceKinds; ++piece) {
    const double far = counts[piece][meets::kFarFree];
    const double in_free = counts[piece][meets::kFree] + far;
    met.pieces[piece] = {0.5 * same_side_halves[piece], in_free, far};
    met.confirmed_m += counts[piece][kSides];
    met.same_side_m += met.pieces[piece].same_side_m;
    met.in_free_m += in_free;
    met.far_in_free_m += far;
  }
  met.unseen_m = met.all_m - met.confirmed_m - met.in_free_m;
  const double metres = moving.metres_a_wall * static_cast<double>(every);
  for (double WallMeeting::*length : {&WallMeeting::all_m, &WallMeeting::confirmed_m, &WallMeeting::same_side_m,
                                      &WallMeeting::in_free_m, &WallMeeting::far_in_free_m, &WallMeeting::unseen_m}) {
    met.*length *= metres;
  }
  for (PieceMeeting& piece : met.pieces) {
    piece = {metres * piece.same_side_m, metres * piece.in_free_m, metres * piece.far_in_free_m};
  }
  return met;
}

double Evaluator::evidence_m(const Pose2& target_from_source) const {
  return wall_figures(target_from_source).evidence_m;
}

Figures Evaluator::wall_figures(const Pose2& target_from_source) const { return wall_figures(target_from_source, 1); }

Figures Evaluator::wall_figures(const Pose2& target_from_source, std::size_t every) const {
  const Pose2 local = to_local(target_from_source, *target_.map, *source_.map);
  Figures f;
  f.source_in_target = meet(target_, source_, local, every);
  f.target_in_source = meet(source_, target_, inverse(local), every);
  const double same_side = f.source_in_target.same_side_m + f.target_in_source.same_side_m;
  const double in_free = f.source_in_target.in_free_m + f.target_in_source.in_free_m;
  const double far_in_free = f.source_in_target.far_in_free_m + f.target_in_source.far_in_free_m;
  const double confirmed = f.source_in_target.confirmed_m + f.target_in_source.confirmed_m;
  f.evidence_m = same_side - options_.conflict_weight * in_free;
  const double near_conflict_share = share(in_free - far_in_free, same_side);
  f.support_m =
      f.evidence_m > 0 ? f.evidence_m * std::pow(1 - near_conflict_share, options_.near_conflict_power) : f.evidence_m;
  f.conflict_share = share(in_free, same_side);
  f.far_conflict_share = share(far_in_free, same_side);
  f.same_side_share = confirmed > 0 ? same_side / confirmed : 0;
  add_piece_figures(f);
  return f;
}

Figures Evaluator::rival_figures(const Pose2& target_from_source) const {
  constexpr int kEvery = 4;
  Figures f = wall_figures(target_from_source);
  const Pose2 local = to_local(target_from_source, *target_.map, *source_.map);
  add_cell_figures(f, local, kEvery);
  add_elastic_figures(f, meet_elastically(target_, source_, local), meet_elastically(source_, target_, inverse(local)),
                      options_.conflict_weight);
  return f;
}

Figures Evaluator::figures(const Pose2& target_from_source, int num_threads) const {
  Figures f = wall_figures(target_from_source);
  const Pose2 local = to_local(target_from_source, *target_.map, *source_.map);
  ElasticMeeting there;
  ElasticMeeting back;
  double psi_open = 0;
  double psi_wall = 0;
  parallel_invoke(
      num_threads, [&] { add_cell_figures(f, local, 1); }, [&] { there = meet_elastically(target_, source_, local); },
      [&] { back = meet_elastically(source_, target_, inverse(local)); },
      [&] { psi_open = psi_cells(local, CellState::kOpen); }, [&] { psi_wall = psi_cells(local, CellState::kWall); });

  add_elastic_figures(f, std::move(there), back, options_.conflict_weight);
  f.psi_cells = psi_open + psi_wall;                                                     // Eq. 2.6
  f.delta = f.psi_cells + options_.c_lock * (f.disagreement_cells - f.agreement_cells);  // Eq. 2.5
  return f;
}

void Evaluator::add_cell_figures(Figures& figures, const Pose2& local, int every) const {
  const MapLevel& target = target_.map->level(0);
  const MapLevel& source = source_.map->level(0);
  const std::vector<std::int8_t>& target_percent = target_.map->occupancy();
  const ToCells to(target, local);
  const double stands_for = every * every;    // cells
  std::array<std::array<int, 3>, 3> pairs{};  // by state in the target and in the source
  double fitness = 0;
  for (int row = 0; row < source.height; row += every) {
    for (int column = 0; column < source.width; column += every) {
      const CellState in_source = source.state[source.offset(column, row)];
      if (in_source == CellState::kUnseen) {
        continue;
      }
      const Point2f p = cell_centre(source, column, row);
      const int c = to.column(p);
      const int r = to.row(p);
      if (!target.contains(c, r)) {
        continue;
      }
      const std::size_t at = target.offset(c, r);
      const CellState in_target = target.state[at];
      ++pairs[static_cast<std::size_t>(in_target)][static_cast<std::size_t>(in_source)];
      if (in_source == CellState::kWall && in_target == CellState::kWall) {
        fitness += target_percent[at] / 100.0;  // Eq. 3.6
      }
    }
  }
  figures.fitness = stands_for * fitness;
  const auto count = [&](std::size_t in_target, std::size_t in_source) {
    return stands_for * pairs[in_target][in_source];
  };
  constexpr auto kOpenAt = static_cast<std::size_t>(CellState::kOpen);
  constexpr auto kWallAt = static_cast<std::size_t>(CellState::kWall);
  figures.agreement_cells = count(kOpenAt, kOpenAt) + count(kWallAt, kWallAt);
  figures.disagreement_cells = count(kOpenAt, kWallAt) + count(kWallAt, kOpenAt);
  figures.acceptance_index = share(figures.agreement_cells, figures.disagreement_cells);  // Eq. 2.8
  const double overlap = figures.agreement_cells + figures.disagreement_cells;
  figures.overlap_area_m2 = overlap * target.resolution_m * target.resolution_m;
  const double smaller = std::min(target_.map->known_area_m2(), source_.map->known_area_m2());
  figures.overlap_share = smaller > 0 ? figures.overlap_area_m2 / smaller : 0;
  if (overlap > 0) {
    for (const std::size_t t : {kOpenAt, kWallAt}) {
      for (const std::size_t s : {kOpenAt, kWallAt}) {
        const double joint = count(t, s) / overlap;
        const double alone_t = (count(t, kOpenAt) + count(t, kWallAt)) / overlap;
        const double alone_s = (count(kOpenAt, s) + count(kWallAt, s)) / overlap;
        if (joint > 0) {
          figures.mutual_information_bit += joint * std::log2(joint / (alone_t * alone_s));
        }
      }
    }
  }
}

double Evaluator::psi_cells(const Pose2& local, CellState state) const {
  constexpr int kLevel = 2;
  const MapLevel& target = target_.map->level(kLevel);
  const MapLevel& source = source_.map->level(kLevel);
  if (target.state.empty() || source.state.empty()) {
    return 0;
  }
  return mean_manhattan(target, source, local, state) + mean_manhattan(source, target, inverse(local), state);
}

RandomLevel Evaluator::random_level(std::uint64_t seed, int num_threads) const {
  constexpr std::size_t kWalls = 1000;  // of both maps
  const PreparedMap& target = *target_.map;
  const PreparedMap& source = *source_.map;
  RandomLevel level;
  if (target.walls().empty() || source.walls().empty()) {
    return level;
  }
  const std::size_t every = std::max<std::size_t>(1, (target_.walls.size() + source_.walls.size()) / kWalls);
  std::vector<double> evidence(static_cast<std::size_t>(options_.random_poses));
  parallel_for(evidence.size(), num_threads, [&](std::size_t i, std::size_t) {
    // A wall of one laid on a wall of the other, at any angle: so every pose overlaps, and chance has its best.
    RandomStream random(seed, "evaluator/random poses", i);
    const Point2f t = target.walls()[random.below(static_cast<std::uint32_t>(target.walls().size()))].at;
    const Point2f s = source.walls()[random.below(static_cast<std::uint32_t>(source.walls().size()))].at;
    const double angle = random.uniform(-kPi, kPi);
    const Point2 turned = Pose2{0, 0, angle} * Point2{s.x_m, s.y_m};
    const Pose2 local{t.x_m - turned.x_m, t.y_m - turned.y_m, angle};
    evidence[i] = wall_figures(from_local(local, target, source), every).evidence_m;
  });
  double sum = 0;
  double sum_of_squares = 0;
  for (const double one : evidence) {
    sum += one;
    sum_of_squares += one * one;
  }
  level.poses = static_cast<int>(evidence.size());
  if (level.poses > 1) {
    const double n = level.poses;
    level.mean_m = sum / n;
    level.deviation_m = std::sqrt(std::max(0.0, sum_of_squares / n - level.mean_m * level.mean_m));
  }
  return level;
}

}  // namespace gridmerge
