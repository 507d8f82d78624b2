#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/json.hpp"
#include "cli/program.hpp"
#include "cli/read_maps.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"

namespace gridmerge::cli {
namespace {

struct EvaluateArguments {
  std::string target;
  std::string source;
  std::string pose;
  ConfigurationChoice choice;
  bool json = false;
};

/// Proposes the pose it was given.
class OnePose final : public Merger {
 public:
  explicit OnePose(const Pose2& pose) : pose_(pose) {}
  [[nodiscard]] MergerTraits traits() const override { return {}; }
  [[nodiscard]] Proposal propose(const AlignRequest& /*request*/, const RunContext& /*context*/) const override {
    Proposal proposal;
    proposal.candidates = {{pose_, 0}};
    return proposal;
  }

 private:
  Pose2 pose_;
};

std::string evaluation_text(const Alignment& answer) {
  std::string text =
      "This pose, against the best others that a sweep over all poses finds: " + status_of(answer.outcome) +
      ", confidence " + fixed(answer.confidence, 2) + "\n\nWhy\n" + list_text(reasons_of(answer));
  if (answer.hypotheses.empty()) {
    return text;
  }
  text += "\nPose of B's map frame in A's\n  " + pose_text(answer.hypotheses.front().target_from_source.pose) +
          "\n\nFigures\n";
  const Json figures = figures_json(answer.hypotheses.front().figures, answer.verdict, answer.random_level);
  std::size_t widest = 0;
  for (const auto& [name, value] : figures.items()) {
    widest = std::max(widest, name.size());
  }
  for (const auto& [name, value] : figures.items()) {
    text += "  " + name + std::string(widest + 2 - name.size(), ' ') + fixed(value.get<double>(), 3) + "\n";
  }
  return text;
}

int run_evaluate(const EvaluateArguments& arguments, const MethodRegistry& methods, std::ostream& out) {
  const Pose2 pose = parse_pose(arguments.pose, "--pose");
  Configuration configuration(methods, arguments.choice);
  const auto began = std::chrono::steady_clock::now();
  const std::vector<OccupancyGrid> maps = read_maps({arguments.target, arguments.source}, configuration.threads());
  const std::chrono::duration<double> load = std::chrono::steady_clock::now() - began;
  PipelineOptions options = configuration.pipeline();
  options.refine = false;
  const Alignment answer = align({maps[0], maps[1], {}}, OnePose(pose), options,
                                 {.seed = configuration.seed(), .num_threads = configuration.threads(), .stop = {}});
  if (arguments.json) {
    Json json = alignment_json(answer);
    for (const char* key : {"covariance", "iterations", "stopped", "attempts", "choice"}) {
      json.erase(key);
    }
    json["target"] = arguments.target;
    json["source"] = arguments.source;
    for (Configuration::Section& section : configuration.sections()) {
      if (section.name == "prepare" || section.name == "evaluator" || section.name == "verdict") {
        json["options"][section.name] = options_json(section.options);
      }
    }
    json["seed"] = configuration.seed();
    json["threads"] = configuration.threads();
    json["seconds"] = {{"load", load.count()}, {"prepare", answer.seconds.prepare}, {"judge", answer.seconds.judge}};
    out << json_text(json);
  } else {
    out << evaluation_text(answer);
  }
  return answer.outcome == Outcome::kMerged ? kDone : kNotMerged;
}

}  // namespace

Command evaluate_command(const CommandContext& context) {
  const auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = context.app.add_subcommand("evaluate", "All figures of one pose, and what they are worth");
  command->add_option("A", arguments->target, "Map in whose frame the pose is (map_server YAML)")->required();
  command->add_option("B", arguments->source, "Map that moves")->required();
  command->add_option("--pose", arguments->pose, "Where B's map frame lies in A's [m, m, rad]")
      ->type_name("X,Y,THETA")
      ->required();
  add_configuration_arguments(*command, arguments->choice);
  command->add_flag("--json", arguments->json, "One JSON object on standard output instead of words");
  command->footer("\nExit status: 0 this pose would be merged, 3 it would not, 1 a file is wrong, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_evaluate(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
