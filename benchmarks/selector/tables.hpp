#pragma once
/// `auto` beside every method and the best in hindsight, as Markdown.
#include <string>
#include <vector>

#include "study/row.hpp"

namespace gridmerge::selector_study {

/// For each set and in all: right, wrong and false, median and 95th percentile of the time, of every method, of `auto`,
/// and of the best in hindsight (who knows for each pair which methods are right, and takes the fastest of them).
/// Counted are pairs that all methods in the rows have run.
[[nodiscard]] std::string comparison_table(const std::vector<study::Row>& rows);

/// Which methods `auto` tried, and what came of it.
[[nodiscard]] std::string choice_table(const std::vector<study::Row>& rows);

}  // namespace gridmerge::selector_study
