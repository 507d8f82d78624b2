#pragma once
/// Runs a study, or what is left of it.
#include <cstdint>
#include <filesystem>

#include "gridmerge/base/stop_token.hpp"
#include "study/plan.hpp"
#include "study/study.hpp"

namespace gridmerge::study {

struct RunnerOptions {
  std::filesystem::path folder;  ///< is there already; the journal goes into it
  Shard shard = {};
  int jobs = 1;                                    ///< runs that are made side by side; they do not change the rows
  std::size_t map_bytes = std::size_t{256} << 20;  ///< for maps that are not in use just now but may be again
  StopToken stop = {};  ///< when set, runs under way are finished and kept, and no other is begun
};

struct Progress {
  std::int64_t done = 0;    ///< with those of earlier sessions
  std::int64_t of = 0;      ///< of the shard
  double runs_per_s = 0;    ///< of this session; 0: nothing is done yet
  double seconds_left = 0;  ///< NaN: not known yet
};

/// Told of the progress at most ten times a second, and at the begin and the end: from any thread, one at a time.
class ProgressSink {
 public:
  virtual ~ProgressSink() = default;
  virtual void on_progress(const Progress& progress) = 0;
};

struct StudyOutcome {
  std::int64_t done = 0;  ///< all that are in the journal now
  std::int64_t of = 0;
  std::int64_t made = 0;  ///< by this call

  [[nodiscard]] bool complete() const { return done == of; }
};

/// Makes the runs that the folder's journal does not hold yet. When the last one of a whole study is in it, rows.csv is
/// written beside it. The rows, apart from times and facts of the machine, depend on nothing but the study.
/// @throws InputError if the journal is another study's or in use, a map cannot be read, or a run fails: then the
/// message names the run; the rows made so far are kept
StudyOutcome run_study(const Study& study, const RunnerOptions& options, ProgressSink& progress);

}  // namespace gridmerge::study
