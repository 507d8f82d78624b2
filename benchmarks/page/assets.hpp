#pragma once
/// The page's own files, as they were when the program was built. Only for this folder's .cpp files.
#include <string>

namespace gridmerge::page {

struct Assets {
  std::string html;  ///< with {{name}} where something is put in
  std::string css;
  std::string chart_library;  ///< Chart.js
  std::string script;         ///< the files of script/, one after the other
};

[[nodiscard]] Assets assets();

}  // namespace gridmerge::page
