/// gridmerge_scene: draws a pair of maps with known truth.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <variant>

#include "map_server/map_files.hpp"
#include "worlds/scene.hpp"

namespace {

using gridmerge::option_list;
using gridmerge::OptionField;
using gridmerge::OptionList;
using gridmerge::Pose2;
using gridmerge::worlds::MapPair;
using gridmerge::worlds::SceneOptions;

/// One `--key` for each option, with its unit, meaning and range.
void add_options(CLI::App& app, const OptionList& list) {
  for (const OptionField& field : list.fields()) {
    const std::string unit = field.text.unit.empty() ? "" : " [" + field.text.unit + "]";
    const std::string meaning = field.text.meaning + unit + " (" + field.range_text() + ")";
    const std::string name = "--" + field.key;
    const auto add = [&](auto* value) { app.add_option(name, *value, meaning)->capture_default_str(); };
    std::visit(add, field.value);
  }
}

nlohmann::ordered_json truth_of(const SceneOptions& options, const MapPair& pair) {
  SceneOptions described = options;
  nlohmann::ordered_json scene;
  for (const auto& [key, value] : option_list(described).values()) {
    scene[key] = value;
  }
  const Pose2& pose = pair.target_from_source;
  return {{"target", "a.yaml"},
          {"source", "b.yaml"},
          {"target_from_source", {{"x", pose.x_m}, {"y", pose.y_m}, {"theta", pose.theta_rad}}},
          {"overlap", pair.overlap},
          {"scene", scene}};
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Draws two maps of robots in one world, and where the second lies in the first.");
  SceneOptions options;
  std::filesystem::path folder = ".";
  app.add_option("-o,--output", folder, "Folder for a.yaml, b.yaml, their images and truth.json")->required();
  add_options(app, option_list(options));
  CLI11_PARSE(app, argc, argv);
  try {
    const MapPair pair = make_scene(options);
    const gridmerge::WriteOptions format = {
        .mode = options.probabilistic ? gridmerge::MapMode::kRaw : gridmerge::MapMode::kTrinary,
        .format = gridmerge::ImageFormat::kPgm};
    std::filesystem::create_directories(folder);
    write_map(pair.target, folder / "a.yaml", format);
    write_map(pair.source, folder / "b.yaml", format);
    gridmerge::write_whole_file(folder / "truth.json", truth_of(options, pair).dump(2) + "\n");
  } catch (const std::exception& error) {
    std::cerr << "gridmerge_scene: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
