#pragma once
/// Rows to test with.
#include <string>

#include "study/row.hpp"

namespace gridmerge::study {

/// A row whose every field holds something else than its default, and with all figures.
[[nodiscard]] Row row_of_everything(std::int64_t run);

/// Every field and figure, a line each, numbers to the last bit.
[[nodiscard]] std::string in_words(const Row& row);

/// The row without what differs from one time to the next: times.
[[nodiscard]] Row timeless(Row row);

}  // namespace gridmerge::study
