#pragma once
/// The smooth fitness of a pose: how well the walls of two maps lie on each other, and how few of them stand in the
/// other's free space.
#include <cstdint>
#include <vector>

#include "gridmerge/grid/cluster_points.hpp"
#include "gridmerge/grid/prepared_map.hpp"

namespace gridmerge {

struct WallFitOptions {
  double tolerance_m = 0.15;         ///< standard deviation of the reward about a wall
  double free_space_penalty = 1.75;  ///< what a wall in the other's free space costs, where a wall on a wall earns 1

  void describe(OptionList& list);
};

/// For every cell of a level of a map, what a wall of the other map earns there, in units of 1/kFull:
/// exp(-d^2 / 2 tolerance^2) at distance d from a wall; minus the penalty in free space far from walls; 0 where
/// unknown.
struct FitTable {
  static constexpr int kFull = 30;
  const MapLevel* level = nullptr;
  std::vector<std::int8_t> value;

  FitTable(const MapLevel& of_level, const WallFitOptions& options);
};

/// The mean of the wall points in one cell of a level.
struct ThinnedWall {
  Point2f at;
  float weight = 0;  ///< 1 where a wall crosses the whole cell, less for a speck; metres of wall of a cluster point
};

/// One point for every cell of a level that holds walls. A thick wall then counts no more than a thin one, and the
/// specks that a lidar sees on the ground or in the leaves count little.
[[nodiscard]] std::vector<ThinnedWall> thinned_walls(const PreparedMap& map, const MapLevel& level);

/// Cluster points as points that a fitness reads: each weighs the metres of wall it stands for.
[[nodiscard]] std::vector<ThinnedWall> as_walls(const ClusterPoints& clusters);

/// The fitness of poses at one level: a sum over the wall points of both maps, each read in the other's table.
/// Swapping the maps and inverting the pose gives the same value up to rounding. Borrows the maps.
class WallFit {
 public:
  /// @param max_points  of each map's points, every n-th is used where there are more than this
  WallFit(const PreparedMap& target, const PreparedMap& source, int level, const WallFitOptions& options,
          std::size_t max_points);

  /// The same on points that stand for the maps' walls: where a map is very large, its cluster points.
  WallFit(const PreparedMap& target, const PreparedMap& source, int level, const WallFitOptions& options,
          std::vector<ThinnedWall> target_points, std::vector<ThinnedWall> source_points);

  /// In points of full weight: about +1 for each that lies on a wall of the other map, down to -penalty for each in
  /// free space.
  [[nodiscard]] double operator()(const Pose2& local_target_from_source) const;
  [[nodiscard]] std::size_t point_count() const { return source_points_.size() + target_points_.size(); }

 private:
  FitTable target_table_;
  FitTable source_table_;
  std::vector<ThinnedWall> target_points_;
  std::vector<ThinnedWall> source_points_;
};

}  // namespace gridmerge
