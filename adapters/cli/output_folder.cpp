#include "cli/output_folder.hpp"

#include <system_error>

#include "gridmerge/base/error.hpp"
#include "map_server/whole_files.hpp"

namespace gridmerge::cli {
namespace {

namespace fs = std::filesystem;

/// Removes the folders that are empty, the innermost first.
void remove_empty(const std::vector<fs::path>& folders) {
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) {
    std::error_code ignored;
    fs::remove(*folder, ignored);  // fails on a folder that holds something
  }
}

}  // namespace

OutputFolder::OutputFolder(fs::path folder) {
  try {
    fs::path part;
    for (const fs::path& name : folder) {
      part /= name;
      std::error_code error;
      if (fs::exists(part, error) && !fs::is_directory(part, error)) {
        throw InputError(part.string(), "is not a folder");
      }
      if (fs::create_directory(part, error)) {
        made_.push_back(part);
      } else if (error) {
        throw InputError(part.string(), "the folder cannot be made: " + error.message());
      }
    }
    WholeFiles().stage(folder / "report.json", "");  // better to know now than after the search
  } catch (...) {
    remove_empty(made_);
    throw;
  }
}

OutputFolder::~OutputFolder() { remove_empty(made_); }

}  // namespace gridmerge::cli
