#pragma once
/// 8-bit images, and their PGM and PNG files.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge {

/// An image with 8 bits a sample, the first row at the top.
struct RasterImage {
  int width = 0;
  int height = 0;
  int channels = 1;                   ///< 1 gray, 2 gray and alpha, 3 RGB, 4 RGBA
  std::vector<std::uint8_t> samples;  ///< row-major, the channels of a pixel side by side

  friend bool operator==(const RasterImage&, const RasterImage&) = default;
};

/// How large a map may be that somebody hands us.
struct MapLimits {
  int max_side_cells = 32768;
  std::int64_t max_cells = std::int64_t{1} << 28;
};

/// Reads PGM (P2 and P5, 8 and 16 bits) and PNG (every kind). Samples of other depths are scaled to 0..255, a palette
/// becomes RGB, a transparent colour becomes alpha; gamma is left alone, as map_server does. Size and the bytes there
/// are get compared before memory is taken.
/// @param name  the file's name, for messages
/// @throws InputError naming file, value and rule.
[[nodiscard]] RasterImage decode_image(std::string_view bytes, const std::string& name, const MapLimits& limits = {});

/// A PNG file. @throws std::invalid_argument if the image is empty or has not as many samples as its size says.
[[nodiscard]] std::string encode_png(const RasterImage& image);

/// A binary PGM (P5) file. @throws std::invalid_argument as encode_png, or if the image is not plain gray.
[[nodiscard]] std::string encode_pgm(const RasterImage& image);

/// @throws std::invalid_argument if the image is empty or has not as many samples as its size says.
void check_image(const RasterImage& image);

}  // namespace gridmerge
