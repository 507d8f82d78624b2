#pragma once
/// Mapping without being told the way: each scan is matched to the map drawn so far, as HectorSLAM does it
/// (Kohlbrecher, von Stryk, Meyer, Klingauf 2011, "A flexible and scalable SLAM system with full 3D motion
/// estimation").
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "worlds/log_odds_map.hpp"

namespace gridmerge::worlds {

/// The defaults are those of the hector_mapping node.
struct SlamOptions {
  int levels = 3;
  int coarse_iterations = 4;
  int fine_iterations = 6;
  double update_distance_m = 0.4;
  double update_angle_deg = 51.6;

  void describe(OptionList& list);
};

/// Draws a pyramid of maps, each level from the scans themselves, and finds its place in it from coarse to fine. What
/// it takes for its pose is what it believes: noise, few beams and places that look alike along the way make it drift.
class HectorMapper {
 public:
  /// @param geometry  of the grid drawn on, the finest level; what falls outside is lost
  /// @throws std::invalid_argument listing the options out of range
  explicit HectorMapper(const GridGeometry& geometry, const SlamOptions& options = {});

  /// One turn of a lidar: the points hit, in its own frame, and where the lidar is thought to be: where it was matched
  /// last (HectorSLAM), or that and what odometry says. The first scan with a hit is drawn where it is thought to be.
  /// A guess off by no more than about 0.2 m and 4 degrees is mended where there is enough to see; others may not be.
  /// Without odometry that bounds the way and the turn from scan to scan.
  /// @return map_from_lidar as matched; the guess, to a nanometre, where there is nothing to match
  Pose2 add(const Pose2& map_from_lidar_guess, const std::vector<Point2>& hits);

  /// What is known, as Mapper::grid gives it.
  [[nodiscard]] OccupancyGrid grid(bool probabilistic) const { return levels_.front().grid(probabilistic); }

 private:
  [[nodiscard]] Pose2 match(const Pose2& map_from_lidar, const std::vector<Point2>& hits) const;
  [[nodiscard]] bool has_moved_on(const Pose2& map_from_lidar) const;

  SlamOptions options_;
  std::vector<double> probabilities_;  // by log-odds
  std::vector<LogOddsMap> levels_;     // from fine to coarse
  Pose2 drawn_from_;                   // map_from_lidar of the last scan drawn
  bool drawn_ = false;
};

}  // namespace gridmerge::worlds
