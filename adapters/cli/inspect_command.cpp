#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/inspection.hpp"
#include "cli/interrupt.hpp"
#include "cli/output_folder.hpp"
#include "cli/program.hpp"
#include "cli/read_maps.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "cli/watch.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge::cli {
namespace {

struct InspectArguments {
  std::string target;
  std::string source;
  std::filesystem::path folder;
  ConfigurationChoice choice;
  SearchArguments search;
};

constexpr const char* kPageFile = "index.html";

PageText page_text(const InspectArguments& arguments, const Configuration& configuration, const Alignment& alignment) {
  PageText text{.title = configuration.method() + ", profile " + configuration.profile() + ": what it sees",
                .verdict = verdict_text(alignment.outcome, alignment.confidence),
                .reasons = reasons_of(alignment),
                .facts = {"A, the target: " + arguments.target, "B, the source: " + arguments.source}};
  if (!alignment.hypotheses.empty()) {
    text.facts.push_back("Best pose of B's map frame in A's: " +
                         pose_text(alignment.hypotheses.front().target_from_source.pose));
  }
  text.facts.push_back("Seed " + std::to_string(configuration.seed()) + ", gridmerge " GRIDMERGE_VERSION);
  return text;
}

/// All files, or none.
void write_pictures(const InspectArguments& arguments, const std::string& page, const std::vector<Picture>& pictures) {
  const OutputFolder folder(arguments.folder);
  WholeFiles files;
  for (const Picture& picture : pictures) {
    files.stage(arguments.folder / picture.file, picture.bytes);
  }
  files.stage(arguments.folder / kPageFile, page);
  files.commit();
}

int run_inspect(const InspectArguments& arguments, const MethodRegistry& methods, std::ostream& out) {
  const std::optional<PosePrior> prior = parse_prior(arguments.search.prior);
  const std::optional<double> time_limit = parse_time_limit(arguments.search.time_limit);
  const Configuration configuration(methods, arguments.choice);
  TraceFile trace(arguments.search.trace);
  (void)OutputFolder(arguments.folder);  // better to know now than after the search

  Progress progress(terminal());
  progress.on_stage("read");
  const auto began = std::chrono::steady_clock::now();
  const std::vector<OccupancyGrid> maps = read_maps({arguments.target, arguments.source}, configuration.threads());
  const std::chrono::duration<double> load = std::chrono::steady_clock::now() - began;

  const StopToken stop = stop_after(time_limit);
  const Interrupt interrupt(stop);
  ViewRecorder recorder;
  Watch watch({&progress, &trace, &recorder});
  const AlignInput input{maps[0], maps[1], prior};
  const Alignment alignment = align(input, configuration.methods(), configuration.pipeline(),
                                    {configuration.seed(), configuration.threads(), stop, &watch});
  progress.finish();
  trace.write();
  out << alignment_text(alignment, load.count());
  if (interrupt.happened()) {
    out << "\nInterrupted: no pictures are written.\n";
    return kNotMerged;
  }
  const std::vector<Picture> pictures =
      pictures_of(recorder.views(), input, alignment, configuration.pipeline().prepare, configuration.threads());
  write_pictures(arguments, page_html(page_text(arguments, configuration, alignment), pictures), pictures);
  out << "\nWritten to " << arguments.folder.string() << "\n  " << kPageFile << "\n";
  for (const Picture& picture : pictures) {
    out << "  " << picture.file << ": " << picture.title << "\n";
  }
  return kDone;
}

}  // namespace

Command inspect_command(const CommandContext& context) {
  const auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = context.app.add_subcommand("inspect", "Draws what a method sees inside on its way to an answer");
  command->add_option("METHOD", arguments->choice.method, "The method; 'gridmerge methods' lists them")->required();
  command->add_option("A", arguments->target, "Map whose frame the answer is in (map_server YAML)")->required();
  command->add_option("B", arguments->source, "Map that moves")->required();
  command
      ->add_option("-o,--output", arguments->folder, "Folder for the pictures (PNG) and index.html, which shows them")
      ->type_name("DIR")
      ->required();
  add_profile_argument(*command, arguments->choice);
  add_configuration_arguments(*command, arguments->choice);
  add_search_arguments(*command, arguments->search);
  command->footer(
      "\nThe answer is the one that 'align' gives. Views that cost time are made here only.\n"
      "Exit status: 0 the pictures are written, 3 interrupted, 1 a file is wrong, 2 wrong usage.");
  const MethodRegistry& methods = context.methods;
  return {command, [arguments, &methods](std::ostream& out) { return run_inspect(*arguments, methods, out); }};
}

}  // namespace gridmerge::cli
