#include "selector/tables.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "gridmerge/base/number_text.hpp"

namespace gridmerge::selector_study {
namespace {

using study::Row;

constexpr const char* kHindsight = "best in hindsight";

/// What one method did on one set.
struct Tally {
  int pairs = 0;
  int right = 0;
  int wrong = 0;
  std::vector<double> seconds;

  void add(bool is_right, bool is_wrong, double align_s) {
    ++pairs;
    right += is_right ? 1 : 0;
    wrong += is_wrong ? 1 : 0;
    seconds.push_back(align_s);
  }
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

std::string key_of(const Row& row) { return row.pair + "\n" + row.window + "\n" + std::to_string(row.seed); }

bool is_counted(const Row& row) {
  return row.robots == 2 && row.profile == "default" && row.options.empty() && row.truth != "unknown";
}

bool is_wrong(const Row& row) { return row.result == "wrong" || row.result == "false"; }

/// The fastest of those that are right; where none is, the fastest of those that are not wrong.
const Row& best_of(const std::vector<const Row*>& runs) {
  const auto rank = [](const Row& row) { return row.result == "right" ? 0 : is_wrong(row) ? 2 : 1; };
  return **std::min_element(runs.begin(), runs.end(), [&](const Row* a, const Row* b) {
    return rank(*a) != rank(*b) ? rank(*a) < rank(*b) : a->align_s < b->align_s;
  });
}

}  // namespace

std::string comparison_table(const std::vector<Row>& rows) {
  std::vector<std::string> methods;
  std::vector<std::string> sets;
  std::map<std::string, std::map<std::string, std::vector<const Row*>>> runs;  // by set and pair
  const auto note = [](std::vector<std::string>& all, const std::string& name) {
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      all.push_back(name);
    }
  };
  for (const Row& row : rows) {
    if (is_counted(row)) {
      note(methods, row.method);
      note(sets, row.set);
      runs[row.set][key_of(row)].push_back(&row);
    }
  }
  std::sort(methods.begin(), methods.end(), [](const std::string& a, const std::string& b) {
    return (a == "auto") != (b == "auto") ? b == "auto" : a < b;
  });
  std::vector<std::string> columns = methods;
  columns.emplace_back(kHindsight);
  std::map<std::string, std::map<std::string, Tally>> tallies;  // by set and column
  for (const auto& [set, pairs] : runs) {
    for (const auto& [pair, of_pair] : pairs) {
      if (of_pair.size() != methods.size()) {
        continue;
      }
      for (const Row* row : of_pair) {
        tallies[set][row->method].add(row->result == "right", is_wrong(*row), row->align_s);
        tallies["all"][row->method].add(row->result == "right", is_wrong(*row), row->align_s);
      }
      std::vector<const Row*> single;
      std::copy_if(of_pair.begin(), of_pair.end(), std::back_inserter(single),
                   [](const Row* row) { return row->method != "auto"; });
      const Row& best = best_of(single);
      for (const std::string& where : {set, std::string("all")}) {
        tallies[where][kHindsight].add(best.result == "right", is_wrong(best), best.align_s);
      }
    }
  }
  sets.emplace_back("all");
  std::string text =
      "| set | method | pairs | right | wrong | seconds median | 95 % |\n|---|---|---|---|---|---|---|\n";
  for (const std::string& set : sets) {
    for (const std::string& column : columns) {
      const Tally& t = tallies[set][column];
      text += "| " + set + " | " + column + " | " + std::to_string(t.pairs) + " | " + std::to_string(t.right) + " | " +
              std::to_string(t.wrong) + " | " + fixed(quantile(t.seconds, 0.5), 3) + " | " +
              fixed(quantile(t.seconds, 0.95), 3) + " |\n";
    }
  }
  return text;
}

std::string choice_table(const std::vector<Row>& rows) {
  std::map<std::string, std::map<std::string, int>> results;  // by what was tried
  for (const Row& row : rows) {
    if (is_counted(row) && row.method == "auto") {
      ++results[row.tried][row.result];
    }
  }
  std::string text = "| tried | right | missed | refused | wrong | false |\n|---|---|---|---|---|---|\n";
  for (auto& [tried, of] : results) {
    text += "| " + tried + " | " + std::to_string(of["right"]) + " | " + std::to_string(of["missed"]) + " | " +
            std::to_string(of["refused"]) + " | " + std::to_string(of["wrong"]) + " | " + std::to_string(of["false"]) +
            " |\n";
  }
  return text;
}

}  // namespace gridmerge::selector_study
