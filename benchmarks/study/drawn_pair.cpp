#include "study/drawn_pair.hpp"

#include <limits>
#include <type_traits>

#include "cli/json.hpp"
#include "map_server/map_files.hpp"
#include "worlds/swarm.hpp"

namespace gridmerge::study {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
/// Scenes that share less than this of the source's known area share nothing that could be found.
constexpr double kLeastOverlap = 0.01;

DrawnPair drawn(const SceneMaps& choice) {
  worlds::MapPair scene = worlds::make_scene(choice.scene);
  DrawnPair pair;
  pair.overlap = scene.overlap;
  pair.truth = scene.truth_is_same && scene.overlap >= kLeastOverlap ? "same" : "different";
  pair.first_from_map = {{}, scene.target_from_source};
  pair.maps.push_back(std::move(scene.target));
  pair.maps.push_back(std::move(scene.source));
  return pair;
}

DrawnPair drawn(const SwarmMaps& choice) {
  DrawnPair pair;
  pair.overlap = kNotKnown;
  pair.truth = "same";
  worlds::Swarm swarm = worlds::make_swarm(choice.scene, choice.robots);
  pair.maps = std::move(swarm.maps);
  for (const Pose2& world_from_map : swarm.world_from_map) {
    pair.first_from_map.push_back(inverse(swarm.world_from_map.front()) * world_from_map);
  }
  return pair;
}

DrawnPair drawn(const FileMaps& choice) {
  DrawnPair pair;
  pair.maps = {read_map(choice.target_yaml), read_map(choice.source_yaml)};
  pair.truth = choice.truth;
  pair.overlap = kNotKnown;
  if (choice.known) {
    pair.first_from_map = {{}, choice.known->target_from_source};
    pair.overlap = worlds::overlap_of(pair.maps[0], pair.maps[1], choice.known->target_from_source);
  }
  return pair;
}

std::size_t bytes_of(const PreparedMap& map) {
  std::size_t bytes = map.walls().size() * sizeof(WallPoint) + map.occupancy().size();
  for (int level = 0; level < PreparedMap::kLevels && map.known_cells() > 0; ++level) {
    bytes += map.level(level).state.size() * (sizeof(CellState) + sizeof(float));
  }
  return bytes;
}

}  // namespace

DrawnPair draw(const PairChoice& choice, bool keep_prepared) {
  DrawnPair pair = std::visit([](const auto& maps) { return drawn(maps); }, choice.maps);
  const PrepareOptions options;
  const bool is_pair = !choice.is_swarm();
  for (const OccupancyGrid& map : pair.maps) {
    const double resolution_m =
        is_pair ? common_resolution_m(pair.maps[0], pair.maps[1], options) : common_resolution_m(map, map, options);
    auto prepared = std::make_shared<const PreparedMap>(map, resolution_m, options);
    pair.centre_in_map.push_back(prepared->centre_in_map());
    pair.walls.push_back(static_cast<std::int64_t>(prepared->walls().size()));
    pair.bytes += map.cells.size();
    if (is_pair) {
      pair.features.push_back(scene_features(*prepared));
    }
    if (keep_prepared && is_pair) {
      pair.bytes += bytes_of(*prepared);
      (pair.target ? pair.source : pair.target) = std::move(prepared);
    }
  }
  return pair;
}

std::string spec_of(const PairChoice& choice) {
  const auto scene_json = [](worlds::SceneOptions scene) { return cli::options_json(option_list(scene)); };
  cli::Json json;
  if (const auto* scene = std::get_if<SceneMaps>(&choice.maps)) {
    json["scene"] = scene_json(scene->scene);
  } else if (const auto* swarm = std::get_if<SwarmMaps>(&choice.maps)) {
    json["swarm"] = scene_json(swarm->scene);
    json["robots"] = swarm->robots;
  } else {
    const auto& files = std::get<FileMaps>(choice.maps);
    json["target"] = files.target_yaml.string();
    json["source"] = files.source_yaml.string();
  }
  return json.dump(-1, ' ', false, cli::Json::error_handler_t::replace);
}

}  // namespace gridmerge::study
