#include "study/study.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "config/read_file.hpp"
#include "config/yaml_text.hpp"
#include "gridmerge/base/error.hpp"
#include "methods/register_all.hpp"
#include "plugin/plugin_loader.hpp"
#include "study/data_reader.hpp"
#include "study/method_reader.hpp"
#include "study/option_entry.hpp"
#include "study/sweep.hpp"

namespace gridmerge::study {
namespace {

using Kind = YamlEntry::Kind;

/// The whole file but its data.
class StudyReader {
 public:
  StudyReader(std::string_view text, const std::string& name, std::filesystem::path folder)
      : entries_(parse_yaml_tree(text, name)), problems_(name), folder_(std::move(folder)) {
    study_.text = text;
    study_.name = std::filesystem::path(name).stem().string();
  }

  Study read() {
    check_keys();
    read_top_level();
    read_plugins();
    read_seeds();
    read_windows();
    if (const YamlEntry* entry = find("methods")) {
      study_.methods = read_methods(*entry, registry_, problems_);
    }
    Tolerance tolerance;
    if (const YamlEntry* entry = find("tolerance")) {
      tolerance.read(*entry, problems_);
    }
    if (const YamlEntry* entry = find("data")) {
      study_.pairs = read_data(*entry, {folder_, tolerance, study_.windows}, problems_);
    }
    problems_.throw_if_any();
    return std::move(study_);
  }

 private:
  [[nodiscard]] const YamlEntry* find(std::string_view key) const { return find_entry(entries_, key); }

  void check_keys() {
    static const std::vector<std::string> known = {"name",    "about",     "seeds",  "methods", "data",
                                                   "windows", "tolerance", "curves", "threads", "plugins"};
    problems_.add_repeated_keys(entries_);
    for (const YamlEntry& entry : entries_) {
      if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
        problems_.add_unknown_key(entry, known);
      }
    }
    for (const char* key : {"methods", "data"}) {
      if (find(key) == nullptr) {
        problems_.add(0, std::string("'") + key + "' is missing");
      }
    }
  }

  void read_top_level() {
    OptionList list;
    list.add("curves", study_.curves, {"", "", ""}).add("threads", study_.threads, 1, 1024, {"", "", ""});
    for (const char* key : {"curves", "threads"}) {
      if (const YamlEntry* entry = find(key)) {
        set_option(list, *entry, problems_);
      }
    }
    for (auto [key, text] : {std::pair{"name", &study_.name}, std::pair{"about", &study_.about}}) {
      const YamlEntry* entry = find(key);
      if (entry != nullptr && entry->kind == Kind::kScalar) {
        *text = entry->text;
      } else if (entry != nullptr) {
        problems_.add(entry->line, std::string(key) + ": must be text");
      }
    }
  }

  void read_plugins() {
    const YamlEntry* entry = find("plugins");
    if (entry != nullptr && !(entry->kind == Kind::kSequence && entry->children.empty())) {
      for (const std::string& file : values_of(*entry, problems_)) {
        study_.plugins.push_back(std::filesystem::absolute(folder_ / file).lexically_normal());
      }
    }
    try {
      registry_ = methods_of(study_.plugins);
    } catch (const InputError& error) {
      problems_.add(entry == nullptr ? 0 : entry->line, error.what());
      registry_ = all_methods();
    }
  }

  void read_seeds() {
    const YamlEntry* entry = find("seeds");
    if (entry == nullptr) {
      study_.seeds = {1};
      return;
    }
    std::set<int> seen;
    for (const std::string& text : values_of(*entry, problems_)) {
      int seed = 1;
      OptionList list;
      list.add("seeds", seed, 0, std::numeric_limits<int>::max(), {"", "", ""});
      if (const std::string problem = list.set("seeds", text); !problem.empty()) {
        problems_.add(entry->line, problem);
      } else if (!seen.insert(seed).second) {
        problems_.add(entry->line, "seeds: " + text + " is given twice");
      } else {
        study_.seeds.push_back(static_cast<std::uint64_t>(seed));
      }
    }
  }

  void read_windows() {
    const YamlEntry* entry = find("windows");
    if (entry == nullptr) {
      study_.windows = {{}};
      return;
    }
    const std::vector<YamlEntry> one = {*entry};
    std::set<std::string> names;
    for (const YamlEntry& child : entry->kind == Kind::kSequence ? entry->children : one) {
      study_.windows.push_back(window_of(child));
      if (!names.insert(study_.windows.back().name).second) {
        problems_.add(child.line, "windows: the name '" + study_.windows.back().name + "' is given twice");
      }
    }
  }

  WindowChoice window_of(const YamlEntry& entry) {
    WindowChoice window;
    if (entry.kind == Kind::kScalar && entry.text == "none") {
      return window;
    }
    window.name.clear();
    std::string around = "start";
    OptionList list;
    list.add("share", window.share, 0.001, 10, {"", "", ""})
        .add("least_deg", window.least_deg, 0, 180, {"deg", "", ""})
        .add("radius_m", window.radius_m, 0.001, 1e6, {"m", "", ""})
        .add("angle_deg", window.angle_deg, 0.001, 180, {"deg", "", ""})
        .add("around", around, {"start", "middle", "truth"}, {"", "", ""});
    set_options(list, entry, problems_, {"name"});
    const YamlEntry* name = find_entry(entry.children, "name");
    if (name == nullptr || name->kind != Kind::kScalar || name->text.empty() || name->text == "none") {
      problems_.add(entry.line, "windows: a window must have a 'name' other than none");
    } else {
      window.name = name->text;
    }
    const bool by_share = window.share > 0 && window.radius_m == 0 && window.angle_deg == 0;
    const bool by_size = window.share == 0 && window.least_deg == 0 && window.radius_m > 0 && window.angle_deg > 0;
    if (entry.kind == Kind::kMapping && !by_share && !by_size) {
      problems_.add(entry.line, "windows: a window has either 'share' (and 'least_deg') or 'radius_m' and 'angle_deg'");
    }
    window.around = around == "start"    ? WindowChoice::Around::kStart
                    : around == "middle" ? WindowChoice::Around::kMiddle
                                         : WindowChoice::Around::kTruth;
    return window;
  }

  std::vector<YamlEntry> entries_;
  FileProblems problems_;
  std::filesystem::path folder_;
  MethodRegistry registry_;
  Study study_;
};

}  // namespace

MethodRegistry methods_of(const std::vector<std::filesystem::path>& plugins) {
  return with_plugins(all_methods(), plugins);
}

Study read_study(const std::filesystem::path& yaml) {
  return parse_study(read_file(yaml, kMaxYamlBytes), yaml.string(), yaml.parent_path());
}

Study parse_study(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
  return StudyReader(text, name, folder).read();
}

}  // namespace gridmerge::study
