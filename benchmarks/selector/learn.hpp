#pragma once
/// What to expect of each method, learned from the rows of a study.
#include <string>
#include <vector>

#include "gridmerge/select/bids.hpp"
#include "study/row.hpp"

namespace gridmerge::selector_study {

/// Whether a row tells something of a method: a pair, the method's default profile, no options set, truth known, and
/// not `auto`.
[[nodiscard]] bool is_learned_from(const study::Row& row);

/// One model a method, in the order of their first rows:
/// - success: logistic regression of "right" on the inputs, over the rows whose maps overlap;
/// - log_seconds: least squares of the logarithm of align_s, over all rows;
/// and the second chance: over every two methods on one pair, of which the first did not merge, whether the other is
/// right (what does not overlap counts: the selector does not know).
[[nodiscard]] BidBook learn(const std::vector<study::Row>& rows, double ridge = 1);

/// As a bid sees the row: its maps and its window.
[[nodiscard]] BidInputs inputs_of(const study::Row& row);

}  // namespace gridmerge::selector_study
