#pragma once
/// Tables in CSV files: columns found by name. No quotes: a cell holds no comma.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge {

/// One line of a table.
class CsvRow {
 public:
  CsvRow(std::shared_ptr<const std::vector<std::string>> columns, std::vector<std::string> cells, std::string where)
      : columns_(std::move(columns)), cells_(std::move(cells)), where_(std::move(where)) {}

  [[nodiscard]] bool has(std::string_view column) const;
  /// Empty where the line ends early.
  /// @throws InputError naming file, line and column, if there is no such column
  [[nodiscard]] std::string text(std::string_view column) const;
  /// @throws InputError naming file, line and column, also if the cell is not a finite number
  [[nodiscard]] double number(std::string_view column) const;
  /// None where there is no such column, or nothing in it.
  /// @throws InputError naming file, line and column, if the cell is not a finite number
  [[nodiscard]] std::optional<double> number_if_any(std::string_view column) const;
  /// "file:line", for messages.
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  std::shared_ptr<const std::vector<std::string>> columns_;
  std::vector<std::string> cells_;
  std::string where_;
};

/// All lines below the heading; empty ones are passed over.
/// @throws InputError naming the file, if it cannot be read
[[nodiscard]] std::vector<CsvRow> read_csv(const std::filesystem::path& file);

/// The table as text: a heading, and a line for each row.
/// @param where  the file it is for, for messages
/// @throws InputError naming file, line, column and text, if a cell holds a comma, a quote or the end of a line;
/// std::invalid_argument if a row has not as many cells as there are columns
[[nodiscard]] std::string csv_text(const std::string& where, const std::vector<std::string>& columns,
                                   const std::vector<std::vector<std::string>>& rows);

}  // namespace gridmerge
