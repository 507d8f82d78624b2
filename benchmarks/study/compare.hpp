#pragma once
/// The same study before a change and after it: what it did to the answers and to the time they take.
#include <cstdint>
#include <string>
#include <vector>

#include "study/row.hpp"

namespace gridmerge::study {

struct Tally {
  std::int64_t runs = 0;
  std::int64_t right = 0;
  std::int64_t wrong = 0;         ///< merged, but elsewhere
  std::int64_t false_merges = 0;  ///< merged, though nothing is shared
  double ratio = 0;               ///< median of align_s / yardstick_s; NaN: no time is known
};

/// One method, profile and options; on one set, or (set empty) over the whole study.
struct Change {
  std::string method;  ///< "genetic default"
  std::string set;
  Tally before;
  Tally after;
  double slowdown = 0;                ///< median of the runs' ratios after, by those before; NaN: not known
  std::vector<std::string> worsened;  ///< why it is worse, in words; empty: it is not
};

struct Comparison {
  std::vector<Change> by_method;  ///< over the whole study: these alone can be worse
  std::vector<Change> by_set;
  std::int64_t runs_before_only = 0;  ///< left out of all figures
  std::int64_t runs_after_only = 0;

  [[nodiscard]] bool worse() const;
};

struct CompareOptions {
  double slower = 0.15;  ///< a method is worse when its time by the yardstick rises by more than this share
};

/// Runs are matched by what was asked of them: set, pair, window, method, profile, options, seed. A study may be there
/// several times on either side (turns, to meet whatever else the machine does): of times the least counts.
[[nodiscard]] Comparison compare(const std::vector<Row>& before, const std::vector<Row>& after,
                                 const CompareOptions& options = {});

/// Tables and a last line that says how it ended, for a terminal.
[[nodiscard]] std::string to_text(const Comparison& comparison);

}  // namespace gridmerge::study
