#pragma once
/// A study's report: one HTML file that holds all it needs and asks no network.
#include <functional>
#include <span>
#include <string>

#include "page/failures.hpp"
#include "study/row.hpp"

namespace gridmerge::page {

/// What is shown. Texts may hold any bytes: what is not UTF-8 is shown as U+FFFD.
struct PageInput {
  std::string name;                                ///< of the study
  std::string about = {};                          ///< what it asks, in a sentence or a few; may be empty
  std::span<const study::Row> rows = {};           ///< borrowed, in any order
  std::span<const study::CurvePoint> curves = {};  ///< borrowed, in any order; may be empty
  std::span<const FailurePicture> failures = {};   ///< borrowed, shown in this order; may be empty
  /// The command line that repeats a run; may be empty. Called for each row.
  std::function<std::string(const study::Row&)> command_of = {};
  /// So many runs are drawn as curves, spread evenly over the runs; what is counted is counted over all of them.
  int max_curve_runs = 1500;
};

/// The page as the bytes of a file. Numbers are told to seven digits; the study's own table holds them all.
[[nodiscard]] std::string report_page(const PageInput& input);

}  // namespace gridmerge::page
