#include "verdict/tables.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "gridmerge/base/number_text.hpp"

namespace gridmerge::verdict_study {
namespace {

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

bool merges(const Row& row, double confidence, double needed) { return confidence >= needed && !row.vetoed; }

std::string rate(int part, int of) {
  return of == 0 ? "-" : std::to_string(part) + "/" + std::to_string(of) + " (" + fixed(100.0 * part / of, 2) + " %)";
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

std::string weight_table(const ConfidenceWeights& built_in, const ConfidenceWeights& fitted,
                         const WeightsByKey& folds) {
  std::string text = heading_of({"weight", "built in", "fitted", "fitted, place by place"});
  const auto named = [](ConfidenceWeights weights) {
    std::vector<std::pair<std::string, double>> all;
    const OptionList list = option_list(weights);
    for (const OptionField& field : list.fields()) {
      all.emplace_back(field.key, *std::get<double*>(field.value));
    }
    return all;
  };
  const auto before = named(built_in);
  const auto after = named(fitted);
  for (std::size_t i = 0; i < before.size(); ++i) {
    std::vector<double> values;
    for (const auto& [key, weights] : folds) {
      values.push_back(named(weights)[i].second);
    }
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    text += line_of({before[i].first, fixed(before[i].second, 2), fixed(after[i].second, 2),
                     values.empty() ? "" : fixed(*low, 2) + " .. " + fixed(*high, 2)});
  }
  return text;
}

std::string strictness_table(const std::vector<Row>& rows, const std::vector<double>& confidence) {
  std::vector<std::string> names = {"kind", "pairs"};
  for (const Strictness& one : degrees_of_strictness()) {
    names.push_back(std::string(one.name) + ": wrong merges");
    names.emplace_back("missed");
  }
  std::string text = heading_of(names);
  std::vector<std::string> kinds;
  for (const Row& row : rows) {
    if (std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end()) {
      kinds.push_back(row.kind);
    }
  }
  kinds.emplace_back("all");
  for (const std::string& kind : kinds) {
    std::vector<std::string> cells = {kind, ""};
    for (const Strictness& one : degrees_of_strictness()) {
      int pairs = 0;
      int wrong = 0;
      int missed = 0;
      int same = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (kind != "all" && rows[i].kind != kind) {
          continue;
        }
        const bool merged = merges(rows[i], confidence[i], one.min_confidence);
        ++pairs;
        wrong += merged && !rows[i].right ? 1 : 0;
        same += rows[i].truth == "same" ? 1 : 0;
        missed += rows[i].truth == "same" && !merged ? 1 : 0;
      }
      cells[1] = std::to_string(pairs);
      cells.push_back(rate(wrong, pairs));
      cells.push_back(rate(missed, same));
    }
    text += line_of(cells);
  }
  return text;
}

std::string overlap_table(const std::vector<Row>& rows, const std::vector<double>& confidence) {
  constexpr std::array<double, 9> kBounds = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.0001};
  std::vector<std::string> names = {"overlap", "pairs", "first pose right"};
  for (const Strictness& one : degrees_of_strictness()) {
    names.push_back(std::string(one.name) + ": right");
    names.emplace_back("wrong");
  }
  std::string text = heading_of(names);
  for (std::size_t band = 0; band + 1 < kBounds.size(); ++band) {
    const auto is_in = [&](const Row& row) {
      return row.truth == "same" && row.overlap >= kBounds[band] && row.overlap < kBounds[band + 1];
    };
    const int pairs = static_cast<int>(std::count_if(rows.begin(), rows.end(), is_in));
    const int first = static_cast<int>(
        std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return is_in(row) && row.right; }));
    std::vector<std::string> cells = {fixed(kBounds[band], 1) + " .. " + fixed(kBounds[band + 1], 1),
                                      std::to_string(pairs), rate(first, pairs)};
    for (const Strictness& one : degrees_of_strictness()) {
      int right = 0;
      int wrong = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (is_in(rows[i]) && merges(rows[i], confidence[i], one.min_confidence)) {
          (rows[i].right ? right : wrong) += 1;
        }
      }
      cells.push_back(rate(right, pairs));
      cells.push_back(std::to_string(wrong));
    }
    text += line_of(cells);
  }
  return text;
}

std::string reliability_table(const std::vector<Row>& rows, const std::vector<double>& confidence) {
  std::string text = heading_of({"confidence", "rows", "mean confidence", "share right"});
  for (const ReliabilityBin& bin : reliability(rows, confidence)) {
    text += line_of({fixed(bin.low, 1) + " .. " + fixed(bin.high, 1), std::to_string(bin.rows),
                     bin.rows > 0 ? fixed(bin.mean_confidence, 3) : "", bin.rows > 0 ? fixed(bin.share_right, 3) : ""});
  }
  return text + "\nExpected calibration error: " + fixed(calibration_error(rows, confidence), 4) + " over " +
         std::to_string(rows.size()) + " rows.\n";
}

}  // namespace gridmerge::verdict_study
