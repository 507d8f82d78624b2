#pragma once
/// What the page's script reads, as JSON that may stand inside a <script> element. Only for this folder's .cpp files.
#include <string>

#include "page/page.hpp"

namespace gridmerge::page {

/// The study without its pictures:
/// - name, about, count (of the rows)
/// - columns {name: [numbers] or {words, at}}: each text once, and for each row which one it has
/// - figures [{name, values}], commands (as a column of texts, or null)
/// - curves {milestones [[run, half_fitness, most_fitness, within_tolerance]], drawn [{run, iteration, fitness, ai,
///   error_m, error_deg}]}: milestones of all runs with a curve, and the curves of a sample
/// - failures [{run, note}]
///
/// What is not known is null.
[[nodiscard]] std::string study_json(const PageInput& input);

/// [{found, truth, scene}, ...] in the order of study_json's failures: data URLs, null where there is no picture.
[[nodiscard]] std::string pictures_json(std::span<const FailurePicture> failures);

}  // namespace gridmerge::page
