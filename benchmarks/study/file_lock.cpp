#include "study/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "gridmerge/base/error.hpp"

namespace gridmerge::study {
namespace {

std::string holder(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t count = pread(descriptor, text.data(), text.size(), 0);
  return count > 0 ? " (process " + std::string(text.data(), static_cast<std::size_t>(count)) + ")" : "";
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file) {
  const std::filesystem::path hidden = file.parent_path() / ("." + file.filename().string() + ".lock");
  descriptor_ = open(hidden.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw InputError(hidden.string(), "cannot be made: " + std::generic_category().message(errno));
  }
  if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const std::string who = holder(descriptor_);
    close(descriptor_);
    throw InputError(file.string(), "another run of the study writes it just now" + who +
                                        "; wait for its end, or take another folder");
  }
  const std::string me = std::to_string(getpid());
  if (ftruncate(descriptor_, 0) == 0) {
    (void)!pwrite(descriptor_, me.data(), me.size(), 0);  // only for the message above
  }
}

FileLock::~FileLock() { close(descriptor_); }

}  // namespace gridmerge::study
