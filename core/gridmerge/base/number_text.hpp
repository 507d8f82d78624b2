#pragma once
/// Numbers as text.
#include <charconv>
#include <cstdio>
#include <string>

namespace gridmerge {

/// The shortest text that reads back as the same number.
[[nodiscard]] inline std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// With that many digits after the point.
[[nodiscard]] inline std::string fixed(double value, int digits) {
  char text[400];  // the longest double has 309 digits before the point
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace gridmerge
