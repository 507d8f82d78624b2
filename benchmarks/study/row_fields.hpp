#pragma once
/// The fields of a row by name: from this one list come the journal's columns and the CSV file's.
#include <string>

#include "study/row.hpp"

namespace gridmerge::study {

/// Calls visit(name, field) for every field but the figures, in the order of Row.
/// @param row  a Row, const or not; the fields are int, int64, uint64, bool, double and std::string
template <typename AnyRow, typename Visit>
void for_each_field(AnyRow& row, Visit&& visit) {
  visit("run", row.run);
  visit("set", row.set);
  visit("pair", row.pair);
  visit("pair_spec", row.pair_spec);
  visit("robots", row.robots);
  visit("truth", row.truth);
  visit("overlap", row.overlap);
  visit("drift", row.drift);
  visit("noise_m", row.noise_m);
  visit("window", row.window);
  visit("window_m", row.window_m);
  visit("window_deg", row.window_deg);
  visit("prior_x_m", row.prior_x_m);
  visit("prior_y_m", row.prior_y_m);
  visit("prior_theta_rad", row.prior_theta_rad);
  visit("method", row.method);
  visit("profile", row.profile);
  visit("options", row.options);
  visit("seed", row.seed);
  visit("status", row.status);
  visit("result", row.result);
  visit("pose_right", row.pose_right);
  visit("confidence", row.confidence);
  visit("x_m", row.x_m);
  visit("y_m", row.y_m);
  visit("theta_rad", row.theta_rad);
  visit("error_m", row.error_m);
  visit("error_deg", row.error_deg);
  visit("truth_x_m", row.truth_x_m);
  visit("truth_y_m", row.truth_y_m);
  visit("truth_theta_rad", row.truth_theta_rad);
  visit("tolerance_m", row.tolerance_m);
  visit("tolerance_deg", row.tolerance_deg);
  visit("robots_right", row.robots_right);
  visit("robots_wrong", row.robots_wrong);
  visit("reason", row.reason);
  visit("iterations", row.iterations);
  visit("target_walls", row.target_walls);
  visit("source_walls", row.source_walls);
  visit("tried", row.tried);
  const auto visit_as = [&](const std::string& map) {
    return [&visit, map](const char* name, auto& field) { visit((map + name).c_str(), field); };
  };
  for_each_feature(row.target, visit_as("target_"));
  for_each_feature(row.source, visit_as("source_"));
  visit("prepare_s", row.prepare_s);
  visit("choose_s", row.choose_s);
  visit("propose_s", row.propose_s);
  visit("refine_s", row.refine_s);
  visit("judge_s", row.judge_s);
  visit("align_s", row.align_s);
  visit("yardstick_s", row.yardstick_s);
  visit("version", row.version);
  visit("commit", row.commit);
  visit("compiler", row.compiler);
  visit("cpu", row.cpu);
  visit("threads", row.threads);
  visit("date", row.date);
}

}  // namespace gridmerge::study
