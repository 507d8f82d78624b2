#include "cli/watch.hpp"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/text.hpp"
#include "cli/usage_error.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge::cli {
namespace {

constexpr const char* kClearLine = "\r\x1b[K";
constexpr std::size_t kColumns = 79;

}  // namespace

Progress::Progress(std::ostream* terminal, Seconds after, Seconds every)
    : terminal_(terminal), began_(std::chrono::steady_clock::now()), after_(after), every_(every) {
  if (terminal_ != nullptr) {
    writer_ = std::jthread([this](const std::stop_token& stop) { show(stop); });
  }
}

void Progress::on_stage(const std::string& name) { set_text(name); }

void Progress::on_iteration(const IterationRecord& record) {
  std::string text = record.stage + " " + std::to_string(record.iteration + 1);
  if (record.iterations > 0) {
    text += "/" + std::to_string(record.iterations);
  }
  set_text(text + ", best " + fixed(record.best_score, 1));
}

void Progress::finish() {
  if (writer_.joinable()) {
    writer_.request_stop();
    writer_.join();
  }
}

void Progress::set_text(std::string text) {
  const std::scoped_lock lock(mutex_);
  text_ = std::move(text);
}

void Progress::show(const std::stop_token& stop) {
  bool shown = false;
  std::unique_lock lock(mutex_);
  for (Seconds wait = after_; !changed_.wait_for(lock, stop, wait, [&] { return stop.stop_requested(); });
       wait = every_) {
    const Seconds elapsed = std::chrono::steady_clock::now() - began_;
    const std::string line = fixed(elapsed.count(), 1) + " s  " + text_;
    *terminal_ << kClearLine << line.substr(0, kColumns) << std::flush;
    shown = true;
  }
  if (shown) {
    *terminal_ << kClearLine << std::flush;
  }
}

std::ostream* terminal() { return isatty(STDERR_FILENO) != 0 ? &std::cerr : nullptr; }

TraceFile::TraceFile(std::filesystem::path file) : file_(std::move(file)) {
  if (file_.empty()) {
    return;
  }
  if (file_.extension() == ".csv") {
    text_ = "alignment,stage,iteration,iterations,best_score,mean_score,x,y,theta,population\n";
  } else if (file_.extension() != ".jsonl") {
    throw UsageError("--trace '" + file_.string() + "': the name must end in .csv or .jsonl");
  }
  WholeFiles().stage(file_, "");  // better to know now than after the search
}

void TraceFile::on_stage(const std::string& name) { alignment_ += name == "prepare" ? 1 : 0; }

void TraceFile::on_iteration(const IterationRecord& record) {
  if (file_.empty()) {
    return;
  }
  const Pose2& best = record.best_target_from_source;
  if (file_.extension() == ".csv") {
    text_ += std::to_string(alignment_) + "," + record.stage;
    for (const double value :
         {static_cast<double>(record.iteration), static_cast<double>(record.iterations), record.best_score,
          record.mean_score, best.x_m, best.y_m, best.theta_rad, static_cast<double>(record.population.size())}) {
      text_ += ',';
      text_ += exact(value);
    }
    text_ += "\n";
    return;
  }
  nlohmann::ordered_json population = nlohmann::ordered_json::array();
  for (const Pose2& pose : record.population) {
    population.push_back({pose.x_m, pose.y_m, pose.theta_rad});
  }
  const nlohmann::ordered_json line = {{"alignment", alignment_},
                                       {"stage", record.stage},
                                       {"iteration", record.iteration},
                                       {"iterations", record.iterations},
                                       {"best_score", record.best_score},
                                       {"mean_score", record.mean_score},
                                       {"x", best.x_m},
                                       {"y", best.y_m},
                                       {"theta", best.theta_rad},
                                       {"population", population}};
  text_ += line.dump() + "\n";
}

void TraceFile::write() const {
  if (!file_.empty()) {
    write_whole_file(file_, text_);
  }
}

void Watch::on_stage(const std::string& name) {
  for (TraceSink* sink : sinks_) {
    sink->on_stage(name);
  }
}

void Watch::on_iteration(const IterationRecord& record) {
  for (TraceSink* sink : sinks_) {
    sink->on_iteration(record);
  }
}

bool Watch::wants_views() const {
  return std::any_of(sinks_.begin(), sinks_.end(), [](const TraceSink* sink) { return sink->wants_views(); });
}

void Watch::on_view(const View& view) {
  for (TraceSink* sink : sinks_) {
    if (sink->wants_views()) {
      sink->on_view(view);
    }
  }
}

}  // namespace gridmerge::cli
