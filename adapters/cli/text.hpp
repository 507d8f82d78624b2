#pragma once
/// Results in words, for people.
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/base/number_text.hpp"

namespace gridmerge::cli {

/// "x 1.234 m, y -0.500 m, theta 1.5708 rad (90.00 deg)"
[[nodiscard]] std::string pose_text(const Pose2& pose);
/// "0.012 m, 0.010 m, 0.05 deg" along x, y and theta; "not known".
[[nodiscard]] std::string deviation_text(const std::optional<PoseCovariance>& covariance);
/// "merged", "ambiguous", "no_overlap" or "declined": stopped before there was any pose is declined, too.
[[nodiscard]] std::string status_of(Outcome outcome);
/// Why the answer is what it is; never empty.
[[nodiscard]] std::vector<std::string> reasons_of(const Alignment& alignment);
/// The verdict in one sentence.
[[nodiscard]] std::string verdict_text(Outcome outcome, double confidence);
/// A line "  - ..." for each.
[[nodiscard]] std::string list_text(const std::vector<std::string>& items);

/// How the method was chosen, and what came of each that was tried.
[[nodiscard]] std::string choice_text(const Alignment& alignment);
/// The whole answer: verdict, pose, reasons, next hypotheses, time.
[[nodiscard]] std::string alignment_text(const Alignment& alignment, double load_seconds);

}  // namespace gridmerge::cli
