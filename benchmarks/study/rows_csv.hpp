#pragma once
/// Rows as a CSV file (RFC 4180): a heading, a line a row, quotes where a cell needs them.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "study/row.hpp"

namespace gridmerge::study {

/// Numbers are the shortest text that reads back as the same; what is not known is an empty cell.
[[nodiscard]] std::string to_csv(const std::vector<Row>& rows);

/// Reads what to_csv wrote; columns in any order, those that are no field of a row are figures, missing ones keep their
/// defaults.
/// @param name  stands for the file in messages
/// @throws InputError naming file, line, column and value
[[nodiscard]] std::vector<Row> parse_rows_csv(std::string_view text, const std::string& name);
[[nodiscard]] std::vector<Row> read_rows_csv(const std::filesystem::path& csv);

/// Writes folder/rows.csv, whole or not at all.
void write_rows_csv(const std::filesystem::path& folder, const std::vector<Row>& rows);

}  // namespace gridmerge::study
