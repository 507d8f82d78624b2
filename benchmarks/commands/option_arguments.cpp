#include "commands/option_arguments.hpp"

#include <CLI/CLI.hpp>
#include <variant>

namespace gridmerge::cli {

void add_options(CLI::App& command, const OptionList& list) {
  for (const OptionField& field : list.fields()) {
    const std::string unit = field.text.unit.empty() ? "" : " [" + field.text.unit + "]";
    const std::string meaning = field.text.meaning + unit + " (" + field.range_text() + ")";
    const auto add = [&](auto* value) { command.add_option("--" + field.key, *value, meaning)->capture_default_str(); };
    std::visit(add, field.value);
  }
}

}  // namespace gridmerge::cli
