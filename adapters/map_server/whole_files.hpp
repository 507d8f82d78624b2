#pragma once
/// Writing files so that nobody ever sees half of one.
#include <filesystem>
#include <string_view>
#include <vector>

namespace gridmerge {

/// A set of files that appear together, or not at all. Each is first written beside its target under another name;
/// `commit` then renames them. Without it the destructor removes what was written, so a set that meets an exception
/// leaves no trace.
class WholeFiles {
 public:
  WholeFiles() = default;
  WholeFiles(const WholeFiles&) = delete;
  WholeFiles& operator=(const WholeFiles&) = delete;
  ~WholeFiles();

  /// Writes the content beside its target. The folder must exist.
  /// @throws InputError naming the target and what the system says, if that fails.
  void stage(const std::filesystem::path& target, std::string_view content);

  /// Puts all in place, in the order staged; files of the same name are replaced. The set is empty afterwards.
  /// @throws InputError if one cannot be put in place: then all targets are as they were before.
  void commit();

 private:
  struct Staged {
    std::filesystem::path target;
    std::filesystem::path partial;   ///< the content, until committed
    std::filesystem::path previous;  ///< what stood at the target; empty: nothing
  };
  std::vector<Staged> staged_;
};

/// One file, whole or not at all.
/// @throws InputError as WholeFiles does.
void write_whole_file(const std::filesystem::path& target, std::string_view content);

}  // namespace gridmerge
