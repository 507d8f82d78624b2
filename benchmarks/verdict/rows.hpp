#pragma once
/// One row a pair: what the Evaluator and the verdict said of the best pose, and whether it was right.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/align/merger.hpp"
#include "gridmerge/align/pipeline.hpp"
#include "verdict/pairs.hpp"

namespace gridmerge::verdict_study {

struct Row {
  std::string kind;  ///< as in PairPlan, and so are the next four
  std::string set;
  std::string places;
  std::string a;
  std::string b;
  std::string truth;  ///< same, different, ambiguous
  double overlap = 0;
  bool right = false;  ///< the first hypothesis lies within the tolerance, whatever the verdict; only where same
  std::string outcome;
  double confidence = 0;                ///< as told
  bool vetoed = false;                  ///< a gate is broken
  std::optional<PoseDifference> error;  ///< of the first hypothesis, at the centre of the source's known cells
  double seconds = 0;                   ///< of the alignment, on one thread
  double judge_s = 0;                   ///< of it, the verdict's
  double evidence_m = 0;
  double conflict_share = 0;
  ConfidenceFigures figures;  ///< what the confidence was computed from; zero where there was no pose
  std::vector<RivalFigures> rivals;
};

/// Told after each pair how many are done, from any thread but one at a time.
using Watcher = std::function<void(std::size_t done, std::size_t of)>;

/// Aligns the pairs; those of which build_pair makes nothing have no row. Same rows at any number of threads.
/// @throws InputError for a map that cannot be read
[[nodiscard]] std::vector<Row> make_rows(const std::vector<PairPlan>& plans, const Merger& method,
                                         const PipelineOptions& options, int threads, const Watcher& watcher = {});

/// CSV with a heading; every number as the shortest text that reads back as the same.
[[nodiscard]] std::string to_csv(const std::vector<Row>& rows);
/// Reads what to_csv wrote.
/// @throws InputError naming file, line and column
[[nodiscard]] std::vector<Row> read_rows(const std::filesystem::path& csv);

}  // namespace gridmerge::verdict_study
