#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/interrupt.hpp"
#include "cli/json.hpp"
#include "cli/program.hpp"
#include "cli/read_maps.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "cli/watch.hpp"

namespace gridmerge::cli {
namespace {

struct AlignArguments {
  std::string target;
  std::string source;
  ConfigurationChoice choice;
  SearchArguments search;
  bool json = false;
  bool explain = false;
};

int run_align(const AlignArguments& arguments, const MethodRegistry& methods, std::ostream& out) {
  const std::optional<PosePrior> prior = parse_prior(arguments.search.prior);
  const std::optional<double> time_limit = parse_time_limit(arguments.search.time_limit);
  Configuration configuration(methods, arguments.choice);
  if (arguments.explain && !configuration.chooses()) {
    throw UsageError("--explain tells how a method was chosen: it needs --method auto");
  }
  TraceFile trace(arguments.search.trace);

  Progress progress(terminal());
  progress.on_stage("read");
  const auto began = std::chrono::steady_clock::now();
  const std::vector<OccupancyGrid> maps = read_maps({arguments.target, arguments.source}, configuration.threads());
  const std::chrono::duration<double> load = std::chrono::steady_clock::now() - began;

  const StopToken stop = stop_after(time_limit);
  const Interrupt interrupt(stop);
  Watch watch({&progress, &trace});
  const Alignment alignment = align({maps[0], maps[1], prior}, configuration.methods(), configuration.pipeline(),
                                    {configuration.seed(), configuration.threads(), stop, &watch});
  progress.finish();
  trace.write();
  if (arguments.json) {
    Json answer = alignment_json(alignment);
    answer["target"] = arguments.target;
    answer["source"] = arguments.source;
    answer["prior"] = prior_json(prior);
    answer.update(configuration_json(configuration));
    answer["seconds"] = seconds_json(load.count(), alignment.seconds);
    for (const Attempt& one : alignment.attempts) {
      answer["seconds"]["attempts"].push_back(one.seconds);
    }
    out << json_text(answer);
  } else {
    out << alignment_text(alignment, load.count()) << (arguments.explain ? choice_text(alignment) : "");
  }
  return alignment.outcome == Outcome::kMerged && !interrupt.happened() ? kDone : kNotMerged;
}

}  // namespace

Command align_command(const CommandContext& context) {
  const auto arguments = std::make_shared<AlignArguments>();
  CLI::App* command = context.app.add_subcommand("align", "Finds where map B lies in map A, and how sure that is");
  command->add_option("A", arguments->target, "Map whose frame the answer is in (map_server YAML)")->required();
  command->add_option("B", arguments->source, "Map that moves")->required();
  add_method_arguments(*command, arguments->choice);
  add_configuration_arguments(*command, arguments->choice);
  add_search_arguments(*command, arguments->search);
  command->add_flag("--json", arguments->json, "One JSON object on standard output instead of words");
  command->add_flag("--explain", arguments->explain,
                    "With --method auto: what the maps look like, what every method bids, and why which one ran");
  command->footer("\nExit status: 0 merged, 3 not merged (or interrupted), 1 a file is wrong, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_align(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
