#include "manifest/npy_array.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "config/read_file.hpp"
#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 24;
constexpr int kMaxSide = 1 << 20;

/// What the text in front of the numbers says.
struct Layout {
  char order = '<';  ///< '<' little, '>' big endian
  char kind = 'f';   ///< 'f' float, 'i' signed, 'u' unsigned
  int bytes = 8;     ///< of one element
  bool by_columns = false;
  int rows = 0;
  int columns = 0;
};

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) {
    value = (value << 8U) | static_cast<unsigned char>(bytes[i - 1]);
  }
  return value;
}

/// What stands behind `'key':` in the text, which is a Python dictionary that NumPy writes in one fixed way.
std::optional<std::string_view> entry_of(std::string_view text, std::string_view key) {
  const std::string quoted = "'" + std::string(key) + "':";
  const std::size_t at = text.find(quoted);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  text.remove_prefix(at + quoted.size());
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return text;
}

std::optional<int> next_side(std::string_view& shape) {
  shape.remove_prefix(std::min(shape.find_first_not_of("( ,"), shape.size()));
  int side = 0;
  const auto [end, error] = std::from_chars(shape.data(), shape.data() + shape.size(), side);
  if (error != std::errc{} || side < 0 || side > kMaxSide) {
    return std::nullopt;
  }
  shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
  return side;
}

void read_type(std::string_view text, const std::string& name, Layout& layout) {
  const std::string_view type = text.substr(0, std::min(text.find('\'', 1), text.size()));  // 'f8 without its end
  if (type.size() >= 3 && type[2] == 'O') {
    throw InputError(name, "holds Python objects (dtype object): only tables of numbers are read");
  }
  const bool known = type.size() == 4 && type.front() == '\'' && std::strchr("<>|=", type[1]) != nullptr &&
                     std::strchr("fiu", type[2]) != nullptr && std::strchr("1248", type[3]) != nullptr;
  layout.order = known ? type[1] : '?';
  layout.kind = known ? type[2] : '?';
  layout.bytes = known ? type[3] - '0' : 0;
  if (!known || (layout.kind == 'f' && layout.bytes < 4)) {
    throw InputError(name, "dtype: " + std::string(type.substr(0, 20)) + "' is neither f4, f8 nor an integer type");
  }
}

Layout layout_of(std::string_view header, const std::string& name) {
  const auto type = entry_of(header, "descr");
  const auto by_columns = entry_of(header, "fortran_order");
  auto shape = entry_of(header, "shape");
  if (!type || !by_columns || !shape) {
    throw InputError(name, "its header has no descr, no fortran_order or no shape");
  }
  Layout layout;
  read_type(*type, name, layout);
  layout.by_columns = by_columns->starts_with("True");
  const std::string_view axes = shape->substr(0, std::min(shape->find(')'), shape->size()));
  std::string_view rest = axes;
  const std::optional<int> rows = next_side(rest);
  const std::optional<int> columns = rows ? next_side(rest) : std::nullopt;
  if (!columns || next_side(rest)) {
    throw InputError(name, "shape: " + std::string(axes.substr(0, 40)) + ") has not two axes");
  }
  layout.rows = *rows;
  layout.columns = *columns;
  return layout;
}

double element(std::string_view bytes, const Layout& layout) {
  char swapped[8] = {};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    swapped[i] = bytes[layout.order == '>' ? bytes.size() - 1 - i : i];
  }
  const std::uint64_t raw = little_endian({swapped, bytes.size()});
  if (layout.kind == 'f' && layout.bytes == 8) {
    double value = 0;
    std::memcpy(&value, &raw, sizeof value);
    return value;
  }
  if (layout.kind == 'f') {
    const auto low = static_cast<std::uint32_t>(raw);
    float value = 0;
    std::memcpy(&value, &low, sizeof value);
    return static_cast<double>(value);
  }
  const std::uint64_t sign = std::uint64_t{1} << (8U * bytes.size() - 1U);
  const bool negative = layout.kind == 'i' && (raw & sign) != 0;
  return negative ? -static_cast<double>((sign << 1U) - raw) : static_cast<double>(raw);
}

}  // namespace

NpyTable parse_npy(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (!bytes.starts_with(kMagic) || bytes.size() < 10) {
    throw InputError(name, "is no NumPy file: it does not begin with \\x93NUMPY");
  }
  const int version = static_cast<unsigned char>(bytes[6]);
  if (version < 1 || version > 3) {
    throw InputError(name, "NumPy format " + std::to_string(version) + " is not known: 1, 2 and 3 are");
  }
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  const std::size_t start = 8 + length_bytes;
  const std::size_t header_bytes = bytes.size() < start ? bytes.size() : little_endian(bytes.substr(8, length_bytes));
  if (bytes.size() < start || bytes.size() - start < header_bytes) {
    throw InputError(name, "ends within its header");
  }
  const Layout layout = layout_of(bytes.substr(start, header_bytes), name);
  const std::string_view data = bytes.substr(start + header_bytes);
  const std::size_t count = static_cast<std::size_t>(layout.rows) * static_cast<std::size_t>(layout.columns);
  const auto width = static_cast<std::size_t>(layout.bytes);
  if (data.size() != count * width) {
    throw InputError(name, "holds " + std::to_string(data.size()) + " bytes of numbers, its header asks for " +
                               std::to_string(count * width));
  }
  NpyTable table = {.rows = layout.rows, .columns = layout.columns, .values = std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const auto rows = static_cast<std::size_t>(layout.rows);
    const auto columns = static_cast<std::size_t>(layout.columns);
    const std::size_t to = layout.by_columns ? (i % rows) * columns + i / rows : i;
    table.values[to] = element(data.substr(i * width, width), layout);
  }
  return table;
}

NpyTable read_npy(const std::filesystem::path& file) { return parse_npy(read_file(file, kMaxBytes), file.string()); }

}  // namespace gridmerge
