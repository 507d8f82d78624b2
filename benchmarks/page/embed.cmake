# Writes OUTPUT, a C++ source that holds the text of FILES: what assets.hpp declares. A literal may be 64 KiB long
# everywhere, so longer texts are cut into pieces.
set(piece 60000)
set(pages "")
set(scripts "")

# The text of a file as an expression of the type std::string.
function(as_expression file result)
  file(READ ${file} text)
  string(LENGTH "${text}" length)
  set(expression "std::string()")
  set(from 0)
  while(from LESS length)
    string(SUBSTRING "${text}" ${from} ${piece} part)
    string(APPEND expression "\n      .append(R\"~file~(${part})~file~\")")
    math(EXPR from "${from} + ${piece}")
  endwhile()
  set(${result} "${expression}" PARENT_SCOPE)
endfunction()

foreach(file IN LISTS FILES)
  as_expression(${file} text)
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
