#pragma once
/// Texts and numbers in a page, whatever bytes they hold. Only for this folder's .cpp files.
#include <cstdint>
#include <string>
#include <string_view>

namespace gridmerge::page {

/// In quotes, and never ends the <script> element it stands in. What is not UTF-8 becomes U+FFFD.
[[nodiscard]] std::string json_string(std::string_view text);

/// Seven digits; null where it is not finite.
[[nodiscard]] std::string json_number(double value);
[[nodiscard]] inline std::string json_number(int value) { return std::to_string(value); }
[[nodiscard]] inline std::string json_number(std::int64_t value) { return std::to_string(value); }

/// "[a,b,c]", of what `json_of` makes of each.
template <typename Items, typename JsonOf>
[[nodiscard]] std::string json_array(const Items& items, JsonOf json_of) {
  std::string json = "[";
  for (const auto& item : items) {
    json += json.size() > 1 ? "," : "";
    json += json_of(item);
  }
  return json + "]";
}

/// A text between tags or in an attribute. What is not UTF-8 becomes U+FFFD.
[[nodiscard]] std::string html_text(std::string_view text);

/// "data:image/png;base64,..." in quotes; null where there is no picture.
[[nodiscard]] std::string json_png(std::string_view png);

}  // namespace gridmerge::page
