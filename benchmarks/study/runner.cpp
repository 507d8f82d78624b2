#include "study/runner.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <mutex>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "study/journal.hpp"
#include "study/machine.hpp"
#include "study/one_run.hpp"
#include "study/pair_cache.hpp"
#include "study/rows_csv.hpp"

namespace gridmerge::study {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The last time of a worker's yardstick, taken anew every now and then.
class WorkerYardstick {
 public:
  double seconds() {
    constexpr int kRuns = 20;
    constexpr double kSeconds = 10;
    if (runs_++ % kRuns == 0 || seconds_since(taken_) > kSeconds) {
      seconds_ = time_yardstick();
      taken_ = Clock::now();
    }
    return seconds_;
  }

 private:
  int runs_ = 0;
  double seconds_ = 0;
  Clock::time_point taken_ = Clock::now();
};

/// Counts, and tells the sink, but not too often. Not thread safe.
class ProgressTeller {
 public:
  ProgressTeller(ProgressSink& sink, std::int64_t done, std::int64_t of) : sink_(sink), before_(done), of_(of) {
    tell();
  }

  void one_more() {
    ++made_;
    if (seconds_since(told_) >= 0.1) {
      tell();
    }
  }

  void tell() {
    Progress progress = {.done = before_ + made_, .of = of_};
    progress.runs_per_s = static_cast<double>(made_) / std::max(1e-9, seconds_since(start_));
    const auto left = static_cast<double>(of_ - progress.done);
    progress.seconds_left =
        made_ > 0 || left == 0 ? left / std::max(1e-9, progress.runs_per_s) : std::numeric_limits<double>::quiet_NaN();
    sink_.on_progress(progress);
    told_ = Clock::now();
  }

  [[nodiscard]] std::int64_t made() const { return made_; }

 private:
  ProgressSink& sink_;
  std::int64_t before_;
  std::int64_t of_;
  std::int64_t made_ = 0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point told_;
};

std::vector<PlannedRun> left_of(const std::vector<PlannedRun>& order, const std::unordered_set<std::int64_t>& done) {
  std::vector<PlannedRun> left;
  for (const PlannedRun& run : order) {
    if (!done.contains(run.run)) {
      left.push_back(run);
    }
  }
  return left;
}

}  // namespace

StudyOutcome run_study(const Study& study, const RunnerOptions& options, ProgressSink& progress) {
  const std::vector<PlannedRun> order = order_of(study, options.shard);
  Journal journal(options.folder / journal_name(options.shard), record_of(study, options.shard));
  const std::vector<PlannedRun> left = left_of(order, journal.runs_done());
  const auto of = static_cast<std::int64_t>(order.size());
  const auto before = of - static_cast<std::int64_t>(left.size());

  const Laboratory laboratory(study);
  PairCache pairs(study.pairs, study.curves, options.map_bytes);
  std::vector<WorkerYardstick> yardsticks(static_cast<std::size_t>(std::max(1, options.jobs)));
  std::mutex mutex;  // of the journal and the teller
  ProgressTeller teller(progress, before, of);
  parallel_for(left.size(), options.jobs, [&](std::size_t index, std::size_t worker) {
    if (options.stop.stop_requested()) {
      return;
    }
    const PlannedRun& run = left[index];
    try {
      RunResult result = laboratory.perform(run, *pairs.get(run.pair));
      result.row.yardstick_s = yardsticks[worker].seconds() / result.processor_share;
      const std::scoped_lock lock(mutex);
      journal.add(result.row, result.curve);
      teller.one_more();
    } catch (const std::exception& error) {
      throw InputError("run " + std::to_string(run.run) + " (" + laboratory.name_of(run) + ")", error.what());
    }
  });
  teller.tell();
  const StudyOutcome outcome = {.done = before + teller.made(), .of = of, .made = teller.made()};
  if (outcome.complete() && options.shard.of == 1) {
    write_rows_csv(options.folder, journal.rows());
  }
  return outcome;
}

}  // namespace gridmerge::study
