#pragma once
/// The commands of `gridmerge` that draw, fetch and study pairs of maps.
#include <vector>

#include "cli/program.hpp"

namespace gridmerge::cli {

[[nodiscard]] Command simulate_command(const CommandContext& context);
[[nodiscard]] Command convert_command(const CommandContext& context);
[[nodiscard]] Command study_command(const CommandContext& context);

/// All of them, for run_program.
[[nodiscard]] std::vector<CommandMaker> benchmark_commands();

}  // namespace gridmerge::cli
