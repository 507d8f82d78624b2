#pragma once
/// Numbers as text.
#include <charconv>
#include <string>

namespace gridmerge {

/// The shortest text that reads back as the same number.
[[nodiscard]] inline std::string exact(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace gridmerge
