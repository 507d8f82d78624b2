#pragma once
/// The part `methods` of a study's YAML, unfolded into methods with their options.
#include <vector>

#include "cli/configuration.hpp"
#include "config/yaml_text.hpp"
#include "study/study.hpp"

namespace gridmerge::study {

/// In the order written; options are checked as a run would check them. Problems are noted.
[[nodiscard]] std::vector<MethodChoice> read_methods(const YamlEntry& methods, const MethodRegistry& registry,
                                                     FileProblems& problems);

/// What makes a method run with its options: for cli::Configuration.
[[nodiscard]] cli::ConfigurationChoice configuration_choice(const MethodChoice& method);

}  // namespace gridmerge::study
