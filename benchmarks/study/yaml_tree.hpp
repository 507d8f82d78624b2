#pragma once
/// YAML of any depth as plain text with line numbers: a study nests deeper than a configuration.
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml_text.hpp"

namespace gridmerge::study {

/// As parse_yaml_mapping, with everything below the top level too.
/// @throws InputError naming file and line, also for a document that unfolds to more than a person would write
[[nodiscard]] std::vector<YamlEntry> parse_yaml_tree(std::string_view text, const std::string& file);

/// The entry of that key; null where there is none.
[[nodiscard]] const YamlEntry* find_entry(const std::vector<YamlEntry>& entries, std::string_view key);

}  // namespace gridmerge::study
