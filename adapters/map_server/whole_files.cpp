#include "map_server/whole_files.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIsDirectory = "a directory has this name";

[[noreturn]] void throw_unwritable(const fs::path& target, const std::string& reason) {
  throw InputError(target.string(), "cannot be written: " + reason);
}

/// A name beside the target that no file bears, though a killed program may have left some behind.
fs::path free_name(const fs::path& target, const std::string& kind) {
  for (int number = 0;; ++number) {
    fs::path name = target;
    name += "." + kind + std::to_string(number);
    std::error_code error;
    if (!fs::exists(fs::symlink_status(name, error))) {
      return name;
    }
  }
}

void remove_quietly(const fs::path& file) {
  std::error_code ignored;
  fs::remove(file, ignored);
}

/// A second name for what stands at the target, or else a copy; an empty path if nothing does. Other writers may put
/// files in place at the same time.
fs::path keep_previous(const fs::path& target) {
  for (;;) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(target, error);
    if (!fs::exists(status)) {
      return {};
    }
    if (fs::is_directory(status)) {
      throw_unwritable(target, kIsDirectory);
    }
    const fs::path previous = free_name(target, "previous");
    fs::create_hard_link(target, previous, error);
    if (!error) {
      return previous;
    }
    if (error == std::errc::file_exists || error == std::errc::no_such_file_or_directory) {
      continue;  // one took the name, or the file, in between
    }
    error.clear();
    fs::copy(target, previous, fs::copy_options::copy_symlinks, error);
    if (!error) {
      return previous;
    }
    remove_quietly(previous);
    throw_unwritable(target, "the file there cannot be kept aside: " + error.message());
  }
}

}  // namespace

WholeFiles::~WholeFiles() {
  for (const Staged& file : staged_) {
    remove_quietly(file.partial);
  }
}

void WholeFiles::stage(const fs::path& target, std::string_view content) {
  std::error_code error;
  if (fs::is_directory(target, error)) {
    throw_unwritable(target, kIsDirectory);
  }
  fs::path partial;
  std::FILE* file = nullptr;
  do {  // another process may take the free name first
    partial = free_name(target, "partial");
    errno = 0;
    file = std::fopen(partial.c_str(), "wbx");
  } while (file == nullptr && errno == EEXIST);
  if (file == nullptr) {
    throw_unwritable(target, std::generic_category().message(errno));
  }
  staged_.push_back({target, partial, {}});
  errno = 0;
  bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  int reason = errno;
  if (std::fclose(file) != 0 && written) {
    written = false;
    reason = errno;
  }
  if (!written) {
    remove_quietly(partial);
    staged_.pop_back();
    throw_unwritable(target, std::generic_category().message(reason));
  }
}

void WholeFiles::commit() {
  std::size_t placed = 0;
  try {
    for (; placed < staged_.size(); ++placed) {
      Staged& file = staged_[placed];
      file.previous = keep_previous(file.target);
      std::error_code error;
      fs::rename(file.partial, file.target, error);
      if (error) {
        throw_unwritable(file.target, error.message());
      }
    }
  } catch (...) {
    if (!staged_[placed].previous.empty()) {
      remove_quietly(staged_[placed].previous);
    }
    while (placed-- > 0) {
      const Staged& file = staged_[placed];
      std::error_code ignored;
      if (file.previous.empty()) {
        fs::remove(file.target, ignored);
      } else {
        fs::rename(file.previous, file.target, ignored);
      }
    }
    throw;
  }
  for (const Staged& file : std::exchange(staged_, {})) {
    if (!file.previous.empty()) {
      remove_quietly(file.previous);
    }
  }
}

void write_whole_file(const fs::path& target, std::string_view content) {
  WholeFiles files;
  files.stage(target, content);
  files.commit();
}

}  // namespace gridmerge
