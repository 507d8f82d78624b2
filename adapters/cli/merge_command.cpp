#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/interrupt.hpp"
#include "cli/json.hpp"
#include "cli/output_folder.hpp"
#include "cli/program.hpp"
#include "cli/read_maps.hpp"
#include "cli/serial_merge.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "cli/watch.hpp"
#include "gridmerge/fuse/robot_pose.hpp"
#include "map_server/map_files.hpp"
#include "report/overlay.hpp"

namespace gridmerge::cli {
namespace {

struct MergeArguments {
  std::vector<std::string> files;
  std::filesystem::path folder;
  std::string format = "pgm";
  std::string rule;
  std::vector<std::string> robots;
  ConfigurationChoice choice;
  SearchArguments search;
  bool json = false;
};

constexpr const char* kMapFile = "merged.yaml";
constexpr const char* kOverlayFile = "overlay.png";
constexpr const char* kReportFile = "report.json";

std::string image_file(const MergeArguments& arguments) { return "merged." + arguments.format; }

double seconds_since(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// `files` [i] for each index.
Json names_json(const std::vector<std::size_t>& maps, const std::vector<std::string>& files) {
  Json names = Json::array();
  for (const std::size_t map : maps) {
    names.push_back(files[map]);
  }
  return names;
}

/// The merged maps and the robots in them.
Json island_json(const SerialMerge& merge, const std::vector<RobotArgument>& robots, const MergeArguments& arguments) {
  Json maps = Json::array();
  Json robots_in_it = Json::array();
  for (const MergedMap& one : merge.merged) {
    const Pose2& pose = one.merged_from_map.pose;
    maps.push_back({{"file", arguments.files[one.map]},
                    {"pose", pose_json(pose)},
                    {"covariance", covariance_json(one.merged_from_map.covariance)}});
    for (const RobotArgument& robot : robots) {
      if (robot.map == one.map) {
        robots_in_it.push_back({{"file", arguments.files[one.map]},
                                {"pose_in_map", pose_json(robot.map_from_robot)},
                                {"pose", pose_json(merged_from_robot(pose, robot.map_from_robot))}});
      }
    }
  }
  return {{"maps", maps},
          {"map", kMapFile},
          {"image", image_file(arguments)},
          {"overlay", kOverlayFile},
          {"robots", robots_in_it}};
}

Json report_json(const SerialMerge& merge, const std::vector<RobotArgument>& robots, const MergeArguments& arguments) {
  Json report = {{"status", merge.merged.empty() ? "not_merged" : "merged"},
                 {"islands", Json::array()},
                 {"left_out", Json::array()},
                 {"alignments", Json::array()},
                 {"stopped", merge.stopped}};
  if (!merge.merged.empty()) {
    report["islands"].push_back(island_json(merge, robots, arguments));
  }
  for (const LeftOutMap& one : merge.left_out) {
    report["left_out"].push_back({{"file", arguments.files[one.map]}, {"reason", one.reason}});
  }
  for (const MergeAttempt& attempt : merge.attempts) {
    Json json = {{"target", names_json(attempt.targets, arguments.files)}, {"source", arguments.files[attempt.source]}};
    json.update(alignment_json(attempt.alignment));
    json["seconds"] = seconds_json(0, attempt.alignment.seconds);
    json["seconds"].erase("load");
    report["alignments"].push_back(json);
  }
  return report;
}

std::string merge_text(const SerialMerge& merge, const MergeArguments& arguments, bool written) {
  const std::vector<std::string>& files = arguments.files;
  std::string text;
  if (merge.merged.empty()) {
    text = "Not merged: nothing is written.\n";
  } else {
    text = written ? "Merged " : "Interrupted: nothing is written. So far there fit together ";
    text += std::to_string(merge.merged.size()) + " of " + std::to_string(files.size()) + " maps.\n";
    for (const MergedMap& one : merge.merged) {
      text += "\n" + files[one.map] + "\n  " + pose_text(one.merged_from_map.pose) + "\n";
      if (&one != &merge.merged.front()) {
        text += "  standard deviation " + deviation_text(one.merged_from_map.covariance) + "\n";
      }
    }
  }
  if (!merge.left_out.empty()) {
    text += "\nLeft out\n";
    for (const LeftOutMap& one : merge.left_out) {
      text += "  - " + files[one.map] + ": " + one.reason + "\n";
    }
  }
  if (written) {
    text += "\nWritten to " + arguments.folder.string() + "\n  " + kMapFile + ", " + image_file(arguments) + ", " +
            kOverlayFile + ", " + kReportFile + "\n";
  }
  return text;
}

/// All files of the result, or none. Adds to the report how long fusing took.
void write_result(const SerialMerge& merge, const std::vector<OccupancyGrid>& maps, const Configuration& configuration,
                  const MergeArguments& arguments, Json& report) {
  const std::vector<PlacedMap> placed = placed_maps(maps, merge.merged);
  const auto began = std::chrono::steady_clock::now();
  const OccupancyGrid merged = fuse(placed, configuration.fuse(), configuration.threads());
  report["seconds"]["fuse"] = seconds_since(began);
  std::vector<OverlayMap> named;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    named.push_back({placed[i], std::filesystem::path(arguments.files[merge.merged[i].map]).filename().string()});
  }
  const bool ternary = std::all_of(merged.cells.begin(), merged.cells.end(), [](std::int8_t cell) {
    return cell == kUnknown || cell == kFree || cell == kOccupied;
  });
  const OutputFolder folder(arguments.folder);
  WholeFiles files;
  stage_map(files, merged, arguments.folder / kMapFile,
            {.mode = ternary ? MapMode::kTrinary : MapMode::kRaw,
             .format = arguments.format == "png" ? ImageFormat::kPng : ImageFormat::kPgm});
  files.stage(arguments.folder / kOverlayFile, encode_png(draw_overlay(named, {}, configuration.threads()).image));
  files.stage(arguments.folder / kReportFile, json_text(report));
  files.commit();
}

int run_merge(MergeArguments arguments, const MethodRegistry& methods, std::ostream& out) {
  const std::optional<PosePrior> prior = parse_prior(arguments.search.prior);
  if (prior && arguments.files.size() > 2) {
    throw UsageError("--prior says where the second of two maps lies; there are " +
                     std::to_string(arguments.files.size()) + " maps");
  }
  const std::optional<double> time_limit = parse_time_limit(arguments.search.time_limit);
  std::vector<RobotArgument> robots;
  for (const std::string& text : arguments.robots) {
    robots.push_back(parse_robot(text, arguments.files.size()));
  }
  if (!arguments.rule.empty()) {
    arguments.choice.set.push_back("fuse.rule=" + arguments.rule);
  }
  Configuration configuration(methods, arguments.choice);
  TraceFile trace(arguments.search.trace);
  (void)OutputFolder(arguments.folder);  // better to know now than after the search

  Progress progress(terminal());
  progress.on_stage("read");
  const auto began = std::chrono::steady_clock::now();
  const std::vector<OccupancyGrid> maps = read_maps(arguments.files, configuration.threads());
  const double load = seconds_since(began);

  const StopToken stop = stop_after(time_limit);
  const Interrupt interrupt(stop);
  Watch watch({&progress, &trace});
  const SerialMerge merge =
      merge_serially({maps, prior, configuration.methods(), configuration.pipeline(), configuration.fuse()},
                     {configuration.seed(), configuration.threads(), stop, &watch});
  progress.finish();
  const bool write = !merge.merged.empty() && !interrupt.happened();
  Json report = report_json(merge, robots, arguments);
  report.update(configuration_json(configuration));
  report["prior"] = prior_json(prior);
  report["written"] = write;
  report["seconds"] = {{"load", load}, {"merge", seconds_since(began) - load}};
  trace.write();
  if (write) {
    write_result(merge, maps, configuration, arguments, report);
  }
  out << (arguments.json ? json_text(report) : merge_text(merge, arguments, write));
  return write ? kDone : kNotMerged;
}

}  // namespace

Command merge_command(const CommandContext& context) {
  const auto arguments = std::make_shared<MergeArguments>();
  CLI::App* command = context.app.add_subcommand("merge", "Merges two maps or more into one");
  command->add_option("MAPS", arguments->files, "Maps (map_server YAML); the merged map lies in the frame of the first")
      ->required()
      ->expected(-2)
      ->option_text("A B [C ...] REQUIRED");
  command->add_option("-o,--output", arguments->folder, "Folder for merged.yaml, its image, overlay.png, report.json")
      ->type_name("DIR")
      ->required();
  command->add_option("--format", arguments->format, "Image of the merged map (pgm)")
      ->type_name("pgm|png")
      ->check(CLI::IsMember({"pgm", "png"}));
  command
      ->add_option("--rule", arguments->rule, "How a cell's value is made of several: short for --set fuse.rule=NAME")
      ->type_name("NAME");
  command->add_option("--robot", arguments->robots, "A robot's pose in the N-th map; the report says where it is now")
      ->type_name("N:X,Y,YAW")
      ->allow_extra_args(false);
  add_method_arguments(*command, arguments->choice);
  add_configuration_arguments(*command, arguments->choice);
  add_search_arguments(*command, arguments->search);
  command->add_flag("--json", arguments->json, "The report on standard output instead of words");
  command->footer(
      "\nMaps that do not fit are left out and named with the reason. Where nothing merges, nothing is written.\n"
      "Exit status: 0 merged, 3 not merged (or interrupted), 1 a file is wrong, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_merge(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
