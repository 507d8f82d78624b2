#pragma once
/// A study that never ran: rows and curves as runs would leave them, drawn from a seed.
#include <vector>

#include "study/row.hpp"

namespace gridmerge {

struct MadeUpStudy {
  std::vector<study::Row> rows;
  std::vector<study::CurvePoint> curves;
};

/// Three methods on five data sets in three windows; a few names that a page must escape; merges of many robots.
[[nodiscard]] MadeUpStudy made_up_study(int runs, std::uint64_t seed = 1);

}  // namespace gridmerge
