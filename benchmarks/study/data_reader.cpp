#include "study/data_reader.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "gridmerge/base/error.hpp"
#include "manifest/map_folder.hpp"
#include "study/option_entry.hpp"
#include "study/sweep.hpp"

namespace gridmerge::study {
namespace {

using Kind = YamlEntry::Kind;

/// One entry of `data`.
class DataEntry {
 public:
  DataEntry(const YamlEntry& entry, const DataContext& context, FileProblems& problems)
      : entry_(entry), context_(context), problems_(problems), tolerance_(context.tolerance) {}

  std::vector<PairChoice> pairs() {
    struct Source {
      const char* key;
      std::vector<PairChoice> (DataEntry::*read)(const YamlEntry&);
      std::vector<std::string> further_keys;
    };
    static const std::array<Source, 4> sources = {{{"scenes", &DataEntry::scenes, {}},
                                                   {"swarm", &DataEntry::swarms, {"robots"}},
                                                   {"manifest", &DataEntry::manifest, {"every", "sets", "scenarios"}},
                                                   {"folder", &DataEntry::folder, {"every"}}}};
    const auto given = [&](const Source& source) { return find_entry(entry_.children, source.key) != nullptr; };
    if (entry_.kind != Kind::kMapping || std::count_if(sources.begin(), sources.end(), given) != 1) {
      problems_.add(entry_.line, "data: an entry must have exactly one of scenes, swarm, manifest, folder");
      return {};
    }
    const Source& source = *std::find_if(sources.begin(), sources.end(), given);
    std::vector<std::string> known = {source.key, "name", "tolerance", "windows"};
    known.insert(known.end(), source.further_keys.begin(), source.further_keys.end());
    problems_.add_repeated_keys(entry_.children);
    for (const YamlEntry& child : entry_.children) {
      if (std::find(known.begin(), known.end(), child.key) == known.end()) {
        problems_.add_unknown_key(child, known);
      }
    }
    if (const YamlEntry* tolerance = find_entry(entry_.children, "tolerance")) {
      tolerance_.read(*tolerance, problems_);
    }
    std::vector<PairChoice> pairs = (this->*source.read)(*find_entry(entry_.children, source.key));
    finish(pairs);
    return pairs;
  }

 private:
  /// What holds for every kind of entry.
  void finish(std::vector<PairChoice>& pairs) {
    const YamlEntry* name = find_entry(entry_.children, "name");
    if (name != nullptr && (name->kind != Kind::kScalar || name->text.empty())) {
      problems_.add(name->line, "name: must be text");
    }
    const std::vector<std::size_t> windows = window_indices();
    for (PairChoice& pair : pairs) {
      pair.set = name == nullptr ? pair.set : name->text;
      pair.windows = pair.is_swarm() ? std::vector<std::size_t>{} : windows;
    }
  }

  /// The values of one of the entry's keys; none where it is not given.
  std::vector<std::string> words(const char* key) {
    const YamlEntry* child = find_entry(entry_.children, key);
    return child == nullptr ? std::vector<std::string>{} : values_of(*child, problems_);
  }

  std::vector<std::size_t> window_indices() {
    std::vector<std::size_t> all(context_.windows.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const YamlEntry* named = find_entry(entry_.children, "windows");
    if (named == nullptr) {
      return all;
    }
    std::vector<std::size_t> chosen;
    for (const std::string& name : words("windows")) {
      const auto found =
          std::find_if(all.begin(), all.end(), [&](std::size_t index) { return context_.windows[index].name == name; });
      if (found == all.end()) {
        problems_.add(named->line, "windows: '" + name + "' is not among the study's windows");
      } else {
        chosen.push_back(*found);
      }
    }
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
  }

  /// A scene with the way to name it among its like.
  struct NamedScene {
    worlds::SceneOptions scene;
    std::string name;
  };

  /// Every combination of the keys that a scene is given.
  std::vector<NamedScene> unfold(const YamlEntry& scene) {
    if (scene.kind != Kind::kMapping) {
      problems_.add(scene.line, scene.key + ": must hold options of a scene (kind: office, seed: 1..4, ...)");
      return {};
    }
    std::vector<Axis> axes;
    problems_.add_repeated_keys(scene.children);
    for (const YamlEntry& child : scene.children) {
      axes.push_back({child.key, values_of(child, problems_)});
      worlds::SceneOptions trial;
      OptionList list = option_list(trial);
      for (const std::string& value : axes.back().values) {
        if (const std::string problem = list.set(child.key, value); !problem.empty()) {
          problems_.add(child.line, problem);
          axes.back().values.clear();
          break;
        }
      }
    }
    std::vector<NamedScene> scenes;
    for (const Settings& settings : combinations(axes, scene.line, problems_)) {
      NamedScene one;
      OptionList list = option_list(one.scene);
      std::string swept;
      for (std::size_t i = 0; i < settings.size(); ++i) {
        (void)list.set(settings[i].first, settings[i].second);
        const bool in_name = settings[i].first == "kind" || settings[i].first == "seed";
        if (axes[i].values.size() > 1 && !in_name) {
          swept += " " + settings[i].first + "=" + settings[i].second;
        }
      }
      one.name = one.scene.kind + "-" + std::to_string(one.scene.seed) + swept;
      for (const std::string& problem : worlds::scene_problems(one.scene)) {
        problems_.add(scene.line, scene.key + ": " + problem);
      }
      scenes.push_back(std::move(one));
    }
    return scenes;
  }

  [[nodiscard]] PairChoice choice(std::string set, std::string name,
                                  std::variant<SceneMaps, SwarmMaps, FileMaps> maps) const {
    return {.set = std::move(set),
            .name = std::move(name),
            .maps = std::move(maps),
            .tolerance_m = tolerance_.m,
            .tolerance_deg = tolerance_.deg,
            .windows = {}};
  }

  std::vector<PairChoice> scenes(const YamlEntry& entry) {
    std::vector<PairChoice> pairs;
    for (NamedScene& one : unfold(entry)) {
      std::string set = one.scene.kind;
      pairs.push_back(choice(std::move(set), std::move(one.name), SceneMaps{std::move(one.scene)}));
    }
    return pairs;
  }

  std::vector<PairChoice> swarms(const YamlEntry& entry) {
    std::vector<int> robots;
    for (const std::string& text : words("robots")) {
      int count = 2;
      OptionList list;
      list.add("robots", count, 2, 32, {"", "", ""});
      if (const std::string problem = list.set("robots", text); !problem.empty()) {
        problems_.add(find_entry(entry_.children, "robots")->line, problem);
      }
      robots.push_back(count);
    }
    if (robots.empty()) {
      problems_.add(entry.line, "swarm: 'robots' must say how many, as in robots: [2, 4, 8]");
    }
    std::vector<PairChoice> pairs;
    for (const NamedScene& one : unfold(entry)) {
      for (const int count : robots) {
        pairs.push_back(choice("swarm-" + one.scene.kind, one.name + " robots=" + std::to_string(count),
                               SwarmMaps{one.scene, count}));
      }
    }
    return pairs;
  }

  std::vector<PairChoice> manifest(const YamlEntry& entry) {
    return listed(entry, [&](const std::filesystem::path& file) { return chosen(read_manifest(file), entry.line); });
  }

  std::vector<PairChoice> folder(const YamlEntry& entry) {
    return listed(entry, [&](const std::filesystem::path& file) {
      return pairs_of(read_map_folder(file), {.tolerance_m = tolerance_.m, .tolerance_deg = tolerance_.deg});
    });
  }

  /// Of the sets and scenarios that the entry asks for.
  std::vector<ManifestPair> chosen(std::vector<ManifestPair> pairs, int line) {
    const auto keep = [&](const char* key, std::string ManifestPair::*field) {
      const std::vector<std::string> wanted = words(key);
      for (const std::string& name : wanted) {
        if (std::none_of(pairs.begin(), pairs.end(), [&](const ManifestPair& pair) { return pair.*field == name; })) {
          problems_.add(line, std::string(key) + ": the manifest has no '" + name + "'");
        }
      }
      std::erase_if(pairs, [&](const ManifestPair& pair) {
        return !wanted.empty() && std::find(wanted.begin(), wanted.end(), pair.*field) == wanted.end();
      });
    };
    keep("sets", &ManifestPair::set);
    keep("scenarios", &ManifestPair::scenario);
    return pairs;
  }

  /// Pairs of maps in files: every n-th of each set.
  std::vector<PairChoice> listed(const YamlEntry& entry,
                                 const std::function<std::vector<ManifestPair>(const std::filesystem::path&)>& read) {
    if (entry.kind != Kind::kScalar) {
      problems_.add(entry.line, entry.key + ": must be one path");
      return {};
    }
    int every = 1;
    if (const YamlEntry* child = find_entry(entry_.children, "every")) {
      OptionList list;
      list.add("every", every, 1, 1'000'000, {"", "", ""});
      set_option(list, *child, problems_);
    }
    std::vector<PairChoice> pairs;
    try {
      std::map<std::string, int> seen;  // by set
      for (const ManifestPair& pair : read(context_.folder / entry.text)) {
        if (seen[pair.set]++ % every == 0) {
          pairs.push_back(of_files(pair));
        }
      }
    } catch (const InputError& error) {
      problems_.add(entry.line, error.what());
    }
    return pairs;
  }

  [[nodiscard]] PairChoice of_files(const ManifestPair& pair) const {
    const auto absolute = [](const std::filesystem::path& path) {
      return std::filesystem::absolute(path).lexically_normal();
    };
    PairChoice made = choice(pair.set, pair.target_name + " " + pair.source_name,
                             FileMaps{.target_yaml = absolute(pair.target_yaml),
                                      .source_yaml = absolute(pair.source_yaml),
                                      .truth = pair.truth ? "same" : (pair.truth_known ? "different" : "unknown"),
                                      .known = pair.truth});
    if (pair.truth) {
      made.tolerance_m = pair.truth->tolerance_m;
      made.tolerance_deg = degrees(pair.truth->tolerance_rad);
    }
    return made;
  }

  const YamlEntry& entry_;
  const DataContext& context_;
  FileProblems& problems_;
  Tolerance tolerance_;
};

}  // namespace

void Tolerance::describe(OptionList& list) {
  list.add("m", m, 0.001, 1000, {"m", "How far off a right answer may be, at the centre of the source's map.", ""})
      .add("deg", deg, 0.001, 180, {"deg", "How far a right answer may be turned.", ""});
}

void Tolerance::read(const YamlEntry& entry, FileProblems& problems) {
  OptionList list = option_list(*this);
  set_options(list, entry, problems);
}

std::vector<PairChoice> read_data(const YamlEntry& data, const DataContext& context, FileProblems& problems) {
  std::vector<PairChoice> all;
  std::set<std::pair<std::string, std::string>> names;
  if (data.kind != Kind::kSequence || data.children.empty()) {
    problems.add(data.line, "data: must be a list (lines of '- scenes: ...', '- manifest: ...')");
    return all;
  }
  for (const YamlEntry& entry : data.children) {
    std::vector<PairChoice> pairs = DataEntry(entry, context, problems).pairs();
    const auto taken = std::find_if(pairs.begin(), pairs.end(), [&](const PairChoice& pair) {
      return names.contains({pair.set, pair.name});
    });
    if (taken != pairs.end()) {
      problems.add(entry.line, "data: the set '" + taken->set + "' has a pair '" + taken->name +
                                   "' already; give this entry a 'name' of its own");
    }
    for (PairChoice& pair : pairs) {
      names.emplace(pair.set, pair.name);
      all.push_back(std::move(pair));
    }
  }
  return all;
}

}  // namespace gridmerge::study
