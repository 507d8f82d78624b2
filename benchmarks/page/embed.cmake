# Writes OUTPUT, a C++ source that holds the text of FILES: what assets.hpp declares.
include(${CMAKE_CURRENT_LIST_DIR}/../../cmake/text_literal.cmake)
set(pages "")
set(scripts "")

foreach(file IN LISTS FILES)
  text_literal(${file} text)
  get_filename_component(extension ${file} LAST_EXT)
  if(file STREQUAL CHART_JS)
    set(chart "${text}")
  elseif(extension STREQUAL ".html")
    set(html "${text}")
  elseif(extension STREQUAL ".css")
    set(css "${text}")
  else()
    string(APPEND scripts "\n      .append(${text})")
  endif()
endforeach()

file(WRITE ${OUTPUT} "// Made by embed.cmake.
#include \"page/assets.hpp\"

namespace gridmerge::page {

Assets assets() {
  Assets all;
  all.html = ${html};
  all.css = ${css};
  all.chart_library = ${chart};
  all.script = std::string()${scripts};
  return all;
}

}  // namespace gridmerge::page
")
