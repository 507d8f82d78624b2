#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "cli/usage_error.hpp"

namespace gridmerge::cli {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& value, const std::string& rule) {
  throw UsageError(option + " '" + value + "': " + rule);
}

std::optional<double> number(std::string_view text) {
  while (!text.empty() && text.front() == ' ') {
    text.remove_prefix(1);
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
  return good ? std::optional(value) : std::nullopt;
}

/// Finite numbers between commas; none if one is not.
std::optional<std::vector<double>> numbers(const std::string& text) {
  std::vector<double> values;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find(',', from), text.size());
    const std::optional<double> value = number(std::string_view(text).substr(from, to - from));
    if (!value) {
      return std::nullopt;
    }
    values.push_back(*value);
    from = to + 1;
  }
  return values;
}

Pose2 pose_of(const std::vector<double>& values) { return {values[0], values[1], wrap_angle(values[2])}; }

}  // namespace

void add_plugin_argument(CLI::App& command, std::vector<std::string>& plugins) {
  command
      .add_option("--plugin", plugins,
                  "Shared library with further methods, run as part of this program; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
}

void add_configuration_arguments(CLI::App& command, ConfigurationChoice& choice) {
  command.add_option("--config", choice.file, "Configuration file (YAML); the command line wins over it")
      ->type_name("FILE");
  add_plugin_argument(command, choice.plugins);
  command.add_option("--set", choice.set, "Sets one option, e.g. verdict.min_lead=0.2; may be repeated. See 'config'")
      ->type_name("SECTION.KEY=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--strictness", choice.strictness,
                  "How sure a merge must be: cautious, normal or eager; short for --set verdict.strictness=NAME")
      ->type_name("NAME");
  command.add_option("--seed", choice.seed, "All chance comes from it: same seed, same answer (1)")->type_name("N");
  command.add_option("--threads", choice.threads, "Threads at work; the answer stays the same (0: all there are)")
      ->type_name("N");
}

void add_profile_argument(CLI::App& command, ConfigurationChoice& choice) {
  command.add_option("--profile", choice.profile, "A named set of the method's options (default)")->type_name("NAME");
}

void add_method_arguments(CLI::App& command, ConfigurationChoice& choice) {
  command
      .add_option(
          "--method", choice.method,
          "The method that proposes poses; 'gridmerge methods' lists them; auto: chosen by what the maps look like")
      ->type_name("NAME");
  command
      .add_option("--bids", choice.bids,
                  "With --method auto: what to expect of each method (YAML), instead of what is built in")
      ->type_name("FILE");
  add_profile_argument(command, choice);
}

void add_search_arguments(CLI::App& command, SearchArguments& arguments) {
  command
      .add_option("--prior", arguments.prior,
                  "Where B's map frame lies in A's [m, m, rad]: a start; with RADIUS_M and ANGLE_DEG a fence: how far "
                  "off the centre of B's known cells may be, and its heading")
      ->type_name("X,Y,THETA[,RADIUS_M,ANGLE_DEG]");
  command.add_option("--time-limit", arguments.time_limit, "After so many seconds the best so far is the answer")
      ->type_name("SECONDS");
  command.add_option("--trace", arguments.trace, "Writes every iteration to this file: .csv, or .jsonl with all poses")
      ->type_name("FILE");
}

Pose2 parse_pose(const std::string& text, const std::string& option) {
  const std::optional<std::vector<double>> values = numbers(text);
  if (!values || values->size() != 3) {
    refuse(option, text, "must be X,Y,THETA: three finite numbers [m, m, rad]");
  }
  return pose_of(*values);
}

std::optional<PosePrior> parse_prior(const std::string& text) {
  if (text.empty()) {
    return std::nullopt;
  }
  const std::optional<std::vector<double>> values = numbers(text);
  if (!values || (values->size() != 3 && values->size() != 5)) {
    refuse("--prior", text, "must be X,Y,THETA or X,Y,THETA,RADIUS_M,ANGLE_DEG: finite numbers");
  }
  PosePrior prior{.target_from_source = pose_of(*values), .radius_m = {}, .angle_rad = {}};
  if (values->size() == 5) {
    if ((*values)[3] <= 0) {
      refuse("--prior", text, "RADIUS_M must be greater than 0");
    }
    if ((*values)[4] <= 0 || (*values)[4] > 180) {
      refuse("--prior", text, "ANGLE_DEG must be greater than 0, and at most 180");
    }
    prior.radius_m = (*values)[3];
    prior.angle_rad = radians((*values)[4]);
  }
  return prior;
}

std::optional<double> parse_time_limit(const std::string& text) {
  constexpr double kLongest_s = 1e8;
  if (text.empty()) {
    return std::nullopt;
  }
  const std::optional<double> seconds = number(text);
  if (!seconds || *seconds <= 0 || *seconds > kLongest_s) {
    refuse("--time-limit", text, "must be a number of seconds, greater than 0 and at most 1e8");
  }
  return seconds;
}

RobotArgument parse_robot(const std::string& text, std::size_t map_count) {
  const std::size_t colon = text.find(':');
  const std::optional<double> map = number(std::string_view(text).substr(0, colon));
  const auto values = colon == std::string::npos ? std::nullopt : numbers(text.substr(colon + 1));
  if (!map || !values || values->size() != 3) {
    refuse("--robot", text, "must be N:X,Y,YAW: which map (1: the first), and the pose in it [m, m, rad]");
  }
  if (*map < 1 || *map > static_cast<double>(map_count) || *map != std::floor(*map)) {
    refuse("--robot", text, "N must be a whole number, 1 .. " + std::to_string(map_count));
  }
  return {static_cast<std::size_t>(*map) - 1, pose_of(*values)};
}

}  // namespace gridmerge::cli
