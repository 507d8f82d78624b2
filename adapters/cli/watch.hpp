#pragma once
/// Who watches a search: the person at the terminal, and a trace file.
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iosfwd>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gridmerge/base/trace.hpp"

namespace gridmerge::cli {

/// One line that is written over and over: stage, iteration, best score, seconds. It appears once the work has taken
/// `after`, and is gone once it has ended.
class Progress final : public TraceSink {
 public:
  using Seconds = std::chrono::duration<double>;

  /// @param terminal  borrowed; null: say nothing
  explicit Progress(std::ostream* terminal, Seconds after = Seconds(1), Seconds every = Seconds(0.1));
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() override = default;

  void on_stage(const std::string& name) override;
  void on_iteration(const IterationRecord& record) override;

  /// Takes the line away, for good.
  void finish();

 private:
  void show(const std::stop_token& stop);
  void set_text(std::string text);

  std::ostream* terminal_;
  std::chrono::steady_clock::time_point began_;
  Seconds after_;
  Seconds every_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::string text_;     ///< guarded by mutex_
  std::jthread writer_;  ///< last: it uses all of the above
};

/// Standard error where that is a terminal, else null.
[[nodiscard]] std::ostream* terminal();

/// Every iteration as a line: of a CSV table, or of JSON with the whole population. Written at the end, whole.
class TraceFile final : public TraceSink {
 public:
  /// @param file  ends in .csv or .jsonl; empty: nothing is kept
  /// @throws UsageError for another ending, InputError where it could not be written
  explicit TraceFile(std::filesystem::path file);

  void on_stage(const std::string& name) override;
  void on_iteration(const IterationRecord& record) override;

  /// @throws InputError if it cannot be written
  void write() const;

 private:
  std::filesystem::path file_;
  int alignment_ = 0;  ///< from 1: a merge of many maps is many alignments
  std::string text_;
};

/// Tells all of them, in that order.
class Watch final : public TraceSink {
 public:
  /// @param sinks  borrowed, not null
  explicit Watch(std::vector<TraceSink*> sinks) : sinks_(std::move(sinks)) {}
  void on_stage(const std::string& name) override;
  void on_iteration(const IterationRecord& record) override;
  [[nodiscard]] bool wants_views() const override;
  void on_view(const View& view) override;

 private:
  std::vector<TraceSink*> sinks_;
};

}  // namespace gridmerge::cli
