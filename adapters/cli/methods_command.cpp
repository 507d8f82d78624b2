#include <CLI/CLI.hpp>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/describe.hpp"
#include "cli/program.hpp"
#include "cli/usage_error.hpp"
#include "plugin/plugin_loader.hpp"

namespace gridmerge::cli {
namespace {

struct MethodsArguments {
  std::string name;
  std::vector<std::string> plugins;
  bool json = false;
  bool markdown = false;
};

std::vector<std::string> trait_names(const MergerTraits& traits) {
  std::vector<std::string> names;
  const auto add = [&](bool has, const char* name) {
    if (has) {
      names.emplace_back(name);
    }
  };
  add(traits.stochastic, "stochastic");
  add(traits.uses_prior, "uses_prior");
  add(traits.needs_prior, "needs_prior");
  add(traits.anytime, "anytime");
  add(traits.warm_start, "warm_start");
  return names;
}

Json method_json(const MethodEntry& method) {
  Json profiles = Json::array();
  for (const MethodProfile& profile : method.profiles) {
    const std::unique_ptr<MethodConfig> config = profile.config();
    profiles.push_back({{"name", profile.name},
                        {"summary", profile.summary},
                        {"traits", trait_names(config->make()->traits())},
                        {"options", options_description_json(config->options())}});
  }
  return {{"name", method.name}, {"summary", method.summary}, {"paper", method.paper}, {"profiles", profiles}};
}

std::string method_text(const MethodEntry& method, bool with_options) {
  std::string text = method.name + ": " + method.summary + "\n  paper: " + method.paper + "\n";
  for (const MethodProfile& profile : method.profiles) {
    const std::unique_ptr<MethodConfig> config = profile.config();
    text += (with_options ? "\nprofile " : "  profile ") + profile.name + ": " + profile.summary + "\n";
    if (with_options) {
      text += options_text(config->options());
    }
  }
  return text;
}

std::string method_markdown(const MethodEntry& method) {
  std::string text = "## " + method.name + "\n\n" + method.summary + "\n\n" + method.paper + "\n";
  for (const MethodProfile& profile : method.profiles) {
    const std::unique_ptr<MethodConfig> config = profile.config();
    text += "\n### Profile `" + profile.name + "`\n\n" + profile.summary + "\n\n" + options_markdown(config->options());
  }
  return text;
}

std::string auto_markdown(const MethodRegistry& methods) {
  ConfigurationChoice choice;
  choice.method = kAuto;
  Configuration configuration(methods, choice);
  const Configuration::Section selector = configuration.sections().front();
  return "\n## auto\n\n" + selector.about + " See [selector.md](selector.md).\n\n### `" + selector.name + "`\n\n" +
         options_markdown(selector.options);
}

std::string shared_markdown(const MethodRegistry& methods) {
  Configuration configuration(methods, {});
  std::string text = "\n## Around every method\n\n" + options_markdown(configuration.run_options());
  for (const Configuration::Section& section : configuration.sections()) {
    if (section.name != configuration.method()) {
      text += "\n### `" + section.name + "`\n\n" + section.about + "\n\n" + options_markdown(section.options);
    }
  }
  return text;
}

int run_methods(const MethodsArguments& arguments, const MethodRegistry& built_in, std::ostream& out) {
  const MethodRegistry methods = with_plugins(built_in, {arguments.plugins.begin(), arguments.plugins.end()});
  std::vector<MethodEntry> listed;
  std::string known;
  for (const MethodEntry& method : methods.entries()) {
    known += (known.empty() ? "" : ", ") + method.name;
    if (arguments.name.empty() || method.name == arguments.name) {
      listed.push_back(method);
    }
  }
  if (listed.empty()) {
    throw UsageError("unknown method '" + arguments.name + "'; known methods: " + known);
  }
  if (arguments.json) {
    Json all = Json::array();
    for (const MethodEntry& method : listed) {
      all.push_back(method_json(method));
    }
    out << json_text(all);
    return kDone;
  }
  const bool whole_page = arguments.markdown && arguments.name.empty();
  out << (whole_page ? "# Methods and their options\n\nWritten by `gridmerge methods --markdown`.\n\n" : "");
  for (const MethodEntry& method : listed) {
    out << (&method == &listed.front() ? "" : "\n")
        << (arguments.markdown ? method_markdown(method) : method_text(method, !arguments.name.empty()));
  }
  if (!arguments.markdown && arguments.name.empty()) {
    out << "\nauto: the method is chosen by what the maps look like ('gridmerge align --method auto --explain')\n";
  }
  if (whole_page) {
    out << auto_markdown(methods) << shared_markdown(methods);
  }
  return kDone;
}

}  // namespace

Command methods_command(const CommandContext& context) {
  const auto arguments = std::make_shared<MethodsArguments>();
  CLI::App* command = context.app.add_subcommand("methods", "Lists the methods; tells all of one");
  command->add_option("NAME", arguments->name, "One method, with all its options");
  add_plugin_argument(*command, arguments->plugins);
  CLI::Option* json = command->add_flag("--json", arguments->json, "For programs: a JSON array");
  command->add_flag("--markdown", arguments->markdown, "For docs: tables of all options")->excludes(json);
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_methods(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
