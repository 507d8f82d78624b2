#include "thesis/manifest.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>

#include "gridmerge/base/error.hpp"

namespace gridmerge::thesis {
namespace {

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') {
    line.pop_back();
  }
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

/// One line, its cells found by the name of their column.
class Row {
 public:
  Row(const std::vector<std::string>& columns, std::vector<std::string> cells, std::string where)
      : columns_(columns), cells_(std::move(cells)), where_(std::move(where)) {}

  [[nodiscard]] std::string text(std::string_view column) const {
    const auto at = static_cast<std::size_t>(std::find(columns_.begin(), columns_.end(), column) - columns_.begin());
    if (at == columns_.size()) {
      throw InputError(where_, "there is no column " + std::string(column));
    }
    return at < cells_.size() ? cells_[at] : "";
  }

  [[nodiscard]] double number(std::string_view column) const {
    std::istringstream stream(text(column));
    double value = 0;
    if (!(stream >> value) || !stream.eof() || !std::isfinite(value)) {
      throw InputError(where_, std::string(column) + ": '" + text(column) + "' is not a number");
    }
    return value;
  }

 private:
  const std::vector<std::string>& columns_;
  std::vector<std::string> cells_;
  std::string where_;
};

}  // namespace

std::vector<KnownPair> read_manifest(const std::filesystem::path& csv) {
  std::ifstream file(csv);
  std::string line;
  if (!std::getline(file, line)) {
    throw InputError(csv.string(), "cannot be read");
  }
  const std::vector<std::string> columns = cells_of(line);
  std::vector<KnownPair> pairs;
  for (int number = 2; std::getline(file, line); ++number) {
    const Row row(columns, cells_of(line), csv.string() + ":" + std::to_string(number));
    if (row.text("truth") != "same") {
      continue;
    }
    const std::string tags = row.text("tags");
    pairs.push_back({.target_yaml = csv.parent_path() / row.text("a"),
                     .source_yaml = csv.parent_path() / row.text("b"),
                     .target_from_source = {row.number("tx"), row.number("ty"), row.number("theta")},
                     .tolerance_m = row.number("tol_m"),
                     .tolerance_rad = radians(row.number("tol_deg")),
                     .scenario = tags.substr(0, tags.find(' '))});
  }
  return pairs;
}

}  // namespace gridmerge::thesis
