#pragma once
/// What lies in a folder, in an order that does not depend on the machine.
#include <filesystem>
#include <string>
#include <vector>

namespace gridmerge {

/// The entries, by name; with extensions (".png"): only those that have one of them.
/// @throws InputError naming the folder, if it cannot be read
[[nodiscard]] std::vector<std::filesystem::path> folder_entries(const std::filesystem::path& folder,
                                                                const std::vector<std::string>& extensions = {});

}  // namespace gridmerge
