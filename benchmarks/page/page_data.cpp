#include "page/page_data.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>
#include <unordered_map>
#include <vector>

#include "page/convergence.hpp"
#include "page/json_text.hpp"
#include "study/row_fields.hpp"

namespace gridmerge::page {
namespace {

using study::CurvePoint;
using study::Row;
using Curve = std::span<const CurvePoint>;

/// One field of all rows: numbers, or texts as {"words": [...], "at": [...]}.
class Column {
 public:
  template <typename Field>
  Column(std::string_view name, const Field& like_this) : name_(name), is_text_(is_text(like_this)) {}

  void add(const std::string& text) {
    const auto [found, is_new] = place_.emplace(text, place_.size());
    if (is_new) {
      append(words_, json_string(text));
    }
    append(values_, std::to_string(found->second));
  }
  void add(std::uint64_t seed) { add(std::to_string(seed)); }
  void add(bool value) { append(values_, value ? "1" : "0"); }
  template <typename Number>
  void add(Number value) {
    append(values_, json_number(value));
  }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string json() const {
    return is_text_ ? "{\"words\":[" + words_ + "],\"at\":[" + values_ + "]}" : "[" + values_ + "]";
  }

 private:
  // Numbers of 64 bits go as texts: a script's end at 2^53.
  template <typename Field>
  static constexpr bool is_text(const Field& /*of this type*/) {
    return std::is_same_v<Field, std::string> || std::is_same_v<Field, std::uint64_t>;
  }
  static void append(std::string& list, const std::string& item) {
    list += list.empty() ? "" : ",";
    list += item;
  }

  std::string name_;
  bool is_text_;
  std::unordered_map<std::string, std::size_t> place_;
  std::string words_;
  std::string values_;
};

std::string columns_json(std::span<const Row> rows) {
  std::vector<Column> columns;
  const Row like_any;
  study::for_each_field(like_any, [&](std::string_view name, const auto& field) { columns.emplace_back(name, field); });
  for (const Row& row : rows) {
    auto column = columns.begin();
    study::for_each_field(row, [&](std::string_view, const auto& field) { (column++)->add(field); });
  }
  std::string json;
  for (const Column& column : columns) {
    json += json.empty() ? "{" : ",\n";
    json += json_string(column.name()) + ":" + column.json();
  }
  return json + "}";
}

/// The figures that any row has, in the order of their first appearance.
std::vector<std::string> figure_names(std::span<const Row> rows) {
  std::vector<std::string> names;
  for (const Row& row : rows) {
    for (const auto& [name, value] : row.figures) {
      if (std::find(names.begin(), names.end(), name) == names.end()) {
        names.push_back(name);
      }
    }
  }
  return names;
}

double figure_of(const Row& row, const std::string& name) {
  const auto found =
      std::find_if(row.figures.begin(), row.figures.end(), [&](const auto& figure) { return figure.first == name; });
  return found == row.figures.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

std::string figures_json(std::span<const Row> rows) {
  return json_array(figure_names(rows), [&](const std::string& name) {
    const std::string values = json_array(rows, [&](const Row& row) { return json_number(figure_of(row, name)); });
    return "{\"name\":" + json_string(name) + ",\"values\":" + values + "}";
  });
}

std::string commands_json(const PageInput& input) {
  if (!input.command_of) {
    return "null";
  }
  Column commands("", std::string());
  for (const Row& row : input.rows) {
    commands.add(input.command_of(row));
  }
  return commands.json();
}

/// At most so many points of a curve, evenly, and its last.
std::vector<CurvePoint> drawn_points(Curve curve) {
  constexpr std::size_t kMost = 240;
  const std::size_t step = (curve.size() + kMost - 1) / kMost;
  std::vector<CurvePoint> drawn;
  for (std::size_t i = 0; i + 1 < curve.size(); i += step) {
    drawn.push_back(curve[i]);
  }
  drawn.push_back(curve.back());
  return drawn;
}

std::string curve_json(Curve curve) {
  const std::vector<CurvePoint> points = drawn_points(curve);
  const auto values = [&](auto CurvePoint::*member) {
    return json_array(points, [&](const CurvePoint& point) { return json_number(point.*member); });
  };
  return "{\"run\":" + json_number(curve.front().run) + ",\"iteration\":" + values(&CurvePoint::iteration) +
         ",\"fitness\":" + values(&CurvePoint::fitness) + ",\"ai\":" + values(&CurvePoint::acceptance_index) +
         ",\"error_m\":" + values(&CurvePoint::error_m) + ",\"error_deg\":" + values(&CurvePoint::error_deg) + "}\n";
}

/// So many of them, from the first on in even steps.
std::vector<Curve> sample(const std::vector<Curve>& curves, int most) {
  const std::size_t count = std::min(curves.size(), static_cast<std::size_t>(std::max(0, most)));
  std::vector<Curve> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    drawn.push_back(curves[i * curves.size() / count]);
  }
  return drawn;
}

std::string curves_json(const PageInput& input) {
  std::unordered_map<std::int64_t, const Row*> row_of;
  for (const Row& row : input.rows) {
    row_of.emplace(row.run, &row);
  }
  std::vector<CurvePoint> points;
  std::copy_if(input.curves.begin(), input.curves.end(), std::back_inserter(points),
               [&](const CurvePoint& point) { return row_of.count(point.run) > 0; });
  const std::vector<Curve> curves = curves_of(points);
  const std::string milestones = json_array(curves, [&](Curve curve) {
    const Milestones at = milestones_of(curve, *row_of.at(curve.front().run));
    return "[" + json_number(curve.front().run) + "," + json_number(at.half_fitness) + "," +
           json_number(at.most_fitness) + "," + json_number(at.within_tolerance) + "]";
  });
  return "{\"milestones\":" + milestones +
         ",\n\"drawn\":" + json_array(sample(curves, input.max_curve_runs), curve_json) + "}";
}

std::string failures_json(std::span<const FailurePicture> failures) {
  return json_array(failures, [](const FailurePicture& failure) {
    return "{\"run\":" + json_number(failure.run) + ",\"note\":" + json_string(failure.note) + "}";
  });
}

}  // namespace

std::string study_json(const PageInput& input) {
  return "{\"name\":" + json_string(input.name) + ",\n\"about\":" + json_string(input.about) +
         ",\n\"count\":" + std::to_string(input.rows.size()) + ",\n\"columns\":" + columns_json(input.rows) +
         ",\n\"figures\":" + figures_json(input.rows) + ",\n\"commands\":" + commands_json(input) +
         ",\n\"curves\":" + curves_json(input) + ",\n\"failures\":" + failures_json(input.failures) + "}";
}

std::string pictures_json(std::span<const FailurePicture> failures) {
  return json_array(failures, [](const FailurePicture& failure) {
    return "{\"found\":" + json_png(failure.found) + ",\"truth\":" + json_png(failure.truth) +
           ",\"scene\":" + json_png(failure.scene) + "}\n";
  });
}

}  // namespace gridmerge::page
