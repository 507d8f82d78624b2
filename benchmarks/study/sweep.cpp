#include "study/sweep.hpp"

#include <charconv>
#include <optional>

namespace gridmerge::study {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// Appends what one word stands for. @return the problem, or an empty string
std::string append(const std::string& word, std::vector<std::string>& values) {
  constexpr int kMaxRange = 100000;
  const std::size_t dots = word.find("..");
  const std::optional<int> first = whole_number(std::string_view(word).substr(0, dots));
  const std::optional<int> last = dots == std::string::npos ? first : whole_number(word.substr(dots + 2));
  if (dots == std::string::npos || !first || !last) {  // "../maps" is a word like any other
    values.push_back(word);
    return "";
  }
  if (*last < *first) {
    return "'" + word + "' must run upwards, as in 1..4";
  }
  if (static_cast<std::int64_t>(*last) - *first >= kMaxRange) {
    return "'" + word + "' must hold at most " + std::to_string(kMaxRange) + " numbers";
  }
  for (int value = *first; value <= *last; ++value) {
    values.push_back(std::to_string(value));
  }
  return "";
}

}  // namespace

std::vector<std::string> values_of(const YamlEntry& entry, FileProblems& problems) {
  using Kind = YamlEntry::Kind;
  const std::string name = entry.key.empty() ? "" : entry.key + ": ";
  if (entry.kind == Kind::kMapping || entry.kind == Kind::kEmpty) {
    problems.add(entry.line, name + "must be a value, a range like 1..4, or a list of them");
    return {};
  }
  std::vector<std::string> values;
  const auto add = [&](const YamlEntry& one) {
    const std::string problem = one.kind == Kind::kScalar ? append(one.text, values) : "a list must hold plain values";
    if (!problem.empty()) {
      problems.add(one.line, name + problem);
    }
  };
  if (entry.kind == Kind::kScalar) {
    add(entry);
    return values;
  }
  for (const YamlEntry& child : entry.children) {
    add(child);
  }
  if (entry.children.empty()) {
    problems.add(entry.line, name + "must not be an empty list");
  }
  return values;
}

std::vector<Settings> combinations(const std::vector<Axis>& axes, int line, FileProblems& problems) {
  std::vector<Settings> all = {{}};
  for (const Axis& axis : axes) {
    if (all.size() * axis.values.size() > kMaxCombinations) {
      problems.add(line, "must not stand for more than " + std::to_string(kMaxCombinations) + " combinations");
      return {};
    }
    std::vector<Settings> longer;
    for (const Settings& settings : all) {
      for (const std::string& value : axis.values) {
        longer.push_back(settings);
        longer.back().emplace_back(axis.key, value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

}  // namespace gridmerge::study
