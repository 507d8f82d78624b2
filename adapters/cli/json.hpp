#pragma once
/// Results as JSON. Keys are stable. Lengths are metres, angles radians; what is not known or not finite is null.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli/configuration.hpp"
#include "gridmerge/align/pipeline.hpp"

namespace gridmerge::cli {

using Json = nlohmann::ordered_json;

/// {x, y, theta}
[[nodiscard]] Json pose_json(const Pose2& pose);
/// 3 x 3, of (x, y, theta); null where it is not known
[[nodiscard]] Json covariance_json(const std::optional<PoseCovariance>& covariance);
/// All figures, with what the verdict and the random level add to them.
[[nodiscard]] Json figures_json(const Figures& figures, const Verdict& verdict, const RandomLevel& random_level);
/// method, why, status, confidence of each.
[[nodiscard]] Json attempts_json(const std::vector<Attempt>& attempts);
/// status, transform, covariance, confidence, reasons, hypotheses, figures, attempts, choice.
[[nodiscard]] Json alignment_json(const Alignment& alignment);
/// {x, y, theta, radius_m, angle_deg}; null where there is none
[[nodiscard]] Json prior_json(const std::optional<PosePrior>& prior);
/// load, prepare, choose, propose, refine, judge, align: wall-clock time; `align` is all but `load`.
[[nodiscard]] Json seconds_json(double load, const StepSeconds& seconds);
/// method, profile, plugins, seed, threads, options: what the answer was found with.
[[nodiscard]] Json configuration_json(Configuration& configuration);
/// Key and value of each option.
[[nodiscard]] Json options_json(const OptionList& options);
[[nodiscard]] Json option_value_json(const OptionField& field);

/// Indented, ended by a newline. Bytes that are not UTF-8 (a file's name may hold any) become U+FFFD.
[[nodiscard]] std::string json_text(const Json& json);

}  // namespace gridmerge::cli
