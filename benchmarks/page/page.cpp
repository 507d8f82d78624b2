#include "page/page.hpp"

#include <string_view>

#include "page/assets.hpp"
#include "page/json_text.hpp"
#include "page/page_data.hpp"

namespace gridmerge::page {
namespace {

/// What stands for {{name}} in page.html.
std::string filling(std::string_view name, const PageInput& input, const Assets& all) {
  if (name == "title") {
    return html_text(input.name.empty() ? "study" : input.name);
  }
  if (name == "css") {
    return all.css;
  }
  if (name == "chart_library") {
    return all.chart_library;
  }
  if (name == "script") {
    return all.script;
  }
  return name == "data" ? study_json(input) : pictures_json(input.failures);
}

}  // namespace

std::string report_page(const PageInput& input) {
  constexpr std::string_view kOpen = "{{";
  constexpr std::string_view kClose = "}}";
  const Assets all = assets();
  const std::string_view html = all.html;
  std::string page;
  std::size_t from = 0;
  for (std::size_t open = html.find(kOpen); open != html.npos; open = html.find(kOpen, from)) {
    const std::size_t close = html.find(kClose, open);
    page += html.substr(from, open - from);
    page += filling(html.substr(open + kOpen.size(), close - open - kOpen.size()), input, all);
    from = close + kClose.size();
  }
  page += html.substr(from);
  return page;
}

}  // namespace gridmerge::page
