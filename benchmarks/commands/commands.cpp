#include "commands/commands.hpp"

namespace gridmerge::cli {

std::vector<CommandMaker> benchmark_commands() { return {simulate_command, convert_command, study_command}; }

}  // namespace gridmerge::cli
