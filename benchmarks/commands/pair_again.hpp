#pragma once
/// The maps of a study's row once more, and the command lines that repeat it.
#include <string>

#include "page/failures.hpp"
#include "study/row.hpp"

namespace gridmerge::cli {

/// Draws or reads the two maps (of a swarm: the first two) as Row::pair_spec says.
/// @throws InputError if it does not say so, or a map cannot be read
[[nodiscard]] page::PairMaps maps_again(const study::Row& row);

/// What one types to get the same answer; empty for a swarm.
[[nodiscard]] std::string command_again(const study::Row& row);

}  // namespace gridmerge::cli
