#include "cli/configuration.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <system_error>

#include "cli/usage_error.hpp"
#include "config/bid_file.hpp"
#include "config/config_file.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "plugin/plugin_loader.hpp"

namespace gridmerge::cli {
namespace {

struct Named {
  std::string name;
};

template <typename Some>
std::string names_of(const std::vector<Some>& all) {
  std::string names;
  for (const Some& one : all) {
    names += (names.empty() ? "" : ", ") + one.name;
  }
  return names;
}

/// The one that the command line names, or else the file, or else the first.
template <typename Some>
const Some& chosen(const std::vector<Some>& all, const std::string& key, const std::string& from_command_line,
                   ConfigFile& file) {
  const std::optional<std::string> from_file = file.value(key);
  const std::string name = from_command_line.empty() ? from_file.value_or(all.front().name) : from_command_line;
  const auto found = std::find_if(all.begin(), all.end(), [&](const Some& one) { return one.name == name; });
  if (found != all.end()) {
    return *found;
  }
  const std::string rule = "is not known; known: " + names_of(all);
  if (!from_command_line.empty()) {
    throw UsageError(key + " " + name + ": " + rule);
  }
  file.reject(key, rule);
  return all.front();
}

/// Where a library lies, however it is written.
std::filesystem::path real_path(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::path real = std::filesystem::weakly_canonical(std::filesystem::absolute(file), error);
  return error ? std::filesystem::absolute(file) : real;
}

/// The libraries that the file names, relative to its folder.
std::vector<std::filesystem::path> plugins_of(ConfigFile& file, const std::string& name) {
  std::vector<std::filesystem::path> plugins;
  for (const std::string& plugin : file.values("plugins")) {
    plugins.push_back(real_path(std::filesystem::path(name).parent_path() / plugin));
  }
  return plugins;
}

/// @throws InputError that names the configuration file as well
MethodRegistry with_plugins_of_file(const MethodRegistry& methods, const std::vector<std::filesystem::path>& plugins,
                                    const std::string& file) {
  try {
    return with_plugins(methods, plugins);
  } catch (const InputError& error) {
    throw InputError(file, std::string("plugins: ") + error.what());
  }
}

/// Those that are not among the known ones.
std::vector<std::filesystem::path> further_plugins(const std::vector<std::string>& named,
                                                   const std::vector<std::filesystem::path>& known) {
  std::vector<std::filesystem::path> further;
  for (const std::string& plugin : named) {
    const std::filesystem::path file = real_path(plugin);
    if (std::find(known.begin(), known.end(), file) == known.end()) {
      further.push_back(file);
    }
  }
  return further;
}

/// Applies one "section.key=value". @return the problem, or an empty string
std::string apply_setting(const std::string& setting, std::vector<Configuration::Section>& sections) {
  const std::size_t equals = setting.find('=');
  const std::size_t dot = setting.find('.');
  if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
    return "must be SECTION.KEY=VALUE; sections: " + names_of(sections);
  }
  const std::string name = setting.substr(0, dot);
  const auto section = std::find_if(sections.begin(), sections.end(), [&](const auto& s) { return s.name == name; });
  if (section == sections.end()) {
    return "unknown section '" + name + "'; known sections: " + names_of(sections);
  }
  return section->options.set(setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
}

}  // namespace

void RunOptions::describe(OptionList& list) {
  list.add("seed", seed, 0, std::numeric_limits<int>::max(),
           {"", "All chance comes from it: the same seed gives the same answer.",
            "Try another one to see whether an answer hangs by chance."})
      .add("threads", threads, 0, 1024,
           {"", "How many threads work at a time; 0: as many as the machine has.", "Does not change the answer."});
}

Configuration::Configuration(const MethodRegistry& built_in, const ConfigurationChoice& choice) {
  ConfigFile file = choice.file.empty() ? ConfigFile::parse("", "") : ConfigFile::read(choice.file);
  plugins_ = plugins_of(file, choice.file);
  const std::vector<std::filesystem::path> further = further_plugins(choice.plugins, plugins_);
  const MethodRegistry registry = with_plugins(with_plugins_of_file(built_in, plugins_, choice.file), further);
  plugins_.insert(plugins_.end(), further.begin(), further.end());
  choose_methods(registry, choice, file);

  OptionList run = run_options();
  std::vector<Section> parts = sections();
  std::set<std::string> names = {kAuto, "selector"};
  for (const Section& part : parts) {
    const bool is_new = names.insert(part.name).second;
    if (!is_new && part.name != "selector") {
      throw InputError("method " + part.name, "a method cannot bear the name of a section of the configuration");
    }
  }
  file.apply(ConfigFile::kTopLevel, run);
  for (Section& part : parts) {
    file.apply(part.name, part.options);
  }
  file.check();

  std::string problems;
  const auto note = [&](const std::string& where, const std::string& problem) {
    if (!problem.empty()) {
      problems += (problems.empty() ? "" : "\n") + where + ": " + problem;
    }
  };
  if (!choice.seed.empty()) {
    note("--seed", run.set("seed", choice.seed));
  }
  if (!choice.threads.empty()) {
    note("--threads", run.set("threads", choice.threads));
  }
  if (!choice.strictness.empty()) {
    note("--strictness " + choice.strictness, apply_setting("verdict.strictness=" + choice.strictness, parts));
  }
  std::set<std::string> given;
  for (const std::string& setting : choice.set) {
    const std::string key = setting.substr(0, setting.find('='));
    note("--set " + setting, given.insert(key).second ? apply_setting(setting, parts) : "'" + key + "' is given twice");
  }
  if (!problems.empty()) {
    throw UsageError(problems);
  }
  try {  // options that do not go together are told here, not in the middle of the work
    make_methods();
    (void)PreparedMap(unknown_grid({.width = 1, .height = 1, .resolution_m = 1, .map_from_grid = {}}), 1,
                      pipeline_.prepare);
  } catch (const std::invalid_argument& error) {
    throw InputError(choice.file.empty() ? "--set" : choice.file, error.what());
  }
}

void Configuration::choose_methods(const MethodRegistry& registry, const ConfigurationChoice& choice,
                                   ConfigFile& file) {
  std::vector<Named> names;
  for (const MethodEntry& entry : registry.entries()) {
    names.push_back({entry.name});
  }
  names.push_back({kAuto});
  method_ = chosen(names, "method", choice.method, file).name;
  const std::optional<std::string> bids = file.value("bids");
  if (!chooses()) {
    const MethodEntry& method = registry.method(method_);
    const MethodProfile& profile = chosen(method.profiles, "profile", choice.profile, file);
    profile_ = profile.name;
    method_configs_.emplace_back(method_, profile.config());
    if (!choice.bids.empty()) {
      throw UsageError("--bids " + choice.bids + ": only --method auto reads it");
    }
    if (bids) {
      file.reject("bids", "is read with 'method: auto' only");
    }
    return;
  }
  profile_ = chosen(std::vector<Named>{{"default"}}, "profile", choice.profile, file).name;
  for (const MethodEntry& entry : registry.entries()) {
    method_configs_.emplace_back(entry.name, entry.profiles.front().config());
  }
  if (!choice.bids.empty()) {
    bids_ = choice.bids;
  } else if (bids) {
    bids_ = std::filesystem::path(choice.file).parent_path() / *bids;
  }
}

void Configuration::make_methods() {
  for (const auto& [name, config] : method_configs_) {
    mergers_.push_back(config->make());
  }
  if (!chooses()) {
    methods_ = std::make_unique<OneMethod>(*mergers_.front(), method_);
    return;
  }
  std::vector<NamedMethod> named;
  for (std::size_t i = 0; i < mergers_.size(); ++i) {
    named.push_back({method_configs_[i].first, mergers_[i].get()});
  }
  methods_ = std::make_unique<Selector>(std::move(named), bids_.empty() ? shipped_bids() : read_bids(bids_), selector_);
}

int Configuration::threads() const { return run_.threads == 0 ? available_threads() : run_.threads; }

std::vector<Configuration::Section> Configuration::sections() {
  std::vector<Section> all;
  if (chooses()) {
    all.push_back({"selector", "Chooses the method from what the maps look like.", option_list(selector_)});
  }
  for (const auto& [name, config] : method_configs_) {
    all.push_back({name, chooses() ? "A method to choose from." : "The method: proposes poses.", config->options()});
  }
  for (Section& part : pipeline_sections()) {
    all.push_back(std::move(part));
  }
  return all;
}

std::vector<Configuration::Section> Configuration::pipeline_sections() {
  return {{"pipeline", "The way from two maps to a verdict.", option_list(pipeline_)},
          {"prepare", "Makes the maps ready.", option_list(pipeline_.prepare)},
          {"refine", "Brings the best poses to a fraction of a cell.", option_list(pipeline_.refinement)},
          {"evaluator", "Measures how well a pose fits.", option_list(pipeline_.evaluator)},
          {"verdict", "Decides from the figures whether to merge.", option_list(pipeline_.verdict)},
          {"fuse", "Makes one map of those that are merged.", option_list(fuse_)}};
}

}  // namespace gridmerge::cli
