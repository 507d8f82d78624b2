#include "manifest/folder_entries.hpp"

#include <algorithm>
#include <system_error>

#include "gridmerge/base/error.hpp"

namespace gridmerge {

namespace fs = std::filesystem;

std::vector<fs::path> folder_entries(const fs::path& folder, const std::vector<std::string>& extensions) {
  std::error_code error;
  std::vector<fs::path> entries;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator(); at.increment(error)) {
    const std::string extension = at->path().extension().string();
    if (extensions.empty() || std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      entries.push_back(at->path());
    }
  }
  if (error) {
    throw InputError(folder.string(), "cannot be read: " + error.message());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace gridmerge
