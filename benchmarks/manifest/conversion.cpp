#include "manifest/conversion.hpp"

#include <set>

#include "gridmerge/base/error.hpp"
#include "manifest/known_area.hpp"
#include "map_server/map_files.hpp"
#include "worlds/scene.hpp"

namespace gridmerge {

namespace fs = std::filesystem;

void write_conversion(const fs::path& out, const std::vector<NamedGrid>& maps, const std::vector<ManifestPair>& pairs) {
  WholeFiles files;
  std::set<std::string> names;
  for (const NamedGrid& map : maps) {
    if (!names.insert(map.name).second) {
      throw InputError((out / (map.name + ".yaml")).string(), "two maps have this name");
    }
    stage_map(files, map.grid, out / (map.name + ".yaml"), {.mode = MapMode::kTrinary, .format = ImageFormat::kPng});
  }
  if (!pairs.empty()) {
    files.stage(out / "pairs.csv", manifest_text(out / "pairs.csv", pairs));
  }
  files.commit();
}

void check_output_folder(const fs::path& in, const fs::path& out) {
  if (!fs::is_directory(out)) {
    throw InputError(out.string(), "is no folder");
  }
  std::error_code ignored;
  if (fs::equivalent(in, out, ignored)) {
    throw InputError(out.string(), "is the folder that is read: the result must go to another");
  }
}

ManifestPair pair_of(const std::string& set, const NamedGrid& target, const NamedGrid& source,
                     const std::optional<KnownPose>& truth, const std::string& tags) {
  ManifestPair pair = {
      .set = set,
      .target_name = target.name + ".yaml",
      .source_name = source.name + ".yaml",
      .target_yaml = {},
      .source_yaml = {},
      .truth = truth,
      .scenario = tags.substr(0, tags.find(' ')),
      .tags = tags,
      .source_centre = Point2{with_decimals(source.centre.x_m, 3), with_decimals(source.centre.y_m, 3)}};
  if (pair.truth) {
    Pose2& pose = pair.truth->target_from_source;
    pose = {with_decimals(pose.x_m, 4), with_decimals(pose.y_m, 4), with_decimals(pose.theta_rad, 6)};
    pair.overlap = with_decimals(worlds::overlap_of(target.grid, source.grid, pose), 3);
  }
  return pair;
}

}  // namespace gridmerge
