#include "gridmerge/base/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace gridmerge {
namespace {

std::string number_text(double value) {
  if (std::isinf(value)) {
    return value > 0 ? ".inf" : "-.inf";
  }
  char buffer[32];
  const bool whole = std::trunc(value) == value && std::abs(value) < 1e15;  // 100000 is not to become 1e+05
  const auto end = whole ? std::to_chars(buffer, buffer + sizeof buffer, static_cast<long long>(value)).ptr
                         : std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : between) + word;
  }
  return text;
}

/// The problem with a value, or an empty string.
std::string value_problem(const OptionField& field, double value) {
  if (std::isnan(value) || value < field.low || value > field.high) {
    return field.key + " = " + number_text(value) + " " + field.text.unit + (field.text.unit.empty() ? "" : " ") +
           "is out of range: " + field.range_text();
  }
  return {};
}

std::string value_problem(const OptionField& field, const std::string& value) {
  if (std::find(field.choices.begin(), field.choices.end(), value) == field.choices.end()) {
    return field.key + " = '" + value + "' is not one of: " + joined(field.choices, ", ");
  }
  return {};
}

template <typename Number>
bool parsed(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::string OptionField::value_text() const {
  if (const auto* flag = std::get_if<bool*>(&value)) {
    return **flag ? "true" : "false";
  }
  if (const auto* whole = std::get_if<int*>(&value)) {
    return std::to_string(**whole);
  }
  if (const auto* number = std::get_if<double*>(&value)) {
    return number_text(**number);
  }
  return *std::get<std::string*>(value);
}

std::string OptionField::range_text() const {
  if (std::holds_alternative<bool*>(value)) {
    return "true | false";
  }
  if (std::holds_alternative<std::string*>(value)) {
    return joined(choices, " | ");
  }
  return number_text(low) + " .. " + number_text(high);
}

OptionList& OptionList::add(std::string key, bool& value, OptionText text) {
  fields_.push_back({.key = std::move(key), .value = &value, .choices = {}, .text = std::move(text)});
  return *this;
}

OptionList& OptionList::add(std::string key, int& value, int low, int high, OptionText text) {
  fields_.push_back({.key = std::move(key),
                     .value = &value,
                     .low = static_cast<double>(low),
                     .high = static_cast<double>(high),
                     .choices = {},
                     .text = std::move(text)});
  return *this;
}

OptionList& OptionList::add(std::string key, double& value, double low, double high, OptionText text) {
  fields_.push_back(
      {.key = std::move(key), .value = &value, .low = low, .high = high, .choices = {}, .text = std::move(text)});
  return *this;
}

OptionList& OptionList::add(std::string key, std::string& value, std::vector<std::string> choices, OptionText text) {
  fields_.push_back({.key = std::move(key), .value = &value, .choices = std::move(choices), .text = std::move(text)});
  return *this;
}

std::string OptionList::set(std::string_view key, std::string_view text) {
  const auto field = std::find_if(fields_.begin(), fields_.end(), [&](const auto& f) { return f.key == key; });
  if (field == fields_.end()) {
    std::vector<std::string> known;
    for (const OptionField& f : fields_) {
      known.push_back(f.key);
    }
    return "unknown key '" + std::string(key) + "'; known keys: " + joined(known, ", ");
  }
  const std::string given = field->key + " = '" + std::string(text) + "' ";
  if (auto* flag = std::get_if<bool*>(&field->value)) {
    if (text != "true" && text != "false") {
      return given + "is neither true nor false";
    }
    **flag = text == "true";
    return {};
  }
  if (auto* whole = std::get_if<int*>(&field->value)) {
    int number = 0;
    if (!parsed(text, number)) {
      return given + "is not a whole number";
    }
    std::string problem = value_problem(*field, number);
    if (problem.empty()) {
      **whole = number;
    }
    return problem;
  }
  if (auto* real = std::get_if<double*>(&field->value)) {
    double number = 0;
    if (text == ".inf" || text == "-.inf") {  // as YAML writes it
      number = (text.front() == '-' ? -1 : 1) * std::numeric_limits<double>::infinity();
    } else if (!parsed(text, number)) {
      return given + "is not a number";
    }
    std::string problem = value_problem(*field, number);
    if (problem.empty()) {
      **real = number;
    }
    return problem;
  }
  std::string problem = value_problem(*field, std::string(text));
  if (problem.empty()) {
    *std::get<std::string*>(field->value) = text;
  }
  return problem;
}

std::vector<std::string> OptionList::problems() const {
  std::vector<std::string> found;
  for (const OptionField& field : fields_) {
    std::string problem;
    if (const auto* whole = std::get_if<int*>(&field.value)) {
      problem = value_problem(field, **whole);
    } else if (const auto* real = std::get_if<double*>(&field.value)) {
      problem = value_problem(field, **real);
    } else if (const auto* word = std::get_if<std::string*>(&field.value)) {
      problem = value_problem(field, **word);
    }
    if (!problem.empty()) {
      found.push_back(std::move(problem));
    }
  }
  return found;
}

std::vector<std::pair<std::string, std::string>> OptionList::values() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const OptionField& field : fields_) {
    all.emplace_back(field.key, field.value_text());
  }
  return all;
}

void throw_invalid_options(const std::string& owner, const std::vector<std::string>& problems) {
  throw std::invalid_argument(owner + ": " + joined(problems, "; "));
}

}  // namespace gridmerge
