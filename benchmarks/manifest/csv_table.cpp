#include "manifest/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

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

}  // namespace

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

}  // namespace gridmerge
