#include "commands/pair_again.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"
#include "map_server/map_files.hpp"
#include "worlds/scene.hpp"
#include "worlds/swarm.hpp"
#include "worlds/tracks.hpp"

namespace gridmerge::cli {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const study::Row& row, const std::string& why) {
  throw InputError("run " + std::to_string(row.run), "pair_spec: " + why);
}

json spec_of(const study::Row& row) {
  json spec = json::parse(row.pair_spec, nullptr, false);
  if (!spec.is_object()) {
    refuse(row, "is no JSON object");
  }
  return spec;
}

worlds::SceneOptions scene_of(const study::Row& row, const json& values) {
  worlds::SceneOptions scene;
  const OptionList list = option_list(scene);
  for (const OptionField& field : list.fields()) {
    const auto value = values.find(field.key);
    if (value == values.end()) {
      continue;  // of an older version, which had no such option: its default keeps what was drawn then
    }
    try {
      std::visit([&](auto* option) { value->get_to(*option); }, field.value);
    } catch (const json::exception& error) {
      refuse(row, field.key + ": " + error.what());
    }
  }
  return scene;
}

std::string file_of(const study::Row& row, const json& spec, const char* key) {
  const auto file = spec.find(key);
  if (file == spec.end() || !file->is_string()) {
    refuse(row, std::string("has no scene, and no ") + key);
  }
  return file->get<std::string>();
}

/// As a shell takes it for one word.
std::string quoted(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
    return word;
  }
  std::string text = "'";
  for (const char c : word) {
    text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return text + "'";
}

/// The options that are not the default.
std::string scene_arguments(worlds::SceneOptions scene) {
  worlds::SceneOptions defaults;
  const auto values = option_list(scene).values();
  const auto usual = option_list(defaults).values();
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto& [key, value] = values[i];
    if (value != usual[i].second || key == "kind" || key == "seed") {
      text += " --" + key + " " + quoted(value);
    }
  }
  return text;
}

std::string align_arguments(const study::Row& row) {
  std::string text = " --method " + quoted(row.method) + " --profile " + quoted(row.profile);
  for (std::size_t from = 0; from < row.options.size();) {
    const std::size_t to = std::min(row.options.find(' ', from), row.options.size());
    text += " --set " + quoted(row.options.substr(from, to - from));
    from = to + 1;
  }
  if (std::isfinite(row.prior_x_m)) {
    text += " --prior " + exact(row.prior_x_m) + "," + exact(row.prior_y_m) + "," + exact(row.prior_theta_rad) + "," +
            exact(row.window_m) + "," + exact(row.window_deg);
  }
  return text + " --seed " + std::to_string(row.seed) + " --threads " + std::to_string(row.threads);
}

}  // namespace

page::PairMaps maps_again(const study::Row& row) {
  const json spec = spec_of(row);
  if (const auto scene = spec.find("scene"); scene != spec.end()) {
    const worlds::SceneOptions options = scene_of(row, *scene);
    worlds::MapPair pair = make_scene(options);
    worlds::Tracks tracks = tracks_of(options, pair);
    return {std::move(pair.target), std::move(pair.source), std::move(tracks)};
  }
  if (const auto swarm = spec.find("swarm"); swarm != spec.end()) {
    worlds::Swarm drawn = make_swarm(scene_of(row, *swarm), row.robots);
    return {std::move(drawn.maps[0]), std::move(drawn.maps[1]), {}};
  }
  return {read_map(file_of(row, spec, "target")), read_map(file_of(row, spec, "source")), {}};
}

std::string command_again(const study::Row& row) {
  const json spec = spec_of(row);
  if (spec.contains("swarm")) {
    return "";
  }
  if (const auto scene = spec.find("scene"); scene != spec.end()) {
    return "gridmerge simulate -o maps" + scene_arguments(scene_of(row, *scene)) +
           " && gridmerge align maps/a.yaml maps/b.yaml" + align_arguments(row);
  }
  return "gridmerge align " + quoted(file_of(row, spec, "target")) + " " + quoted(file_of(row, spec, "source")) +
         align_arguments(row);
}

}  // namespace gridmerge::cli
