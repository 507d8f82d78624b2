#pragma once
/// Lists and ranges of values, and all their combinations.
#include <string>
#include <utility>
#include <vector>

#include "config/yaml_text.hpp"

namespace gridmerge::study {

/// What a key is given: one value, a list of values, or ranges of whole numbers "a..b", also inside of a list.
/// Problems (an empty list, a mapping, a range that runs backwards) are noted, and nothing is returned.
[[nodiscard]] std::vector<std::string> values_of(const YamlEntry& entry, FileProblems& problems);

/// A key with the values it takes.
struct Axis {
  std::string key;
  std::vector<std::string> values;
};

using Settings = std::vector<std::pair<std::string, std::string>>;  ///< key and value, in the order written

/// Every combination; the last axis varies fastest. One empty combination for no axes.
/// More than kMaxCombinations are noted as a problem at `line`, and nothing is returned.
[[nodiscard]] std::vector<Settings> combinations(const std::vector<Axis>& axes, int line, FileProblems& problems);

inline constexpr std::size_t kMaxCombinations = 1'000'000;

}  // namespace gridmerge::study
