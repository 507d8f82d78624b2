#pragma once
/// Options that are described once: from the one description come the loader, the range check, `--help`, the tables in
/// docs/ and the effective configuration that is stored with each result.
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gridmerge {

/// What a person needs to know of one option.
struct OptionText {
  std::string unit;     ///< "m", "deg", "cells", "1/s"; empty: a bare number, a switch or a choice
  std::string meaning;  ///< one sentence
  std::string advice;   ///< when to change it, and what that costs; may be empty
};

/// One option: a key, where its value lives, its range.
struct OptionField {
  using Value = std::variant<bool*, int*, double*, std::string*>;
  std::string key;
  Value value;  ///< points into the options struct that was described; never null
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;  ///< the allowed words of a std::string option
  OptionText text;

  [[nodiscard]] std::string value_text() const;  ///< as YAML would write it
  [[nodiscard]] std::string range_text() const;  ///< "0.01 .. 10", "true | false", "off | on"
};

/// The options of one struct, bound to one instance of it. It must not outlive that instance.
///
/// A struct of options offers `void describe(OptionList&)`, which adds its fields in reading order.
class OptionList {
 public:
  OptionList& add(std::string key, bool& value, OptionText text);
  OptionList& add(std::string key, int& value, int low, int high, OptionText text);
  OptionList& add(std::string key, double& value, double low, double high, OptionText text);
  OptionList& add(std::string key, std::string& value, std::vector<std::string> choices, OptionText text);

  [[nodiscard]] const std::vector<OptionField>& fields() const { return fields_; }

  /// Sets one option from text. Nothing is changed where a problem is found.
  /// @return the problem in words (unknown key with the known ones, not a number, out of range), or an empty string
  [[nodiscard]] std::string set(std::string_view key, std::string_view value);

  /// All values that lie outside their range (a caller may have written into the struct), one sentence each.
  [[nodiscard]] std::vector<std::string> problems() const;

  /// Key and value of every option, in order of description.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> values() const;

 private:
  std::vector<OptionField> fields_;
};

template <typename Options>
[[nodiscard]] OptionList option_list(Options& options) {
  OptionList list;
  options.describe(list);
  return list;
}

/// @throws std::invalid_argument listing every option out of range: for the edge of a component built in code.
template <typename Options>
void require_valid(Options options, const std::string& owner);

[[noreturn]] void throw_invalid_options(const std::string& owner, const std::vector<std::string>& problems);

template <typename Options>
void require_valid(Options options, const std::string& owner) {
  const std::vector<std::string> problems = option_list(options).problems();
  if (!problems.empty()) {
    throw_invalid_options(owner, problems);
  }
}

}  // namespace gridmerge
