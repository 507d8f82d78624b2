#pragma once
/// Text that stands in an HTML page.
#include <string>
#include <string_view>

namespace gridmerge {

/// The text with its &, <, > and " escaped: between tags and in attributes it means itself.
[[nodiscard]] std::string html_escaped(std::string_view text);

}  // namespace gridmerge
