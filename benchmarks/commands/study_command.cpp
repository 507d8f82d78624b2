#include <CLI/CLI.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <memory>
#include <ostream>

#include "cli/interrupt.hpp"
#include "cli/output_folder.hpp"
#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "cli/watch.hpp"
#include "commands/commands.hpp"
#include "commands/pair_again.hpp"
#include "gridmerge/base/parallel.hpp"
#include "map_server/whole_files.hpp"
#include "page/page.hpp"
#include "study/compare.hpp"
#include "study/journal.hpp"
#include "study/rows_csv.hpp"
#include "study/runner.hpp"
#include "study/shards.hpp"

namespace gridmerge::cli {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  fs::path file;
  fs::path folder;
  std::string shard = "1/1";
  int jobs = 0;
  int pictures = 40;
  std::vector<fs::path> before;
  std::vector<fs::path> after;
  study::CompareOptions compare;
};

study::Shard parse_shard(const std::string& text) {
  study::Shard shard;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, shard.index);
  const bool split = error == std::errc{} && slash != end && *slash == '/';
  const auto [rest, rest_error] =
      split ? std::from_chars(slash + 1, end, shard.of) : std::from_chars_result{end, error};
  if (!split || rest_error != std::errc{} || rest != end || shard.index < 1 || shard.index > shard.of) {
    throw UsageError("--shard '" + text + "': must be I/N: part I of N, with 1 <= I <= N");
  }
  return shard;
}

int jobs_of(const StudyArguments& arguments) { return arguments.jobs > 0 ? arguments.jobs : available_threads(); }

/// "2 h 05 min", "3 min 20 s", "12 s"
std::string duration(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::ceil(seconds));
  const auto two = [](std::int64_t n) { return (n < 10 ? "0" : "") + std::to_string(n); };
  if (whole >= 3600) {
    return std::to_string(whole / 3600) + " h " + two(whole % 3600 / 60) + " min";
  }
  return whole >= 60 ? std::to_string(whole / 60) + " min " + two(whole % 60) + " s" : std::to_string(whole) + " s";
}

std::string progress_text(const study::Progress& progress) {
  std::string text = std::to_string(progress.done) + " of " + std::to_string(progress.of) + " runs";
  if (progress.runs_per_s > 0) {
    text += ", " + fixed(progress.runs_per_s, 1) + " a second";
  }
  if (std::isfinite(progress.seconds_left) && progress.done < progress.of) {
    text += ", " + duration(progress.seconds_left) + " left";
  }
  return text;
}

/// One line that is written over and over; where nobody watches, a line every tenth of the way.
class ProgressLine final : public study::ProgressSink {
 public:
  ProgressLine(std::ostream* watched, std::ostream& log) : watched_(watched), log_(log) {}

  void on_progress(const study::Progress& progress) override {
    if (watched_ != nullptr) {
      *watched_ << "\r\x1b[K" << progress_text(progress) << std::flush;
      return;
    }
    const std::int64_t tenth = progress.of == 0 ? 10 : 10 * progress.done / progress.of;
    if (tenth > told_) {
      told_ = tenth;
      log_ << progress_text(progress) << std::endl;
    }
  }

  void finish() const {
    if (watched_ != nullptr) {
      *watched_ << "\r\x1b[K" << std::flush;
    }
  }

 private:
  std::ostream* watched_;
  std::ostream& log_;
  std::int64_t told_ = -1;
};

fs::path write_report(const StudyArguments& arguments) {
  const study::JournalContent journal = study::read_journal(arguments.folder);
  const std::vector<page::FailurePicture> failures = page::draw_failures(
      journal.rows, {.most = arguments.pictures, .num_threads = jobs_of(arguments), .maps_of = maps_again});
  const fs::path file = arguments.folder / "report.html";
  write_whole_file(file, page::report_page({.name = journal.study.name,
                                            .about = journal.study.about,
                                            .rows = journal.rows,
                                            .curves = journal.curves,
                                            .failures = failures,
                                            .command_of = command_again}));
  return file;
}

void tell_results(const StudyArguments& arguments, std::ostream& out) {
  out << "rows:   " << (arguments.folder / "rows.csv").string() << " (and rows.sqlite, with the curves)\n"
      << "report: " << write_report(arguments).string() << "\n";
}

int run_study_command(const StudyArguments& arguments, std::ostream& out) {
  if (arguments.file.empty() || arguments.folder.empty()) {
    throw UsageError("study: needs FILE and -o DIR; or one of merge, report, compare. See 'gridmerge study --help'");
  }
  const study::Shard shard = parse_shard(arguments.shard);
  const study::Study study = study::read_study(arguments.file);
  const OutputFolder output(arguments.folder);
  const StopToken stop;
  const Interrupt interrupt(stop);
  ProgressLine line(terminal(), out);
  const study::StudyOutcome outcome = study::run_study(
      study, {.folder = arguments.folder, .shard = shard, .jobs = jobs_of(arguments), .stop = stop}, line);
  line.finish();
  const std::string earlier =
      outcome.made < outcome.done ? " (" + std::to_string(outcome.done - outcome.made) + " from before)" : "";
  out << outcome.done << " of " << outcome.of << " runs done" << earlier << "\n";
  if (!outcome.complete()) {
    out << "stopped; the same command goes on from here\n";
    return kNotMerged;
  }
  if (shard.of > 1) {
    out << "this was part " << arguments.shard << "; when all are done: gridmerge study merge "
        << arguments.folder.string() << "\n";
    return kDone;
  }
  tell_results(arguments, out);
  return kDone;
}

int run_merge(const StudyArguments& arguments, std::ostream& out) {
  study::merge_shards(arguments.folder);
  tell_results(arguments, out);
  return kDone;
}

int run_report(const StudyArguments& arguments, std::ostream& out) {
  out << "report: " << write_report(arguments).string() << "\n";
  return kDone;
}

std::vector<study::Row> read_all(const std::vector<fs::path>& files) {
  std::vector<study::Row> rows;
  for (const fs::path& file : files) {
    for (study::Row& row : study::read_rows_csv(file)) {
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

int run_compare(const StudyArguments& arguments, std::ostream& out) {
  const study::Comparison comparison =
      study::compare(read_all(arguments.before), read_all(arguments.after), arguments.compare);
  out << to_text(comparison);
  return comparison.worse() ? kNotMerged : kDone;
}

void add_jobs(CLI::App& command, StudyArguments& arguments) {
  command.add_option("--jobs", arguments.jobs, "Runs side by side; the rows stay the same (0: as many as cores)")
      ->check(CLI::Range(0, 1024));
}

CLI::App* add_folder_command(CLI::App& study, const std::string& name, const std::string& about,
                             StudyArguments& arguments) {
  CLI::App* command = study.add_subcommand(name, about);
  command->add_option("DIR", arguments.folder, "The study's folder")->required();
  command->add_option("--pictures", arguments.pictures, "So many failures are shown as pictures, at the most")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  add_jobs(*command, arguments);
  return command;
}

}  // namespace

Command study_command(const CommandContext& context) {
  const auto arguments = std::make_shared<StudyArguments>();
  CLI::App* command = context.app.add_subcommand(
      "study", "Runs methods on many pairs with known truth, and reports how they did (docs/studies.md)");
  command->add_option("FILE", arguments->file, "The study (YAML), as in configs/studies");
  command->add_option("-o,--output", arguments->folder,
                      "Folder for rows.sqlite, rows.csv and report.html; one that holds "
                      "runs of this study already: it goes on");
  command->add_option("--shard", arguments->shard, "Only part I of N, for one machine of many; then 'study merge'")
      ->type_name("I/N")
      ->capture_default_str();
  command->add_option("--pictures", arguments->pictures, "So many failures are shown as pictures, at the most")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  add_jobs(*command, *arguments);
  CLI::App* merge = add_folder_command(*command, "merge", "Joins the parts of a study that --shard made", *arguments);
  CLI::App* report =
      add_folder_command(*command, "report", "Writes report.html anew, of the runs that there are", *arguments);
  CLI::App* compare = command->add_subcommand("compare", "Tells what changed between two versions' rows.csv");
  compare->add_option("--before", arguments->before, "rows.csv of the earlier version; several: of several turns")
      ->required();
  compare->add_option("--after", arguments->after, "The same of the later version")->required();
  compare->add_option("--slower", arguments->compare.slower, "A method is worse that takes longer by this share")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->footer(
      "\nExit status: 0 done, 3 stopped before the end (the same command goes on), or worse than before;\n"
      "1 a file is wrong, 2 wrong usage.");
  return {command, [=](std::ostream& out) {
            if (merge->parsed()) {
              return run_merge(*arguments, out);
            }
            if (report->parsed()) {
              return run_report(*arguments, out);
            }
            return compare->parsed() ? run_compare(*arguments, out) : run_study_command(*arguments, out);
          }};
}

}  // namespace gridmerge::cli
