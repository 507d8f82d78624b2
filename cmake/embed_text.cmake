# Writes OUTPUT, a C++ source that holds the text of FILE: what HEADER declares, as FUNCTION in the namespace gridmerge.
include(${CMAKE_CURRENT_LIST_DIR}/text_literal.cmake)
text_literal(${FILE} text)
file(WRITE ${OUTPUT} "// Made by embed_text.cmake.
#include \"${HEADER}\"

namespace gridmerge {

std::string ${FUNCTION}() {
  return ${text};
}

}  // namespace gridmerge
")
