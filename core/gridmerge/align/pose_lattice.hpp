#pragma once
/// A lattice of poses, and on it a fitness in whole numbers: what a search on it must prove itself against.
///
/// A pose of the lattice turns the moving map by one of `angles()` angles and puts its local origin on the centre of a
/// cell of the fixed map's level. Its fitness is that of WallFit with everything rounded to the lattice's cells: the
/// moving map's walls read in the fixed map's table of rewards and penalties (FitTable), and the fixed map's walls in
/// the moving map's table, turned cell by cell. Whole numbers, so that two ways to add it up agree to the last bit.
#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gridmerge/align/pose_window.hpp"
#include "gridmerge/align/wall_fit.hpp"

namespace gridmerge {

struct LatticeOptions {
  double angle_step_rad = radians(2);
  int finest_level = 2;                           ///< of PreparedMap: its cells are the steps of the translation
  int coarsest_level = PreparedMap::kLevels - 1;  ///< even if max_cells is then passed
  int max_cells = 540;    ///< both maps laid side by side [cells]: coarser levels are taken to stay below it
  bool both_ways = true;  ///< false: only the moving map's walls are read in the fixed map's table
  WallFitOptions fit = {};
};

struct LatticePose {
  int angle = 0;   ///< 0 .. angles() - 1
  int column = 0;  ///< of the fixed map's cell on which the moving map's local origin lies; may be outside of the map
  int row = 0;
  friend constexpr auto operator<=>(const LatticePose&, const LatticePose&) = default;
};

/// A wall's weight in a cell, in units of 1/PoseLattice::kFullWeight.
struct CellWeight {
  int column = 0;
  int row = 0;
  int weight = 0;
};

/// The moving map turned by one angle, on the lattice's cells round its local origin, which is the centre of cell (0,
/// 0).
struct TurnedMap {
  std::vector<CellWeight> walls;
  int reach = 0;                    ///< cells each way
  std::vector<std::int8_t> reward;  ///< (2 reach + 1)^2, row-major from (-reach, -reach)
};

/// Borrows the maps.
class PoseLattice {
 public:
  static constexpr int kFullWeight = 16;

  /// @param window  narrows the angles, and which poses `holds`; none: every angle, wherever the maps could touch
  PoseLattice(const PreparedMap& fixed, const PreparedMap& moving, const std::optional<PoseWindow>& window,
              const LatticeOptions& options);

  /// Leaves out the groups of angles (below) whose first angle does not pass.
  void keep_groups(const std::function<bool(double base_angle_rad)>& passes);

  [[nodiscard]] int angles() const { return turns_ * static_cast<int>(base_angles_rad_.size()); }
  [[nodiscard]] double resolution_m() const { return fixed_level_->resolution_m; }
  [[nodiscard]] int level() const { return level_; }  ///< of both PreparedMaps
  /// How far apart neighbouring angles are [rad].
  [[nodiscard]] double angle_step_rad() const { return angle_step_rad_; }
  [[nodiscard]] double angle_rad(int angle) const;
  [[nodiscard]] Pose2 pose(const LatticePose& at) const;  ///< between local frames, fixed_from_moving
  [[nodiscard]] bool holds(const LatticePose& at) const { return inside(pose(at), window_); }

  /// The fitness in whole numbers, of one pose, by adding it up.
  [[nodiscard]] std::int64_t score(const LatticePose& at) const { return score(at, turned(at.angle / turns_)); }
  /// @param moving  turned(at.angle / turns()): for whoever asks for many poses of one group
  [[nodiscard]] std::int64_t score(const LatticePose& at, const TurnedMap& moving) const;
  /// In points of full weight, as WallFit has it.
  [[nodiscard]] static double fitness(double score) { return score / (kFullWeight * FitTable::kFull); }

  // What a search adds up.

  /// Angles come in groups that differ by quarter turns only, 4 a group, or 1 where there is a window of angles. Angle
  /// i belongs to group i / turns() and is turned by i % turns() quarters from it: exactly, cell by cell.
  [[nodiscard]] int groups() const { return static_cast<int>(base_angles_rad_.size()); }
  [[nodiscard]] int turns() const { return turns_; }
  [[nodiscard]] TurnedMap turned(int group) const;
  [[nodiscard]] const std::vector<CellWeight>& fixed_walls() const { return fixed_walls_; }
  [[nodiscard]] const FitTable& fixed_table() const { return fixed_table_; }
  [[nodiscard]] const MapLevel& fixed_level() const { return *fixed_level_; }
  /// So many cells each way round its local origin hold the moving map at any angle.
  [[nodiscard]] int reach() const { return reach_; }

 private:
  int level_;
  const MapLevel* fixed_level_;
  const MapLevel* moving_level_;
  std::optional<PoseWindow> window_;
  FitTable fixed_table_;
  FitTable moving_table_;
  std::vector<ThinnedWall> moving_walls_;
  std::vector<CellWeight> fixed_walls_;
  std::vector<double> base_angles_rad_;
  int turns_ = 1;
  int reach_ = 0;
  double angle_step_rad_ = 0;
};

}  // namespace gridmerge
