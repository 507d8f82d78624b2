#pragma once
/// Programs run as a user runs them.
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace gridmerge {

[[nodiscard]] inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
}

/// How a command ended, and what it said.
struct Ended {
  int status = -1;  ///< its exit status; -1: a signal ended it
  std::string out;
  std::string err;
};

/// Runs words of a shell in a folder, which is left as the command leaves it.
[[nodiscard]] inline Ended run_in(const std::filesystem::path& folder, const std::string& words) {
  const std::filesystem::path out = folder / ".stdout";
  const std::filesystem::path err = folder / ".stderr";
  const std::string command = "cd '" + folder.string() + "' && { " + words + "; } >.stdout 2>.stderr </dev/null";
  const int status = std::system(command.c_str());
  Ended ended{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return ended;
}

}  // namespace gridmerge
