#pragma once
/// Options described: for the terminal, for docs, for programs, and as a configuration file.
#include <functional>
#include <string>

#include "cli/configuration.hpp"
#include "cli/json.hpp"

namespace gridmerge::cli {

/// Key, value, range, meaning and advice of each, for reading on a terminal.
[[nodiscard]] std::string options_text(const OptionList& options);
/// A Markdown table with a row for each.
[[nodiscard]] std::string options_markdown(const OptionList& options);
/// key, value, type, unit, low, high, choices, meaning, advice of each.
[[nodiscard]] Json options_description_json(const OptionList& options);

/// The configuration as a file that reads back the same, every option with its description as a comment.
/// @param wanted  whether a section is written; asked with the method's name also for `method` and `profile`, and with
/// an empty name for the options outside of every section
[[nodiscard]] std::string configuration_yaml(Configuration& configuration,
                                             const std::function<bool(const std::string&)>& wanted);

}  // namespace gridmerge::cli
