#include "manifest/map_folder.hpp"

#include <algorithm>

#include "config/read_file.hpp"
#include "config/yaml_text.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/csv_table.hpp"
#include "manifest/folder_entries.hpp"
#include "manifest/known_area.hpp"
#include "manifest/problem_list.hpp"
#include "map_server/map_files.hpp"
#include "worlds/scene.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

bool is_map(const std::string& text, const std::string& name) {
  const std::vector<YamlEntry> entries = parse_yaml_mapping(text, name);
  return std::any_of(entries.begin(), entries.end(), [](const YamlEntry& entry) { return entry.key == "image"; });
}

/// Adds the map that the file describes, if it describes one.
void add_map(const fs::path& yaml, std::vector<FolderMap>& maps) {
  const std::string text = read_file(yaml, kMaxYamlBytes);
  if (!is_map(text, yaml.string())) {
    return;
  }
  const MapDescription description = parse_map_description(text, yaml.string());
  if (!fs::is_regular_file(yaml.parent_path() / description.image)) {
    throw InputError(yaml.string(), "image: there is no file '" + description.image + "'");
  }
  maps.push_back({.name = yaml.filename().string(), .yaml = yaml, .world_from_map = {}});
}

void add_pose(const CsvRow& row, std::vector<FolderMap>& maps) {
  const std::string name = row.text("map");
  const auto map = std::find_if(maps.begin(), maps.end(), [&](const FolderMap& each) { return each.name == name; });
  if (map == maps.end()) {
    throw InputError(row.where(), "map: there is no map '" + name + "' in this folder");
  }
  if (map->world_from_map) {
    throw InputError(row.where(), "map: '" + name + "' has a row already");
  }
  map->world_from_map = Pose2{row.number("x"), row.number("y"), row.number("theta")};
}

/// What a pair needs to know of a map.
struct SeenMap {
  OccupancyGrid grid;
  Point2 centre;
};

std::vector<SeenMap> read_maps(const MapFolder& folder, int num_threads) {
  std::vector<SeenMap> maps(folder.maps.size());
  parallel_for(maps.size(), num_threads, [&](std::size_t i, std::size_t) {
    if (folder.maps[i].world_from_map) {
      maps[i].grid = read_map(folder.maps[i].yaml);
      maps[i].centre = centre_of_known(maps[i].grid);
    }
  });
  return maps;
}

ManifestPair unknown_pair(const MapFolder& folder, std::size_t target, std::size_t source) {
  return {.set = folder.name,
          .target_name = folder.maps[target].name,
          .source_name = folder.maps[source].name,
          .target_yaml = folder.maps[target].yaml,
          .source_yaml = folder.maps[source].yaml,
          .truth = {},
          .truth_known = false};
}

void tell_truth(ManifestPair& pair, const SeenMap& target, const SeenMap& source, const Pose2& target_from_source,
                const FolderPairOptions& options) {
  pair.source_centre = source.centre;
  pair.overlap = worlds::overlap_of(target.grid, source.grid, target_from_source);
  pair.truth_known = *pair.overlap == 0 || *pair.overlap >= options.least_overlap;
  if (*pair.overlap > 0 && pair.truth_known) {
    pair.truth = KnownPose{.target_from_source = target_from_source,
                           .tolerance_m = options.tolerance_m,
                           .tolerance_rad = radians(options.tolerance_deg)};
  }
}

}  // namespace

void FolderPairOptions::describe(OptionList& list) {
  list.add("both_orders", both_orders, {"", "Whether each of two maps is target once.", "Twice the pairs."});
  list.add("tolerance_m", tolerance_m, 0, 100,
           {"m", "How far off an answer may be at the centre of the source's known cells.",
            "No finer than the poses of world.csv are good."});
  list.add("tolerance_deg", tolerance_deg, 0, 180, {"deg", "How far turned an answer may be.", "As for tolerance_m."});
  list.add("least_overlap", least_overlap, 0, 1,
           {"", "Share of the source's known area that the target must have seen, or else no pose is called right.",
            "A pair that shares less, but something, counts neither for nor against a method."});
}

MapFolder read_map_folder(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string(), "is no folder");
  }
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  MapFolder found = {.name = (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string(),
                     .maps = {}};
  ProblemList problems;
  for (const fs::path& file : folder_entries(folder, {".yaml", ".yml"})) {
    problems.collect([&] { add_map(file, found.maps); });
  }
  problems.throw_if_any();
  if (found.maps.empty()) {
    throw InputError(folder.string(), "holds no map: no YAML file with the key image");
  }
  if (fs::exists(folder / "world.csv")) {
    for (const CsvRow& row : read_csv(folder / "world.csv")) {
      problems.collect([&] { add_pose(row, found.maps); });
    }
  }
  problems.throw_if_any();
  return found;
}

std::vector<ManifestPair> pairs_of(const MapFolder& folder, const FolderPairOptions& options, int num_threads) {
  require_valid(options, "pairs_of");
  std::vector<ManifestPair> pairs;
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t target = 0; target < folder.maps.size(); ++target) {
    for (std::size_t source = options.both_orders ? 0 : target + 1; source < folder.maps.size(); ++source) {
      if (source != target) {
        pairs.push_back(unknown_pair(folder, target, source));
        places.emplace_back(target, source);
      }
    }
  }
  const std::vector<SeenMap> maps = read_maps(folder, num_threads);
  parallel_for(pairs.size(), num_threads, [&](std::size_t i, std::size_t) {
    const auto [target, source] = places[i];
    const std::optional<Pose2>& world_from_target = folder.maps[target].world_from_map;
    const std::optional<Pose2>& world_from_source = folder.maps[source].world_from_map;
    if (world_from_target && world_from_source) {
      tell_truth(pairs[i], maps[target], maps[source], inverse(*world_from_target) * *world_from_source, options);
    }
  });
  return pairs;
}

}  // namespace gridmerge
