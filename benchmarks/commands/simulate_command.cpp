#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "cli/output_folder.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "commands/commands.hpp"
#include "commands/option_arguments.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/known_area.hpp"
#include "manifest/manifest.hpp"
#include "map_server/map_files.hpp"
#include "worlds/scene.hpp"
#include "worlds/swarm.hpp"

namespace gridmerge::cli {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

struct SimulateArguments {
  worlds::SceneOptions scene;
  fs::path folder;
  int pairs = 1;
  int robots = 2;
  double tolerance_m = 0.5;
  double tolerance_deg = 3;
};

WriteOptions format_of(const worlds::SceneOptions& scene) {
  return {.mode = scene.probabilistic ? MapMode::kRaw : MapMode::kTrinary, .format = ImageFormat::kPgm};
}

ordered_json pose_record(const Pose2& pose) { return {{"x", pose.x_m}, {"y", pose.y_m}, {"theta", pose.theta_rad}}; }

ordered_json scene_record(worlds::SceneOptions scene) {
  ordered_json record;
  for (const auto& [key, value] : option_list(scene).values()) {
    record[key] = value;
  }
  return record;
}

std::string truth_text(const worlds::SceneOptions& scene, const worlds::MapPair& pair) {
  const ordered_json truth = {{"target", "a.yaml"},
                              {"source", "b.yaml"},
                              {"truth", pair.truth_is_same ? "same" : "different"},
                              {"target_from_source", pose_record(pair.target_from_source)},
                              {"overlap", pair.overlap},
                              {"pose_error", {{"m", pair.pose_error_m}, {"rad", pair.pose_error_rad}}},
                              {"scene", scene_record(scene)}};
  return truth.dump(2) + "\n";
}

void check_scene(const worlds::SceneOptions& scene) {
  std::string problems;
  for (const std::string& problem : scene_problems(scene)) {
    problems += (problems.empty() ? "" : "\n") + problem;
  }
  if (!problems.empty()) {
    throw UsageError(problems);
  }
}

/// @throws UsageError for what only pairs have
worlds::Swarm swarm_of(const SimulateArguments& arguments) {
  try {
    return make_swarm(arguments.scene, arguments.robots, available_threads());
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

/// A row of pairs.csv; `prefix` leads from there to the pair's maps.
ManifestPair listed(const SimulateArguments& arguments, const worlds::SceneOptions& scene, const worlds::MapPair& pair,
                    const fs::path& prefix) {
  ManifestPair row = {.set = scene.kind,
                      .target_name = (prefix / "a.yaml").generic_string(),
                      .source_name = (prefix / "b.yaml").generic_string(),
                      .target_yaml = arguments.folder / prefix / "a.yaml",
                      .source_yaml = arguments.folder / prefix / "b.yaml",
                      .truth = {},
                      .scenario = scene.kind};
  row.tags = scene.kind + " " + scene.relation;
  row.overlap = pair.overlap;
  row.source_centre = centre_of_known(pair.source);
  if (pair.truth_is_same) {
    row.truth = {.target_from_source = pair.target_from_source,
                 .tolerance_m = arguments.tolerance_m,
                 .tolerance_rad = radians(arguments.tolerance_deg)};
  }
  return row;
}

void write_pair(const fs::path& folder, const worlds::SceneOptions& scene, const worlds::MapPair& pair) {
  fs::create_directories(folder);
  WholeFiles files;
  stage_map(files, pair.target, folder / "a.yaml", format_of(scene));
  stage_map(files, pair.source, folder / "b.yaml", format_of(scene));
  files.stage(folder / "truth.json", truth_text(scene, pair));
  files.commit();
}

std::string told(const worlds::MapPair& pair) {
  return (pair.truth_is_same ? "B in A: " + pose_text(pair.target_from_source) : std::string("nothing in common")) +
         ", overlap " + fixed(100 * pair.overlap, 0) + " %";
}

int simulate_pairs(SimulateArguments arguments, std::ostream& out) {
  const OutputFolder output(arguments.folder);
  std::vector<ManifestPair> rows;
  const int first = arguments.scene.seed;
  for (int i = 0; i < arguments.pairs; ++i) {
    arguments.scene.seed = first + i;
    const worlds::MapPair pair = make_scene(arguments.scene);
    const fs::path prefix =
        arguments.pairs == 1 ? "" : arguments.scene.kind + "-" + std::to_string(arguments.scene.seed);
    write_pair(arguments.folder / prefix, arguments.scene, pair);
    rows.push_back(listed(arguments, arguments.scene, pair, prefix));
    out << (arguments.folder / prefix / "a.yaml").string() << ", b.yaml: " << told(pair) << std::endl;
  }
  write_manifest(arguments.folder / "pairs.csv", rows);
  out << (arguments.folder / "pairs.csv").string() << ": the truth of " << rows.size()
      << (rows.size() == 1 ? " pair\n" : " pairs\n");
  return kDone;
}

int simulate_swarm(const SimulateArguments& arguments, std::ostream& out) {
  const OutputFolder output(arguments.folder);
  const worlds::Swarm swarm = swarm_of(arguments);
  WholeFiles files;
  std::string world = "map,x,y,theta\n";
  for (std::size_t i = 0; i < swarm.maps.size(); ++i) {
    const std::string name = "robot" + std::to_string(i + 1) + ".yaml";
    const Pose2& pose = swarm.world_from_map[i];
    stage_map(files, swarm.maps[i], arguments.folder / name, format_of(arguments.scene));
    world += name + "," + exact(pose.x_m) + "," + exact(pose.y_m) + "," + exact(pose.theta_rad) + "\n";
    out << (arguments.folder / name).string() << ": in the world " << pose_text(pose) << "\n";
  }
  files.stage(arguments.folder / "world.csv", world);
  files.commit();
  out << (arguments.folder / "world.csv").string() << ": where each map's frame lies\n";
  return kDone;
}

int run_simulate(SimulateArguments arguments, std::ostream& out) {
  check_scene(arguments.scene);
  if (arguments.robots > 2 && arguments.pairs > 1) {
    throw UsageError("--pairs: must be 1 where --robots is more than 2");
  }
  return arguments.robots > 2 ? simulate_swarm(arguments, out) : simulate_pairs(std::move(arguments), out);
}

}  // namespace

Command simulate_command(const CommandContext& context) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command =
      context.app.add_subcommand("simulate", "Draws maps of robots in a made-up world, with the exact truth");
  command
      ->add_option("-o,--output", arguments->folder,
                   "Folder for a.yaml, b.yaml, truth.json and pairs.csv; many robots: robotN.yaml and world.csv")
      ->required();
  command
      ->add_option("--pairs", arguments->pairs,
                   "So many pairs, with the seeds that follow; each in a folder of its own")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_option("--robots", arguments->robots, "How many robots share the world")
      ->check(CLI::Range(2, 32))
      ->capture_default_str();
  command->add_option("--tolerance_m", arguments->tolerance_m, "What pairs.csv calls right [m]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_option("--tolerance_deg", arguments->tolerance_deg, "The same for the heading [deg]")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  add_options(*command, option_list(arguments->scene));
  command->footer("\nThe same options give the same bytes on every machine.");
  return {command, [arguments](std::ostream& out) { return run_simulate(*arguments, out); }};
}

}  // namespace gridmerge::cli
