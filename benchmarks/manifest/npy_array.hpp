#pragma once
/// Tables of numbers as NumPy keeps them in .npy files.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge {

/// A table of numbers, row-major.
struct NpyTable {
  int rows = 0;
  int columns = 0;
  std::vector<double> values;

  [[nodiscard]] double at(int row, int column) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// Reads the formats 1.0, 2.0 and 3.0: two axes, elements of 4- or 8-byte floats or 1- to 8-byte integers, of either
/// byte order, by rows or by columns. Whole numbers above 2^53 are rounded.
/// @param name  the file's name, for messages
/// @throws InputError naming file and rule. Arrays of Python objects are pickled programs and are not read.
[[nodiscard]] NpyTable parse_npy(std::string_view bytes, const std::string& name);

/// @throws InputError as parse_npy, or if the file cannot be read
[[nodiscard]] NpyTable read_npy(const std::filesystem::path& file);

}  // namespace gridmerge
