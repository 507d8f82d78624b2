#pragma once
/// The thesis's experiments (its chapter 4) again: the paper profile on pairs with known truth, over windows and seeds.
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/prepared_map.hpp"
#include "manifest/manifest.hpp"

namespace gridmerge::thesis {

struct ExperimentOptions {
  std::vector<int> window_percent{5, 10, 15, 30, 45, 100};
  int seeds = 7;
  int iterations = 60;
  int threads = 1;
  double tolerance_factor = 3;  ///< an answer within that many tolerances is in the right basin: "converged"
};

/// A pair as the thesis's program had it: each map in the frame of its robot's start, both starts laid on one spot.
struct Setup {
  PreparedMap target;
  PreparedMap source;
  double half_side_m = 0;  ///< of the target's map, unknown cells and all
  Pose2 truth;             ///< between the start frames; the start p_i is the identity
};

/// @param pair  with a truth
/// @throws InputError if a map cannot be read
[[nodiscard]] Setup set_up(const ManifestPair& pair, int threads);

/// How far the search looks round p_i.
struct SearchWindow {
  double radius_m = 0;
  double angle_rad = 0;
};

/// The window that the thesis's program had: a share of half the map's side, and the same share of 180 degrees; in the
/// forest 54 degrees for the shares up to 30 %.
[[nodiscard]] SearchWindow window_of(const std::string& scenario, int percent, double half_side_m);

/// One cell of the table: a pair, a window, all seeds.
struct WindowResult {
  SearchWindow window;
  bool truth_inside = false;
  int exact = 0;                ///< runs whose best pose lies within the tolerance
  int converged = 0;            ///< ... within the tolerance times the factor
  std::vector<double> fitness;  ///< final, sorted
  std::optional<int> half_way;  ///< of the converged runs, the median of the first iteration at half the final fitness
  double iteration_s = 0;       ///< wall time, median over the seeds
};

[[nodiscard]] WindowResult run_window(const ManifestPair& pair, const Setup& setup, int percent,
                                      const ExperimentOptions& options);

/// What the thesis measured, re-derived from its author's run records.
struct PublishedResult {
  int converged = 0;
  int runs = 0;
  int half_way = 0;  ///< as above; 0: no run converged
  int median_fitness = 0;
  double iteration_s = 0;
};
[[nodiscard]] std::optional<PublishedResult> published(const std::string& scenario, int percent);

}  // namespace gridmerge::thesis
