#include "config/read_file.hpp"

#include <fstream>
#include <system_error>

#include "gridmerge/base/error.hpp"

namespace gridmerge {

std::string read_file(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  const std::string name = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw InputError(name, "does not exist");
  }
  if (status.type() == std::filesystem::file_type::directory) {
    throw InputError(name, "is a directory, not a file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) {
    throw InputError(name, "cannot be read: " + error.message());
  }
  if (size > max_bytes) {
    throw InputError(
        name, "is " + std::to_string(size) + " bytes long; at most " + std::to_string(max_bytes) + " are accepted");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(size, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) {
    throw InputError(name, "cannot be read: " + std::generic_category().message(errno));
  }
  return bytes;
}

}  // namespace gridmerge
