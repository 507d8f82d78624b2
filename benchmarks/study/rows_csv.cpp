#include "study/rows_csv.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>

#include "config/read_file.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/judge/evaluator.hpp"
#include "map_server/whole_files.hpp"
#include "study/row_fields.hpp"

namespace gridmerge::study {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 32;

std::string cell_of(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

std::string cell_of(double value) { return std::isfinite(value) ? exact(value) : ""; }

template <typename Whole>
std::string cell_of(Whole value) {
  return std::to_string(value);
}

/// The lines of a table, cut into cells.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  struct Line {
    int number = 0;
    std::vector<std::string> cells;
  };

  /// None at the end of the text.
  std::optional<Line> next() {
    if (rest_.empty()) {
      return std::nullopt;
    }
    Line line = {.number = number_, .cells = {""}};
    bool quoted = false;
    while (!rest_.empty()) {
      const char c = take();
      if (quoted && c == '"' && rest_.starts_with('"')) {
        line.cells.back() += take();
      } else if (c == '"') {
        quoted = !quoted;
      } else if (!quoted && c == ',') {
        line.cells.emplace_back();
      } else if (!quoted && c == '\n') {
        break;
      } else if (quoted || c != '\r') {
        line.cells.back() += c;
      }
    }
    return line;
  }

 private:
  char take() {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    number_ += c == '\n' ? 1 : 0;
    return c;
  }

  std::string_view rest_;
  int number_ = 1;
};

void read_cell(const std::string& cell, std::string& field) { field = cell; }

template <typename Number>
void read_cell(const std::string& cell, Number& field) {
  if constexpr (std::is_same_v<Number, double>) {
    field = std::numeric_limits<double>::quiet_NaN();
    if (cell.empty()) {
      return;
    }
  }
  std::conditional_t<std::is_same_v<Number, bool>, int, Number> value{};
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) {
    throw std::invalid_argument("'" + cell + "' is not a number");
  }
  field = static_cast<Number>(value);
}

using Cells = std::map<std::string, std::string>;

Row row_of(const std::vector<std::string>& columns, const Lines::Line& line, const std::string& name) {
  const std::string where = name + ":" + std::to_string(line.number);
  if (line.cells.size() != columns.size()) {
    throw InputError(where, "has " + std::to_string(line.cells.size()) + " cells; the heading has " +
                                std::to_string(columns.size()));
  }
  Cells cells;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    cells[columns[i]] = line.cells[i];
  }
  const auto read = [&](const std::string& column, auto& field) {
    try {
      read_cell(cells.at(column), field);
    } catch (const std::invalid_argument& error) {
      throw InputError(where, column + ": " + error.what());
    }
  };
  Row row;
  Cells of_figures = cells;
  for_each_field(row, [&](const std::string& column, auto& field) {
    if (of_figures.erase(column) > 0) {
      read(column, field);
    }
  });
  bool any = false;
  for (const std::string& column : columns) {
    if (of_figures.contains(column)) {
      row.figures.emplace_back(column, 0);
      read(column, row.figures.back().second);
      any = any || !cells.at(column).empty();
    }
  }
  if (!any) {
    row.figures.clear();
  }
  return row;
}

}  // namespace

std::string to_csv(const std::vector<Row>& rows) {
  std::string text;
  const Row any;
  for_each_field(any, [&](const std::string& name, const auto&) { text += (text.empty() ? "" : ",") + name; });
  const auto figures = Figures{}.named();
  for (const auto& [name, value] : figures) {
    text += "," + name;
  }
  text += '\n';
  for (const Row& row : rows) {
    bool first = true;
    for_each_field(row, [&](const char*, const auto& field) {
      text += (first ? "" : ",") + cell_of(field);
      first = false;
    });
    for (std::size_t i = 0; i < figures.size(); ++i) {
      text += "," + (i < row.figures.size() ? cell_of(row.figures[i].second) : "");
    }
    text += '\n';
  }
  return text;
}

std::vector<Row> parse_rows_csv(std::string_view text, const std::string& name) {
  Lines lines(text);
  const std::optional<Lines::Line> heading = lines.next();
  if (!heading) {
    throw InputError(name, "is empty; a table of rows has a heading");
  }
  std::vector<Row> rows;
  for (std::optional<Lines::Line> line = lines.next(); line; line = lines.next()) {
    if (line->cells.size() > 1 || !line->cells.front().empty()) {
      rows.push_back(row_of(heading->cells, *line, name));
    }
  }
  return rows;
}

std::vector<Row> read_rows_csv(const std::filesystem::path& csv) {
  return parse_rows_csv(read_file(csv, kMaxBytes), csv.string());
}

void write_rows_csv(const std::filesystem::path& folder, const std::vector<Row>& rows) {
  write_whole_file(folder / "rows.csv", to_csv(rows));
}

}  // namespace gridmerge::study
