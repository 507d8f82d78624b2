#pragma once
/// Pairs of maps with known truth: two robots in one world, or in two.
#include <string>
#include <vector>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::worlds {

/// What two robots see. All chance comes from `seed`.
struct SceneOptions {
  std::string kind = "office";
  int seed = 1;
  std::string relation = "overlap";
  double target_share = 0.6;
  double source_share = 0.6;
  double wanted_overlap = 0;
  std::string start = "random";
  double start_distance_m = 4;
  double length_m = 0;
  double rearranged_share = 0;
  bool cleared = false;
  double target_heading_deg = 0;
  double rotation_deg = 110;
  double origin_yaw_deg = 0;
  double resolution_m = 0.05;
  int size_cells = 0;
  bool probabilistic = false;
  std::string lidar = "custom";
  double range_m = 12;
  double beam_step_deg = 0.5;
  double range_noise_m = 0.012;
  double dropout = 0.01;
  double roll_deg = 0;
  double height_m = 1;
  int robots_seen = 0;
  double scan_step_m = 0.5;
  std::string mapping = "known";
  bool odometry = true;
  double drift_m = 0;
  double drift_deg = 0;
  double pose_noise_m = 0.03;
  double pose_noise_deg = 0.5;

  void describe(OptionList& list);
};

/// Options out of range, and options that contradict each other; one sentence each.
[[nodiscard]] std::vector<std::string> scene_problems(SceneOptions options);

/// Each map lies in the frame of its robot's first pose.
struct MapPair {
  OccupancyGrid target;
  OccupancyGrid source;
  Pose2 target_from_source;  ///< between the map frames; exact, also for two worlds: they stand a kilometre apart
  /// Where drift bends the maps: the best fit of the places that both robots came by, each as its robot believed it to
  /// be. The same as target_from_source without drift, and where they came by none in common.
  Pose2 met_target_from_source;
  double met_residual_m = 0;  ///< root mean square of what that fit leaves: how bent the maps are where they meet
  double overlap = 0;         ///< share of the source's known area that the target knows, 0..1
  bool truth_is_same = true;  ///< false: by its relation the pair shares nothing, and must not be merged
  double target_share = 0;    ///< as drawn: what wanted_overlap came to
  double source_share = 0;    ///< the same
  double target_flown = 1;    ///< the same: how much of its way the target's robot goes
  double pose_error_m = 0;    ///< root mean square over both ways: where a robot took itself to be, off the truth
  double pose_error_rad = 0;  ///< the same for its heading
};

/// The same pair for the same options, byte for byte, on every machine with IEEE arithmetic.
/// @throws std::invalid_argument listing the problems of the options
[[nodiscard]] MapPair make_scene(const SceneOptions& options);

/// Share of the source's known area that the target knows when it lies there, 0..1; 0 where the source knows nothing.
[[nodiscard]] double overlap_of(const OccupancyGrid& target, const OccupancyGrid& source,
                                const Pose2& target_from_source);

}  // namespace gridmerge::worlds
