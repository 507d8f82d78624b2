#pragma once
/// Pairs of maps with known truth: two robots in one world, or in two.
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
  double target_heading_deg = 0;
  double rotation_deg = 110;
  double origin_yaw_deg = 0;
  double resolution_m = 0.05;
  bool probabilistic = false;
  double range_m = 12;
  double beam_step_deg = 0.5;
  double range_noise_m = 0.012;
  double dropout = 0.01;
  double scan_step_m = 0.5;
  double drift_m = 0;
  double drift_deg = 0;

  void describe(OptionList& list);
};

/// Each map lies in the frame of its robot's first pose.
struct MapPair {
  OccupancyGrid target;
  OccupancyGrid source;
  Pose2 target_from_source;  ///< between the map frames; exact, also for two worlds: they stand a kilometre apart
  double overlap = 0;        ///< share of the source's known area that the target knows, 0..1
};

/// The same pair for the same options, byte for byte, on every machine with IEEE arithmetic.
/// @throws std::invalid_argument listing the options out of range
[[nodiscard]] MapPair make_scene(const SceneOptions& options);

/// Share of the source's known area that the target knows when it lies there, 0..1; 0 where the source knows nothing.
[[nodiscard]] double overlap_of(const OccupancyGrid& target, const OccupancyGrid& source,
                                const Pose2& target_from_source);

}  // namespace gridmerge::worlds
