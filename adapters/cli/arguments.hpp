#pragma once
/// The arguments that several commands share, and the values written in them.
#include <optional>
#include <string>
#include <vector>

#include "cli/configuration.hpp"
#include "gridmerge/align/merger.hpp"

namespace CLI {
class App;
}

namespace gridmerge::cli {

/// What a search for the pose is told beside its options; texts as given, empty where not.
struct SearchArguments {
  std::string prior;
  std::string time_limit;
  std::string trace;
};

/// --plugin
void add_plugin_argument(CLI::App& command, std::vector<std::string>& plugins);
/// --config, --plugin, --set, --strictness, --seed, --threads
void add_configuration_arguments(CLI::App& command, ConfigurationChoice& choice);
/// --profile
void add_profile_argument(CLI::App& command, ConfigurationChoice& choice);
/// --method, --profile
void add_method_arguments(CLI::App& command, ConfigurationChoice& choice);
/// --prior, --time-limit, --trace
void add_search_arguments(CLI::App& command, SearchArguments& arguments);

// Each throws UsageError naming the option, its value and the rule.

/// "x,y,theta": finite numbers; the angle is brought into (-pi, pi].
[[nodiscard]] Pose2 parse_pose(const std::string& text, const std::string& option);
/// "x,y,theta" or "x,y,theta,radius_m,angle_deg"; none for an empty text.
[[nodiscard]] std::optional<PosePrior> parse_prior(const std::string& text);
/// Seconds, greater than 0; none for an empty text.
[[nodiscard]] std::optional<double> parse_time_limit(const std::string& text);

/// A robot's pose in one of the maps.
struct RobotArgument {
  std::size_t map = 0;  ///< from 0
  Pose2 map_from_robot;
};
/// "N:x,y,yaw" with N = 1 for the first of `map_count` maps.
[[nodiscard]] RobotArgument parse_robot(const std::string& text, std::size_t map_count);

}  // namespace gridmerge::cli
