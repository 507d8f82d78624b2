#include "page/json_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/html.hpp"

namespace gridmerge::page {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= there ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string quoted_utf8(std::string_view text) {
  return nlohmann::json(std::string(text)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string json_string(std::string_view text) {
  std::string safe;
  for (const char c : quoted_utf8(text)) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string json_number(double value) {
  constexpr int kDigits = 7;
  if (!std::isfinite(value)) {
    return "null";
  }
  std::array<char, 32> buffer{};
  char* const begin = buffer.data();
  return {begin, std::to_chars(begin, begin + buffer.size(), value, std::chars_format::general, kDigits).ptr};
}

std::string html_text(std::string_view text) {
  return html_escaped(nlohmann::json::parse(quoted_utf8(text)).get<std::string>());
}

std::string json_png(std::string_view png) {
  return png.empty() ? "null" : "\"data:image/png;base64," + base64(png) + "\"";
}

}  // namespace gridmerge::page
