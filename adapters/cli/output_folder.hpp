#pragma once
/// The folder that results go to.
#include <filesystem>
#include <vector>

namespace gridmerge::cli {

/// Makes the folder, and those above it, where they are not there. What it made and nobody filled is removed again by
/// the destructor.
class OutputFolder {
 public:
  /// @throws InputError naming the folder, if it cannot be made or nothing can be written in it
  explicit OutputFolder(std::filesystem::path folder);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

 private:
  std::vector<std::filesystem::path> made_;  ///< the outermost first
};

}  // namespace gridmerge::cli
