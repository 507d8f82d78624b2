#pragma once
/// The one Evaluator: the same figures for any pose, whoever proposed it.
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/prepared_map.hpp"
#include "gridmerge/judge/elastic.hpp"
#include "gridmerge/judge/sided_map.hpp"

namespace gridmerge {

struct EvaluatorOptions {
  double tolerance_m = 0.2;
  double conflict_weight = 1.75;
  double near_conflict_power = 2.5;
  double c_lock = 1e-3;
  int random_poses = 48;
  int max_points = 8000;

  void describe(OptionList& list);
};

/// The part of a WallMeeting that is of one kind of pieces [m].
struct PieceMeeting {
  double same_side_m = 0;
  double in_free_m = 0;
  double far_in_free_m = 0;
};

/// What the walls of one map meet in the other. Lengths [m]: cells times resolution, so a wall two cells thick counts
/// twice.
struct WallMeeting {
  double all_m = 0;          ///< every wall cell
  double confirmed_m = 0;    ///< a wall of the other map lies within the tolerance ...
  double same_side_m = 0;    ///< ... and was seen from the same side
  double in_free_m = 0;      ///< stands in the other map's free space, beyond the tolerance of any wall
  double far_in_free_m = 0;  ///< of in_free_m: farther than three tolerances from any wall, so no mere drift
  double unseen_m = 0;       ///< the rest: the other map does not know
  std::array<PieceMeeting, kPieceKinds> pieces;  ///< same_side_m, in_free_m and far_in_free_m by Piece
};

/// Everything by which a pose is judged. Swap the maps and invert the pose, and it stays: exactly but for the cell by
/// cell figures, which read the source's cells on the target's, and the fitness, which takes the target's percentages.
struct Figures {
  // Walls against walls and against free space, each way, apart from free-free agreement.
  WallMeeting source_in_target;
  WallMeeting target_in_source;
  double evidence_m = 0;  ///< same_side_m - conflict_weight * in_free_m, both ways
  /// evidence_m * (1 - near conflict share)^near_conflict_power, evidence_m where that is negative: what hypotheses are
  /// ranked by. Near conflict: walls in free space within three tolerances of a wall, of those and the same_side_m.
  double support_m = 0;
  double conflict_share = 0;      ///< in_free_m / (in_free_m + same_side_m), both ways
  double far_conflict_share = 0;  ///< far_in_free_m / (far_in_free_m + same_side_m), both ways
  double same_side_share = 0;     ///< same_side_m / confirmed_m, both ways
  // By pieces. "Both": the lesser of the two ways, with a metre of agreement added. A plan lacks the furniture, but
  // what each map has where the other is free was moved, or is of another place. The others: both ways taken together,
  // with half a metre more of either, so that where there are no such pieces nothing is known.
  double both_far_conflict_share = 0;   ///< far_in_free / (far_in_free + same_side) of all but legs
  double furniture_conflict_share = 0;  ///< in_free / (in_free + same_side) of furniture
  double fittings_conflict_share = 0;   ///< the same of fittings

  // With the maps bent over each other (elastic.hpp), both ways.
  double elastic_evidence_m = 0;      ///< same_side_m - conflict_weight * in_free_m
  double elastic_conflict_share = 0;  ///< in_free_m / (in_free_m + same_side_m)
  /// in_free / (in_free + same_side) of furniture, "both" as above: of a bent map little else stands where nothing is.
  double elastic_both_furniture_conflict_share = 0;
  /// How far patches fit from where those beside them put them, on average, by their walls and fittings; with 2 m of
  /// walls added that are off by 0.4 m, as where two places are not the same: where there is little to tell by, little
  /// is known.
  double elastic_roughness_m = 0;
  std::vector<LaidPatch> elastic_layout;  ///< of the source in the target; not among the named

  // Cell by cell, source cells read on the target's nearest cells.
  double overlap_area_m2 = 0;     ///< known in both
  double overlap_share = 0;       ///< of the smaller map's known area
  double agreement_cells = 0;     ///< agr: known in both and equal
  double disagreement_cells = 0;  ///< dis
  double acceptance_index = 0;    ///< ai, Eq. 2.8 [birk2006]; 0 where nothing overlaps
  double fitness = 0;  ///< F, Eq. 3.5 [li2013]: sum of the target's occupancy (0..1) under the source's walls
  double mutual_information_bit = 0;  ///< of free/occupied in the overlap, per cell

  // The random walk's figures [birk2006], at PreparedMap level 2.
  double psi_cells = 0;  ///< psi, Eq. 2.6, 2.7: lower is better
  double delta = 0;      ///< psi + c_lock (dis - agr), Eq. 2.5: lower is better

  /// Name and value of each, in the order above; stable names, as in JSON and CSV.
  [[nodiscard]] std::vector<std::pair<std::string, double>> named() const;
};

/// What poses chosen at random get: the ground over which a good one must stand.
struct RandomLevel {
  double mean_m = 0;       ///< of evidence_m
  double deviation_m = 0;  ///< standard deviation, >= 0
  int poses = 0;           ///< that made the maps overlap at all
};

/// Made once for a pair of maps; const and thread safe. Borrows the maps. Poses are between map frames.
class Evaluator {
 public:
  /// @throws std::invalid_argument listing every option out of range
  Evaluator(const PreparedMap& target, const PreparedMap& source, EvaluatorOptions options, int num_threads = 1);

  /// Figures::evidence_m alone, at a fraction of the cost.
  [[nodiscard]] double evidence_m(const Pose2& target_from_source) const;
  /// The wall figures only; the rest is zero.
  [[nodiscard]] Figures wall_figures(const Pose2& target_from_source) const;
  /// What a pose is held against the best one by: the wall figures, those of bent maps, and the cell by cell ones
  /// of every 16th cell; the rest is zero.
  [[nodiscard]] Figures rival_figures(const Pose2& target_from_source) const;
  /// All figures.
  [[nodiscard]] Figures figures(const Pose2& target_from_source, int num_threads = 1) const;
  /// Of large maps by some of their walls: a pose at random hits or misses many.
  [[nodiscard]] RandomLevel random_level(std::uint64_t seed, int num_threads = 1) const;

 private:
  /// Figures::evidence_m and its like, of every n-th wall.
  [[nodiscard]] Figures wall_figures(const Pose2& target_from_source, std::size_t every) const;
  [[nodiscard]] WallMeeting meet(const SidedMap& fixed, const SidedMap& moving, const Pose2& fixed_from_moving,
                                 std::size_t every) const;
  /// Of every n-th cell each way, as if they were all.
  void add_cell_figures(Figures& figures, const Pose2& local, int every) const;
  [[nodiscard]] double psi_cells(const Pose2& local, CellState state) const;

  EvaluatorOptions options_;
  SidedMap target_;
  SidedMap source_;
};

}  // namespace gridmerge
