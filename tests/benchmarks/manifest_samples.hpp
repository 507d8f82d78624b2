#pragma once
/// Small files in the formats of public data sets, for the tests of their readers.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "map_server/map_files.hpp"

namespace gridmerge::samples {

namespace fs = std::filesystem;

/// An empty folder of the test that runs.
inline fs::path test_folder(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder =
      fs::path(testing::TempDir()) / "gridmerge_manifest" / test->test_suite_name() / test->name() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

inline void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

inline std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The text of the InputError that the call throws; empty if it throws none.
template <typename Call>
std::string problem_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A .npy file of format 1.0 with that header and those bytes.
inline std::string npy(const std::string& type, const std::string& shape, const std::string& data,
                       const std::string& by_columns = "False") {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + by_columns + ", 'shape': " + shape + ", }";
  header.resize((header.size() + 10 + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  const auto length = static_cast<char>(header.size());
  return std::string("\x93NUMPY\x01\x00", 8) + length + '\0' + header + data;
}

template <typename Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

/// N rows of two numbers, as NumPy saves a list of points.
inline std::string npy_points(const std::vector<double>& numbers) {
  return npy("<f8", "(" + std::to_string(numbers.size() / 2) + ", 2)", bytes_of(numbers));
}

inline std::string npy_indices(const std::vector<std::int64_t>& numbers) {
  return npy("<i8", "(" + std::to_string(numbers.size() / 2) + ", 2)", bytes_of(numbers));
}

}  // namespace gridmerge::samples
