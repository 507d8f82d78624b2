#pragma once
/// The command line as a whole.
#include <functional>
#include <iosfwd>
#include <vector>

#include "gridmerge/align/registry.hpp"

namespace CLI {
class App;
}

namespace gridmerge::cli {

/// One `gridmerge NAME ...`: its arguments, and what it does with them.
struct Command {
  CLI::App* arguments = nullptr;          ///< owned by the program's App
  std::function<int(std::ostream&)> run;  ///< writes its answer to the stream; returns an ExitStatus
};

/// What a command is made with; both outlive it.
struct CommandContext {
  CLI::App& app;
  const MethodRegistry& methods;
};

[[nodiscard]] Command align_command(const CommandContext& context);
[[nodiscard]] Command merge_command(const CommandContext& context);
[[nodiscard]] Command evaluate_command(const CommandContext& context);
[[nodiscard]] Command features_command(const CommandContext& context);
[[nodiscard]] Command inspect_command(const CommandContext& context);
[[nodiscard]] Command methods_command(const CommandContext& context);
[[nodiscard]] Command config_command(const CommandContext& context);
[[nodiscard]] Command check_config_command(const CommandContext& context);

using CommandMaker = Command (*)(const CommandContext&);

/// Runs the command that the arguments name; the answer goes to `out`.
/// @param further  commands that come after those of this folder
/// @return an ExitStatus
/// @throws UsageError for a wrong command line, InputError for a wrong file, std::invalid_argument for maps that break
/// a rule of the core
[[nodiscard]] int run_program(int argc, const char* const* argv, std::ostream& out,
                              const std::vector<CommandMaker>& further = {});

}  // namespace gridmerge::cli
