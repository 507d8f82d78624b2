#pragma once
/// Reading a whole file into memory.
#include <cstdint>
#include <filesystem>
#include <string>

namespace gridmerge {

/// The bytes of a regular file.
/// @throws InputError naming the file, if it does not exist, is no regular file, may not be read, or holds more than
/// `max_bytes`: then no memory has been taken.
[[nodiscard]] std::string read_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

/// More than any text that a person writes.
inline constexpr std::uintmax_t kMaxYamlBytes = 1 << 20;

}  // namespace gridmerge
