#pragma once
/// One writer a file, held by the system: a process that ends, however it ends, lets go.
#include <filesystem>

namespace gridmerge::study {

/// Locks a hidden file beside the one it is for. The hidden file stays: only so can no two hold it.
class FileLock {
 public:
  /// @throws InputError naming the file and who holds it, if it is held; or if it cannot be made
  explicit FileLock(const std::filesystem::path& file);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  int descriptor_ = -1;
};

}  // namespace gridmerge::study
