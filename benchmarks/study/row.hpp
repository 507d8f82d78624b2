#pragma once
/// What a study keeps of a run: what was asked, what came of it, and all that it takes to run it again.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/select/scene_features.hpp"

namespace gridmerge::study {

/// One run. Numbers that are not known are NaN.
struct Row {
  // What was asked.
  std::int64_t run = 0;   ///< its number in the plan, from 0
  std::string set;        ///< the data set: of a manifest, or as the study names its scenes
  std::string pair;       ///< the pair within the set: "office-3", "a.yaml b.yaml"
  std::string pair_spec;  ///< JSON: all that it takes to make or read the maps again
  int robots = 2;         ///< more than two: all are merged into one
  std::string truth;      ///< "same", "different" (no pose is right) or "unknown"
  double overlap = 0;     ///< share of the source's known area that the target knows, 0..1
  double drift = 0;       ///< of the mapping, as the scene defines it [m after a metre]
  double noise_m = 0;     ///< standard deviation of a range
  std::string window;     ///< name of the search window; "none": anywhere
  double window_m = 0;    ///< its radius
  double window_deg = 0;  ///< its half angle
  double prior_x_m = 0;   ///< target_from_source that the method was given with it; NaN: none; so the next two
  double prior_y_m = 0;
  double prior_theta_rad = 0;
  std::string method;
  std::string profile;
  std::string options;     ///< what differs from the profile: "section.key=value ..."
  std::uint64_t seed = 1;  ///< of the method

  // What came of it.
  std::string status;  ///< merged, ambiguous, no_overlap, declined
  /// right, wrong (merged, but elsewhere), missed (not merged, though it could be), refused (not merged, and rightly
  /// so), false (merged, though nothing is shared), unknown
  std::string result;
  bool pose_right = false;  ///< the first hypothesis is right, whatever the verdict
  double confidence = 0;    ///< 0..1
  double x_m = 0;           ///< target_from_source of the first hypothesis, and the next two
  double y_m = 0;
  double theta_rad = 0;
  double error_m = 0;  ///< at the centre of the source's known cells
  double error_deg = 0;
  double truth_x_m = 0;
  double truth_y_m = 0;
  double truth_theta_rad = 0;
  double tolerance_m = 0;
  double tolerance_deg = 0;
  int robots_right = 0;                                 ///< of many: placed rightly, the first one counted
  int robots_wrong = 0;                                 ///< placed elsewhere
  std::string reason;                                   ///< the first of the verdict's
  std::vector<std::pair<std::string, double>> figures;  ///< Figures::named of the first hypothesis; empty: no pose
  int iterations = 0;
  std::int64_t target_walls = 0;  ///< occupied cells
  std::int64_t source_walls = 0;
  std::string tried;     ///< the methods, in the order tried; more than one only with method auto
  SceneFeatures target;  ///< what the maps look like; of a pair only
  SceneFeatures source;
  double prepare_s = 0;
  double choose_s = 0;
  double propose_s = 0;
  double refine_s = 0;
  double judge_s = 0;
  double align_s = 0;      ///< the whole of it
  double yardstick_s = 0;  ///< a fixed piece of work, timed beside the runs: what the machine was worth just then

  // With what.
  std::string version;  ///< of gridmerge
  std::string commit;   ///< empty: not known
  std::string compiler;
  std::string cpu;
  int threads = 1;   ///< of the run
  std::string date;  ///< UTC, ISO 8601
};

/// One iteration of one run, where the study asks for curves.
struct CurvePoint {
  std::int64_t run = 0;
  int iteration = 0;            ///< from 0, over the whole run
  double fitness = 0;           ///< best score, in the method's own unit
  double acceptance_index = 0;  ///< ai, Eq. 2.8 [birk2006], of the best pose
  double error_m = 0;           ///< of the best pose; NaN where no truth is known
  double error_deg = 0;
};

}  // namespace gridmerge::study
