#pragma once
/// What the selector has learned, from YAML and as YAML:
///
///     methods:
///       genetic:
///         success: {bias: 3.1, clutter: -0.4}          # weights of BidInputs, log odds
///         log_seconds: {bias: -9.2, log_occupied: 0.7}
///     second_chance: {bias: -3, log_odds: 0.6}
#include <filesystem>
#include <string>
#include <string_view>

#include "gridmerge/select/bids.hpp"

namespace gridmerge {

/// @throws InputError with a line "file:line: problem" for each problem: a key or an input that is not known, a weight
/// that is no number, something given twice
[[nodiscard]] BidBook read_bids(const std::filesystem::path& yaml);
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] BidBook parse_bids(std::string_view text, const std::string& name);
/// What the house has learned: configs/learned/bids.yaml, built in.
[[nodiscard]] const BidBook& shipped_bids();
/// As a file that parse_bids reads back the same.
[[nodiscard]] std::string to_yaml(const BidBook& book);

}  // namespace gridmerge
