#include "study/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <tuple>

#include "cli/text.hpp"

namespace gridmerge::study {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

std::string method_of(const Row& row) {
  return row.method + " " + row.profile + (row.options.empty() ? "" : " " + row.options);
}

/// What was asked.
using Key = std::tuple<std::string, std::string, std::string, std::string, std::uint64_t>;

Key key_of(const Row& row) { return {row.set, row.pair, row.window, method_of(row), row.seed}; }

/// What came of one run, of all its turns.
struct Run {
  std::string result;
  double ratio = kNotKnown;  ///< the least
};

std::map<Key, Run> runs_of(const std::vector<Row>& rows) {
  std::map<Key, Run> runs;
  for (const Row& row : rows) {
    Run& run = runs[key_of(row)];
    run.result = row.result;
    if (row.yardstick_s > 0 && row.align_s >= 0) {
      run.ratio = std::fmin(run.ratio, row.align_s / row.yardstick_s);
    }
  }
  return runs;
}

double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) {
    return kNotKnown;
  }
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The matched runs of one line of a table.
struct Group {
  std::vector<Run> before;
  std::vector<Run> after;
};

Tally tally_of(const std::vector<Run>& runs) {
  Tally tally;
  std::vector<double> ratios;
  for (const Run& run : runs) {
    ++tally.runs;
    tally.right += run.result == "right" ? 1 : 0;
    tally.wrong += run.result == "wrong" ? 1 : 0;
    tally.false_merges += run.result == "false" ? 1 : 0;
    ratios.push_back(run.ratio);
  }
  tally.ratio = median(ratios);
  return tally;
}

Change change_of(const std::string& method, const std::string& set, const Group& group) {
  std::vector<double> slowdowns;
  for (std::size_t i = 0; i < group.before.size(); ++i) {
    slowdowns.push_back(group.after[i].ratio / group.before[i].ratio);
  }
  return {.method = method,
          .set = set,
          .before = tally_of(group.before),
          .after = tally_of(group.after),
          .slowdown = median(slowdowns),
          .worsened = {}};
}

std::string percent(double slowdown) {
  return std::isfinite(slowdown) ? (slowdown >= 1 ? "+" : "") + fixed(100 * (slowdown - 1), 1) + " %" : "-";
}

std::vector<std::string> reasons(const Change& change, const CompareOptions& options) {
  std::vector<std::string> why;
  const auto from_to = [](std::int64_t from, std::int64_t to) {
    return std::to_string(from) + " to " + std::to_string(to);
  };
  if (change.after.right < change.before.right) {
    why.push_back("right fell from " + from_to(change.before.right, change.after.right));
  }
  const std::int64_t bad_before = change.before.wrong + change.before.false_merges;
  const std::int64_t bad_after = change.after.wrong + change.after.false_merges;
  if (bad_after > bad_before) {
    why.push_back("wrong and false rose from " + from_to(bad_before, bad_after));
  }
  if (change.slowdown > 1 + options.slower) {
    why.push_back("time rose by " + percent(change.slowdown) + ", more than " + fixed(100 * options.slower, 0) + " %");
  }
  return why;
}

/// Columns wide enough, the first one to the left, the others to the right.
std::string table(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], line[i].size());
    }
  }
  std::string text;
  for (const auto& line : lines) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string space(widths[i] - line[i].size(), ' ');
      row += (i == 0 ? "" : "  ") + (i == 0 ? line[i] + space : space + line[i]);
    }
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::vector<std::string> line_of(const Change& change) {
  const auto both = [](std::int64_t before, std::int64_t after) {
    return before == after ? std::to_string(before) : std::to_string(before) + " -> " + std::to_string(after);
  };
  const auto number = [](double value) { return std::isfinite(value) ? fixed(value, 2) : "-"; };
  return {change.set.empty() ? change.method : change.set + ": " + change.method,
          std::to_string(change.after.runs),
          both(change.before.right, change.after.right),
          both(change.before.wrong, change.after.wrong),
          both(change.before.false_merges, change.after.false_merges),
          number(change.before.ratio) + " -> " + number(change.after.ratio),
          percent(change.slowdown)};
}

std::string table_of(const std::string& first, const std::vector<Change>& changes) {
  std::vector<std::vector<std::string>> lines = {
      {first, "runs", "right", "wrong", "false", "time/yardstick", "slower"}};
  for (const Change& change : changes) {
    lines.push_back(line_of(change));
  }
  return table(lines);
}

}  // namespace

bool Comparison::worse() const {
  return std::any_of(by_method.begin(), by_method.end(), [](const Change& change) { return !change.worsened.empty(); });
}

Comparison compare(const std::vector<Row>& before, const std::vector<Row>& after, const CompareOptions& options) {
  const std::map<Key, Run> runs_before = runs_of(before);
  const std::map<Key, Run> runs_after = runs_of(after);
  std::map<std::string, Group> methods;
  std::map<std::pair<std::string, std::string>, Group> sets;
  std::int64_t common = 0;
  for (const auto& [key, run] : runs_before) {
    const auto match = runs_after.find(key);
    if (match == runs_after.end()) {
      continue;
    }
    ++common;
    const std::string& set = std::get<0>(key);
    const std::string& method = std::get<3>(key);
    for (Group* group : {&methods[method], &sets[{set, method}]}) {
      group->before.push_back(run);
      group->after.push_back(match->second);
    }
  }
  Comparison comparison;
  comparison.runs_before_only = static_cast<std::int64_t>(runs_before.size()) - common;
  comparison.runs_after_only = static_cast<std::int64_t>(runs_after.size()) - common;
  for (const auto& [method, group] : methods) {
    comparison.by_method.push_back(change_of(method, "", group));
    comparison.by_method.back().worsened = reasons(comparison.by_method.back(), options);
  }
  for (const auto& [set_and_method, group] : sets) {
    comparison.by_set.push_back(change_of(set_and_method.second, set_and_method.first, group));
  }
  return comparison;
}

std::string to_text(const Comparison& comparison) {
  std::string text =
      table_of("method", comparison.by_method) + "\n" + table_of("set: method", comparison.by_set) + "\n";
  if (comparison.runs_before_only > 0 || comparison.runs_after_only > 0) {
    text += "Not compared: " + std::to_string(comparison.runs_before_only) + " runs that are only before, " +
            std::to_string(comparison.runs_after_only) + " that are only after.\n";
  }
  for (const Change& change : comparison.by_method) {
    for (const std::string& why : change.worsened) {
      text += "WORSE: " + change.method + ": " + why + "\n";
    }
  }
  return text + (comparison.worse() ? "" : "Nothing is worse.\n");
}

}  // namespace gridmerge::study
