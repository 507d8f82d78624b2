#pragma once
/// Options that stand in a YAML tree.
#include <string>
#include <vector>

#include "config/yaml_text.hpp"
#include "gridmerge/base/options.hpp"

namespace gridmerge::study {

/// Sets one option from the entry of its key. Problems are noted.
void set_option(OptionList& options, const YamlEntry& entry, FileProblems& problems);

/// Sets every option that the mapping gives, leaving out the keys in `others`. Problems are noted: unknown and repeated
/// keys among them.
void set_options(OptionList& options, const YamlEntry& mapping, FileProblems& problems,
                 const std::vector<std::string>& others = {});

}  // namespace gridmerge::study
