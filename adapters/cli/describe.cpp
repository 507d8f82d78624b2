#include "cli/describe.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "config/yaml_text.hpp"

namespace gridmerge::cli {
namespace {

/// The words in lines of at most 110 characters, each beginning with `margin`.
std::string wrapped(const std::string& text, const std::string& margin) {
  constexpr std::size_t kWidth = 110;
  std::istringstream words(text);
  std::string lines;
  std::string line;
  for (std::string word; words >> word;) {
    if (!line.empty() && margin.size() + line.size() + 1 + word.size() > kWidth) {
      lines += margin + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return line.empty() ? lines : lines + margin + line + "\n";
}

std::string unit_text(const OptionField& field) { return field.text.unit.empty() ? "" : " " + field.text.unit; }

std::string value_yaml(const OptionField& field) {
  const bool is_word = std::holds_alternative<std::string*>(field.value);
  return is_word ? yaml_word(field.value_text()) : field.value_text();
}

/// As the cell of a table: a bar would end it.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') {
      escaped += '\\';
    }
    escaped += c;
  }
  return escaped;
}

std::string options_yaml(const OptionList& options, const std::string& indent) {
  std::string text;
  for (const OptionField& field : options.fields()) {
    text += wrapped(field.text.meaning + " [" + field.range_text() + unit_text(field) + "]", indent + "# ");
    text += wrapped(field.text.advice, indent + "# ");
    text += indent + field.key + ": " + value_yaml(field) + "\n";
  }
  return text;
}

std::string plugins_yaml(const std::vector<std::filesystem::path>& plugins) {
  std::string text = plugins.empty() ? "" : "plugins:\n";
  for (const std::filesystem::path& plugin : plugins) {
    text += "  - " + yaml_word(plugin.string()) + "\n";
  }
  return text;
}

const char* type_name(const OptionField& field) {
  constexpr const char* kNames[] = {"switch", "whole number", "number", "word"};  // in the order of OptionField::Value
  return kNames[field.value.index()];
}

/// A bound of a range; null where there is none.
Json bound(double value) { return std::isfinite(value) ? Json(value) : Json(); }

}  // namespace

std::string options_text(const OptionList& options) {
  std::string text;
  for (const OptionField& field : options.fields()) {
    text += "  " + field.key + ": " + field.value_text() + unit_text(field) + "   (" + field.range_text() + ")\n";
    text += wrapped(field.text.meaning + " " + field.text.advice, "      ");
  }
  return text;
}

std::string options_markdown(const OptionList& options) {
  std::string text = "| option | default | unit | range | meaning |\n|---|---|---|---|---|\n";
  for (const OptionField& field : options.fields()) {
    const std::string advice = field.text.advice.empty() ? "" : " " + field.text.advice;
    text += "| `" + field.key + "` | " + cell(field.value_text()) + " | " + cell(field.text.unit) + " | " +
            cell(field.range_text()) + " | " + cell(field.text.meaning + advice) + " |\n";
  }
  return text;
}

Json options_description_json(const OptionList& options) {
  Json all = Json::array();
  for (const OptionField& field : options.fields()) {
    all.push_back({{"key", field.key},
                   {"value", option_value_json(field)},
                   {"type", type_name(field)},
                   {"unit", field.text.unit},
                   {"low", bound(field.low)},
                   {"high", bound(field.high)},
                   {"choices", field.choices},
                   {"meaning", field.text.meaning},
                   {"advice", field.text.advice}});
  }
  return all;
}

std::string configuration_yaml(Configuration& configuration, const std::function<bool(const std::string&)>& wanted) {
  std::string text;
  if (wanted(configuration.method())) {
    text += "method: " + yaml_word(configuration.method()) + "\n";
    text += "profile: " + yaml_word(configuration.profile()) + "\n";
    text += plugins_yaml(configuration.plugins());
    text += configuration.bids().empty() ? "" : "bids: " + yaml_word(configuration.bids().string()) + "\n";
  }
  if (wanted("")) {
    text += options_yaml(configuration.run_options(), "");
  }
  for (const Configuration::Section& section : configuration.sections()) {
    if (wanted(section.name)) {
      if (!text.empty()) {
        text += '\n';
      }
      text += wrapped(section.about, "# ");
      text += yaml_word(section.name) + (section.options.fields().empty() ? ": {}\n" : ":\n");
      text += options_yaml(section.options, "  ");
    }
  }
  return text;
}

}  // namespace gridmerge::cli
