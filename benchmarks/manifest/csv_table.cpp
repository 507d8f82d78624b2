#include "manifest/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

/// The next line without its end; false at the end of the file.
bool next_line(std::istream& stream, std::string& line) {
  if (!std::getline(stream, line)) {
    return false;
  }
  if (!line.empty() && line.back() == '\r') {
    line.pop_back();
  }
  return true;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    line += (&cell == &cells.front() ? "" : ",") + cell;
  }
  return line + "\n";
}

}  // namespace

bool CsvRow::has(std::string_view column) const {
  return std::find(columns_->begin(), columns_->end(), column) != columns_->end();
}

std::string CsvRow::text(std::string_view column) const {
  const auto at = static_cast<std::size_t>(std::find(columns_->begin(), columns_->end(), column) - columns_->begin());
  if (at == columns_->size()) {
    throw InputError(where_, "there is no column " + std::string(column));
  }
  return at < cells_.size() ? cells_[at] : "";
}

double CsvRow::number(std::string_view column) const {
  std::istringstream stream(text(column));
  double value = 0;
  if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) {
    throw InputError(where_, std::string(column) + ": '" + text(column) + "' is not a number");
  }
  return value;
}

std::optional<double> CsvRow::number_if_any(std::string_view column) const {
  return has(column) && !text(column).empty() ? std::optional<double>(number(column)) : std::nullopt;
}

std::vector<CsvRow> read_csv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!next_line(stream, line)) {
    throw InputError(file.string(), "cannot be read");
  }
  const auto columns = std::make_shared<const std::vector<std::string>>(cells_of(line));
  std::vector<CsvRow> rows;
  for (int number = 2; next_line(stream, line); ++number) {
    if (!line.empty()) {
      rows.emplace_back(columns, cells_of(line), file.string() + ":" + std::to_string(number));
    }
  }
  return rows;
}

std::string csv_text(const std::string& where, const std::vector<std::string>& columns,
                     const std::vector<std::vector<std::string>>& rows) {
  std::string text = line_of(columns);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (rows[row].size() != columns.size()) {
      throw std::invalid_argument("csv_text: a row has not as many cells as there are columns");
    }
    for (std::size_t column = 0; column < columns.size(); ++column) {
      if (rows[row][column].find_first_of(",\"\r\n") != std::string::npos) {
        throw InputError(where + ":" + std::to_string(row + 2),
                         columns[column] + ": '" + rows[row][column] + "' holds a comma, a quote or the end of a line");
      }
    }
    text += line_of(rows[row]);
  }
  return text;
}

}  // namespace gridmerge
