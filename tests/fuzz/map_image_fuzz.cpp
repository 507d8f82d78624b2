// Any bytes as an image file: it is refused with an InputError, or it is an image that turns into a sound grid and
// survives being written.
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "gridmerge/base/error.hpp"
#include "map_server/map_files.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

std::size_t number32(const std::uint8_t* bytes) {
  return (std::size_t{bytes[0]} << 24) | (std::size_t{bytes[1]} << 16) | (std::size_t{bytes[2]} << 8) | bytes[3];
}

/// Makes the checksum of every PNG chunk right, so that what is behind the check gets tried as well.
void repair_checksums(std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kFrame = 12;  // length, type, checksum
  for (std::size_t at = kSignature; at + kFrame <= size;) {
    const std::size_t length = number32(data + at);
    if (data[0] != 0x89 || length > size - at - kFrame) {
      return;
    }
    std::uint8_t* end = data + at + 8 + length;
    const auto crc = static_cast<std::uint32_t>(crc32(0, data + at + 4, static_cast<uInt>(length + 4)));
    for (int byte = 0; byte < 4; ++byte) {
      end[byte] = static_cast<std::uint8_t>(crc >> (24 - 8 * byte));
    }
    at += kFrame + length;
  }
}

void demand(bool holds) {
  if (!holds) {
    std::abort();
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
  size = LLVMFuzzerMutate(data, size, max_size);
  if (seed % 8 != 0) {
    repair_checksums(data, size);
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gridmerge;
  const MapLimits limits{.max_side_cells = 4096, .max_cells = 1 << 16};
  RasterImage image;
  try {
    image = decode_image({reinterpret_cast<const char*>(data), size}, "image", limits);
  } catch (const InputError&) {
    return 0;
  }
  check_image(image);
  demand(image.width <= limits.max_side_cells && image.height <= limits.max_side_cells);
  for (const MapMode mode : {MapMode::kTrinary, MapMode::kScale, MapMode::kRaw}) {
    for (const bool negate : {false, true}) {
      check_grid(grid_from_image(image, {.image = "i", .resolution_m = 0.05, .negate = negate, .mode = mode}));
    }
  }
  demand(decode_image(encode_png(image), "again", limits) == image);
  demand(image.channels != 1 || decode_image(encode_pgm(image), "again", limits) == image);
  return 0;
}
