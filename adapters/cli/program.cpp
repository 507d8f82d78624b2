#include "cli/program.hpp"

#include <CLI/CLI.hpp>
#include <ostream>
#include <sstream>
#include <vector>

#include "cli/usage_error.hpp"
#include "methods/register_all.hpp"

namespace gridmerge::cli {
namespace {

constexpr const char* kFooter =
    "\n'gridmerge COMMAND --help' tells more.\n"
    "Exit status: 0 merged (or done), 3 not merged (or interrupted), 1 a file is wrong, 2 wrong usage.";
constexpr const char* kSeeHelp = "\nRun with --help for more information.";

}  // namespace

int run_program(int argc, const char* const* argv, std::ostream& out, const std::vector<CommandMaker>& further) {
  CLI::App app("Merges occupancy grid maps of robots that do not know where they started.", "gridmerge");
  app.set_version_flag("--version", "gridmerge " GRIDMERGE_VERSION);
  app.footer(kFooter);
  const MethodRegistry methods = all_methods();
  const CommandContext context{app, methods};
  std::vector<Command> commands = {align_command(context),    merge_command(context),       evaluate_command(context),
                                   features_command(context), inspect_command(context),     methods_command(context),
                                   config_command(context),   check_config_command(context)};
  for (const CommandMaker make : further) {
    commands.push_back(make(context));
  }
  std::string names;
  bool known = false;
  for (const Command& command : commands) {
    const std::string name = command.arguments->get_name();
    names += (names.empty() ? "" : ", ") + name;
    known = known || (argc > 1 && argv[1] == name);
  }
  if (argc < 2) {
    throw UsageError("no command is given; commands: " + names + kSeeHelp);
  }
  if (argv[1][0] != '-' && !known) {
    throw UsageError("unknown command '" + std::string(argv[1]) + "'; commands: " + names + kSeeHelp);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const bool asked_for = app.exit(error, text, text) == 0;  // --help, --version
    if (asked_for) {
      out << text.str();
      return kDone;
    }
    throw UsageError(error.what() + std::string(kSeeHelp));
  }
  for (const Command& command : commands) {
    if (command.arguments->parsed()) {
      return command.run(out);
    }
  }
  throw UsageError("no command is given; commands: " + names + kSeeHelp);
}

}  // namespace gridmerge::cli
