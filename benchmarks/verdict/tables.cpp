#include "verdict/tables.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>

namespace gridmerge::verdict_study {
namespace {

constexpr std::array<double, 4> kThresholds = {0.8, 0.85, 0.9, 0.95};

/// Indices of rows of one kind and set; the last group holds all.
struct Group {
  std::string kind;
  std::string set;
  std::vector<std::size_t> rows;
};

std::vector<Group> groups_of(const std::vector<Row>& rows) {
  std::vector<Group> groups;
  Group all = {.kind = "all", .set = "", .rows = {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto is_of = [&](const Group& group) { return group.kind == rows[i].kind && group.set == rows[i].set; };
    auto found = std::find_if(groups.begin(), groups.end(), is_of);
    if (found == groups.end()) {
      // Kinds stay together, in the order of their first rows.
      const auto after =
          std::find_if(groups.rbegin(), groups.rend(), [&](const Group& group) { return group.kind == rows[i].kind; });
      const auto place = after == groups.rend() ? groups.end() : after.base();
      found = groups.insert(place, {.kind = rows[i].kind, .set = rows[i].set, .rows = {}});
    }
    found->rows.push_back(i);
    all.rows.push_back(i);
  }
  groups.push_back(std::move(all));
  return groups;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += " " + cell + " |";
  }
  return line + "\n";
}

std::string heading_of(const std::vector<std::string>& cells) {
  std::string rule = "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rule += "---|";
  }
  return line_of(cells) + rule + "\n";
}

std::string fixed(double value, int digits) {
  char text[48];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

/// "right + wrong" for each threshold.
std::vector<std::string> passing(const std::vector<Row>& rows, const Group& group,
                                 const std::vector<double>& confidence) {
  std::vector<std::string> cells;
  for (const double threshold : kThresholds) {
    int right = 0;
    int wrong = 0;
    for (const std::size_t i : group.rows) {
      if (confidence[i] >= threshold && passes_gates(rows[i], {})) {
        (rows[i].right ? right : wrong) += 1;
      }
    }
    cells.push_back(std::to_string(right) + (wrong > 0 ? " + **" + std::to_string(wrong) + "**" : ""));
  }
  return cells;
}

std::vector<std::string> with_thresholds(std::vector<std::string> names) {
  for (const double threshold : kThresholds) {
    names.push_back("at " + fixed(threshold, 2));
  }
  return names;
}

}  // namespace

std::string outcome_table(const std::vector<Row>& rows) {
  std::string text = heading_of({"kind", "set", "pairs", "right", "wrong", "missed", "refused", "false", "pose@1"});
  for (const Group& group : groups_of(rows)) {
    const auto count = [&](const std::function<bool(const Row&, bool same, bool merged)>& is) {
      return std::to_string(std::count_if(group.rows.begin(), group.rows.end(), [&](std::size_t i) {
        return is(rows[i], rows[i].truth == "same", rows[i].outcome == "merged");
      }));
    };
    text += line_of({group.kind, group.set, std::to_string(group.rows.size()),
                     count([](const Row& row, bool, bool merged) { return merged && row.right; }),
                     count([](const Row& row, bool same, bool merged) { return merged && same && !row.right; }),
                     count([](const Row&, bool same, bool merged) { return !merged && same; }),
                     count([](const Row&, bool same, bool merged) { return !merged && !same; }),
                     count([](const Row&, bool same, bool merged) { return merged && !same; }),
                     count([](const Row& row, bool, bool) { return row.right; })});
  }
  return text;
}

std::string weight_table(const VerdictOptions& built_in, const VerdictOptions& fitted, const WeightsByKey& folds) {
  std::string text = heading_of({"weight", "built in", "fitted", "fitted, place by place"});
  for (const Weight& weight : kWeights) {
    std::vector<double> values;
    for (const auto& [key, options] : folds) {
      values.push_back(options.*weight.value);
    }
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += line_of({weight.key, fixed(built_in.*weight.value, 2), fixed(fitted.*weight.value, 2),
                     values.empty() ? "" : fixed(*low, 2) + " .. " + fixed(*high, 2)});
  }
  return text;
}

std::string summary_table(const std::vector<Row>& rows, const std::vector<Judgement>& judgements) {
  std::string text = heading_of(with_thresholds({"weights", "log loss"}));
  const Group all = groups_of(rows).back();
  for (const Judgement& judgement : judgements) {
    std::vector<std::string> cells = passing(rows, all, judgement.confidence);
    cells.insert(cells.begin(), {judgement.name, fixed(judgement.log_loss, 4)});
    text += line_of(cells);
  }
  return text;
}

std::string threshold_table(const std::vector<Row>& rows, const Judgement& judgement) {
  std::string text = heading_of(with_thresholds({"kind", "set", "pairs", "pose@1"}));
  for (const Group& group : groups_of(rows)) {
    std::vector<std::string> cells = passing(rows, group, judgement.confidence);
    const auto right =
        std::count_if(group.rows.begin(), group.rows.end(), [&](std::size_t i) { return rows[i].right; });
    if (right == 0 && cells.front() == "0") {
      continue;
    }
    cells.insert(cells.begin(), {group.kind, group.set, std::to_string(group.rows.size()), std::to_string(right)});
    text += line_of(cells);
  }
  return text;
}

}  // namespace gridmerge::verdict_study
