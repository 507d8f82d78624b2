#include "manifest/folder_conversion.hpp"

#include "manifest/known_area.hpp"
#include "manifest/problem_list.hpp"
#include "map_server/map_files.hpp"

namespace gridmerge {
namespace {

std::string stem_of(const std::string& name) { return std::filesystem::path(name).stem().string(); }

std::vector<NamedGrid> read_all(const MapFolder& folder) {
  std::vector<NamedGrid> maps;
  ProblemList problems;
  for (const FolderMap& map : folder.maps) {
    problems.collect([&] { maps.push_back({.name = stem_of(map.name), .grid = read_map(map.yaml), .centre = {}}); });
  }
  problems.throw_if_any();
  return maps;
}

/// The pair as the maps that are written have it: their YAML files all end in .yaml.
ManifestPair renamed(ManifestPair pair) {
  pair.target_name = stem_of(pair.target_name) + ".yaml";
  pair.source_name = stem_of(pair.source_name) + ".yaml";
  pair.overlap = with_decimals(*pair.overlap, 3);
  pair.source_centre = Point2{with_decimals(pair.source_centre->x_m, 3), with_decimals(pair.source_centre->y_m, 3)};
  if (pair.truth) {
    Pose2& pose = pair.truth->target_from_source;
    pose = {with_decimals(pose.x_m, 4), with_decimals(pose.y_m, 4), with_decimals(pose.theta_rad, 6)};
  }
  return pair;
}

std::string why_left_out(const ManifestPair& pair, const std::filesystem::path& path) {
  const std::string names = path.string() + ": " + pair.target_name + ", " + pair.source_name + ": ";
  return names + (pair.overlap ? "too little is shared to call a pose right" : "world.csv does not tell both poses");
}

}  // namespace

Conversion convert_folder(const std::filesystem::path& path, const std::filesystem::path& out,
                          const FolderPairOptions& options, int num_threads) {
  check_output_folder(path, out);
  const MapFolder folder = read_map_folder(path);
  const std::vector<NamedGrid> maps = read_all(folder);
  Conversion result = {.maps = maps.size(), .pairs = 0, .left_out = {}};
  std::vector<ManifestPair> pairs;
  for (const ManifestPair& pair : pairs_of(folder, options, num_threads)) {
    if (pair.truth_known) {
      pairs.push_back(renamed(pair));
    } else {
      result.left_out.push_back(why_left_out(pair, path));
    }
  }
  result.pairs = pairs.size();
  write_conversion(out, maps, pairs);
  return result;
}

}  // namespace gridmerge
