#include "study/method_reader.hpp"

#include <algorithm>
#include <sstream>

#include "cli/usage_error.hpp"
#include "gridmerge/base/error.hpp"
#include "study/sweep.hpp"

namespace gridmerge::study {
namespace {

using Kind = YamlEntry::Kind;

class MethodReader {
 public:
  MethodReader(const MethodRegistry& registry, FileProblems& problems) : registry_(registry), problems_(problems) {}

  std::vector<MethodChoice> read(const YamlEntry& methods) {
    const std::vector<YamlEntry> one = {methods};
    const bool is_list = methods.kind == Kind::kSequence;
    if (is_list && methods.children.empty()) {
      problems_.add(methods.line, "methods: must not be an empty list");
    }
    for (const YamlEntry& child : is_list ? methods.children : one) {
      read_method(child);
    }
    return std::move(choices_);
  }

 private:
  void read_method(const YamlEntry& entry) {
    static const std::vector<std::string> known = {"name", "profiles", "set"};
    std::vector<std::string> names;
    std::vector<std::string> profiles = {""};  // the first
    std::vector<Axis> axes;
    if (entry.kind == Kind::kScalar) {
      names = {entry.text};
    } else if (entry.kind == Kind::kMapping && find_entry(entry.children, "name") != nullptr) {
      problems_.add_repeated_keys(entry.children);
      for (const YamlEntry& child : entry.children) {
        if (child.key == "name") {
          names = values_of(child, problems_);
        } else if (child.key == "profiles") {
          profiles = values_of(child, problems_);
        } else if (child.key == "set") {
          axes = axes_of(child);
        } else {
          problems_.add_unknown_key(child, known);
        }
      }
    } else {
      problems_.add(entry.line, "methods: must be a method's name, 'all', or {name: ..., profiles: ..., set: ...}");
    }
    const std::vector<Settings> sweep = combinations(axes, entry.line, problems_);
    for (const std::string& name : with_all(names)) {
      for (const std::string& profile : profiles) {
        for (const Settings& settings : sweep) {
          add_method(name, profile, settings, entry.line);
        }
      }
    }
  }

  /// 'all' stands for every method that there is.
  [[nodiscard]] std::vector<std::string> with_all(const std::vector<std::string>& names) const {
    std::vector<std::string> unfolded;
    for (const std::string& name : names) {
      if (name != "all") {
        unfolded.push_back(name);
        continue;
      }
      for (const MethodEntry& method : registry_.entries()) {
        unfolded.push_back(method.name);
      }
    }
    return unfolded;
  }

  std::vector<Axis> axes_of(const YamlEntry& set) {
    if (set.kind != Kind::kMapping) {
      problems_.add(set.line, "set: must hold options, as in {genetic.population: [100, 300]}");
      return {};
    }
    problems_.add_repeated_keys(set.children);
    std::vector<Axis> axes;
    for (const YamlEntry& child : set.children) {
      axes.push_back({child.key, values_of(child, problems_)});
    }
    return axes;
  }

  void add_method(const std::string& name, const std::string& profile, const Settings& settings, int line) {
    MethodChoice choice = {.method = name, .profile = profile, .set = {}};
    for (const auto& [key, value] : settings) {
      choice.set.push_back(key + "=" + value);
    }
    try {  // what it takes to run it is made once, and everything checked
      const cli::Configuration trial(registry_, configuration_choice(choice));
      choice.profile = trial.profile();
    } catch (const cli::UsageError& error) {
      add_lines(line, error.what());
    } catch (const InputError& error) {
      add_lines(line, error.what());
    }
    const auto is_same = [&](const MethodChoice& other) {
      return other.method == choice.method && other.profile == choice.profile && other.set == choice.set;
    };
    if (std::any_of(choices_.begin(), choices_.end(), is_same)) {
      problems_.add(line, "methods: " + name + " " + choice.profile + " is given twice with the same options");
    }
    choices_.push_back(std::move(choice));
  }

  /// One problem a line; what names the command line is left out.
  void add_lines(int line, const std::string& problems) {
    std::istringstream stream(problems);
    for (std::string problem; std::getline(stream, problem);) {
      problems_.add(line, "methods: " + (problem.starts_with("--set ") ? problem.substr(6) : problem));
    }
  }

  const MethodRegistry& registry_;
  FileProblems& problems_;
  std::vector<MethodChoice> choices_;
};

}  // namespace

std::vector<MethodChoice> read_methods(const YamlEntry& methods, const MethodRegistry& registry,
                                       FileProblems& problems) {
  return MethodReader(registry, problems).read(methods);
}

cli::ConfigurationChoice configuration_choice(const MethodChoice& method) {
  cli::ConfigurationChoice choice;
  choice.method = method.method;
  choice.profile = method.profile;
  choice.set = method.set;
  return choice;
}

}  // namespace gridmerge::study
