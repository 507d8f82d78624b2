#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/describe.hpp"
#include "cli/output_folder.hpp"
#include "cli/program.hpp"
#include "cli/shipped_configs.hpp"
#include "cli/usage_error.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge::cli {
namespace {

struct ConfigArguments {
  std::vector<std::string> sections;
  std::filesystem::path write;
  ConfigurationChoice choice;
};

void write_shipped_configs(const std::filesystem::path& path, const MethodRegistry& methods) {
  const OutputFolder folder(path);
  WholeFiles files;
  for (const ShippedConfig& file : shipped_configs(methods)) {
    files.stage(path / file.name, file.text);
  }
  files.commit();
}

int run_config(const ConfigArguments& arguments, const MethodRegistry& methods, std::ostream& out) {
  if (!arguments.write.empty()) {
    if (!arguments.sections.empty() || !(arguments.choice == ConfigurationChoice{})) {
      throw UsageError("--write writes all the defaults, and stands alone");
    }
    write_shipped_configs(arguments.write, methods);
    return kDone;
  }
  Configuration configuration(methods, arguments.choice);
  const auto named = [&](const std::string& section) {
    return std::find(arguments.sections.begin(), arguments.sections.end(), section) != arguments.sections.end();
  };
  const std::vector<Configuration::Section> sections = configuration.sections();
  for (const std::string& name : arguments.sections) {
    if (std::none_of(sections.begin(), sections.end(), [&](const auto& section) { return section.name == name; })) {
      std::string known;
      for (const Configuration::Section& section : sections) {
        known += (known.empty() ? "" : ", ") + section.name;
      }
      throw UsageError("unknown section '" + name + "'; known sections: " + known);
    }
  }
  out << configuration_yaml(configuration,
                            [&](const std::string& section) { return arguments.sections.empty() || named(section); });
  return kDone;
}

}  // namespace

Command config_command(const CommandContext& context) {
  const auto arguments = std::make_shared<ConfigArguments>();
  CLI::App* command =
      context.app.add_subcommand("config", "Prints the configuration that a run would have, every option explained");
  command->add_option("SECTIONS", arguments->sections, "Only these, e.g. verdict (all)");
  add_method_arguments(*command, arguments->choice);
  add_configuration_arguments(*command, arguments->choice);
  command->add_option("--write", arguments->write, "Writes the defaults into this folder, a file for each profile")
      ->type_name("DIR");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_config(*arguments, methods, out); }};
}

Command check_config_command(const CommandContext& context) {
  struct Arguments {
    std::vector<std::string> files;
    std::vector<std::string> plugins;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = context.app.add_subcommand("check-config", "Loads configuration files and tells every problem");
  command->add_option("FILES", arguments->files, "Configuration files (YAML)")->required();
  add_plugin_argument(*command, arguments->plugins);
  command->footer("\nExit status: 0 all are good, 1 one is not, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) {
            for (const std::string& file : arguments->files) {
              ConfigurationChoice choice;
              choice.file = file;
              choice.plugins = arguments->plugins;
              (void)Configuration(methods, choice);
            }
            out << "ok\n";
            return int{kDone};
          }};
}

}  // namespace gridmerge::cli
