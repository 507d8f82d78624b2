#include "map_server/raster_image.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "gridmerge/base/error.hpp"

namespace gridmerge {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

void check_size(std::int64_t width, std::int64_t height, const std::string& name, const MapLimits& limits) {
  const std::string size = "is " + std::to_string(width) + " x " + std::to_string(height) + " pixels; ";
  if (std::min(width, height) < 1 || std::max(width, height) > limits.max_side_cells) {
    throw InputError(name, size + "each side must be 1 .. " + std::to_string(limits.max_side_cells));
  }
  if (width * height > limits.max_cells) {
    throw InputError(name, size + "at most " + std::to_string(limits.max_cells) + " pixels are accepted");
  }
}

RasterImage blank_image(std::int64_t width, std::int64_t height, int channels) {
  RasterImage image{static_cast<int>(width), static_cast<int>(height), channels, {}};
  image.samples.resize(static_cast<std::size_t>(width * height * channels));
  return image;
}

// --- PGM -------------------------------------------------------------------------------------------------------------

/// Walks over the text part of a PGM file as netpbm does: a comment runs from '#' to the end of its line, anywhere.
class PgmText {
 public:
  PgmText(std::string_view rest, const std::string& name) : rest_(rest), name_(name) {}

  /// The next number, and the one character behind it, which must be white space or the end of the file.
  int number(const char* what) {
    int character = next();
    while (is_space(character)) {
      character = next();
    }
    if (character == kEnd) {
      throw InputError(name_, std::string("PGM ends before its ") + what);
    }
    if (!is_digit(character)) {
      throw InputError(name_, std::string("PGM ") + what + " is not a number");
    }
    std::int64_t value = 0;
    for (; is_digit(character); character = next()) {
      value = std::min<std::int64_t>(10 * value + (character - '0'), std::numeric_limits<int>::max());
    }
    if (character != kEnd && !is_space(character)) {
      throw InputError(name_, std::string("PGM ") + what + " is not a number");
    }
    return static_cast<int>(value);
  }

  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  static constexpr int kEnd = -1;
  static bool is_space(int c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  static bool is_digit(int c) { return c >= '0' && c <= '9'; }

  int take() {
    if (rest_.empty()) {
      return kEnd;
    }
    const int character = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return character;
  }
  int next() {
    int character = take();
    if (character == '#') {
      while (character != kEnd && character != '\n' && character != '\r') {
        character = take();
      }
    }
    return character;
  }

  std::string_view rest_;
  const std::string& name_;
};

/// The 8-bit sample for each value 0..maxval.
std::vector<std::uint8_t> eight_bit_samples(int maxval) {
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(maxval) + 1);
  for (int value = 0; value <= maxval; ++value) {
    samples[static_cast<std::size_t>(value)] = static_cast<std::uint8_t>((value * 255 + maxval / 2) / maxval);
  }
  return samples;
}

RasterImage decode_pgm(std::string_view bytes, const std::string& name, const MapLimits& limits) {
  const bool plain = bytes[1] == '2';
  PgmText text(bytes.substr(2), name);
  const std::int64_t width = text.number("width");
  const std::int64_t height = text.number("height");
  check_size(width, height, name, limits);
  const int maxval = text.number("maxval");
  if (maxval < 1 || maxval > 65535) {
    throw InputError(name, "PGM maxval is " + std::to_string(maxval) + "; it must be 1 .. 65535");
  }
  // A plain sample is at least a digit, and a space between it and the next one.
  const std::int64_t sample_bytes = plain || maxval > 255 ? 2 : 1;
  const std::int64_t needed = width * height * sample_bytes - (plain ? 1 : 0);
  if (static_cast<std::int64_t>(text.rest().size()) < needed) {
    throw InputError(name, "PGM is cut off: " + std::to_string(text.rest().size()) + " bytes of samples, " +
                               std::to_string(width) + " x " + std::to_string(height) + " pixels need " +
                               std::to_string(needed));
  }

  const std::vector<std::uint8_t> sample_of = eight_bit_samples(maxval);
  RasterImage image = blank_image(width, height, 1);
  const auto fill = [&](const auto& next_value) {
    for (std::uint8_t& sample : image.samples) {
      const auto value = static_cast<std::size_t>(next_value());
      if (value >= sample_of.size()) {
        throw InputError(name, "PGM sample is " + std::to_string(value) + "; it must not exceed the maxval " +
                                   std::to_string(maxval));
      }
      sample = sample_of[value];
    }
  };
  const auto* raw = reinterpret_cast<const std::uint8_t*>(text.rest().data());
  if (plain) {
    fill([&] { return text.number("last sample"); });
  } else if (maxval == 255) {
    std::copy_n(raw, image.samples.size(), image.samples.begin());
  } else if (maxval < 255) {
    fill([&] { return *raw++; });
  } else {
    fill([&] {
      const int high = *raw++;
      return 256 * high + *raw++;
    });
  }
  return image;
}

// --- PNG -------------------------------------------------------------------------------------------------------------
// libpng reports errors by longjmp. So each function that calls `setjmp` holds plain values only, and the strings and
// vectors live in its caller.

struct PngMessage {
  char text[128] = "";
};

[[noreturn]] void keep_message(png_structp png, png_const_charp text) {
  auto* message = static_cast<PngMessage*>(png_get_error_ptr(png));
  std::strncpy(message->text, text, sizeof message->text - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto* rest = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > rest->size()) {
    png_error(png, "the file is cut off");
  }
  std::memcpy(out, rest->data(), count);
  rest->remove_prefix(count);
}

void append_bytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* file = static_cast<std::string*>(png_get_io_ptr(png));
  try {
    file->append(reinterpret_cast<const char*>(bytes), count);
    return;
  } catch (const std::bad_alloc&) {
  }
  png_error(png, "out of memory");
}

void nothing_to_flush(png_structp) {}

class PngReader {
 public:
  explicit PngReader(std::string_view bytes) : rest_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message_, keep_message, ignore_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, &rest_, take_bytes);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Everything up to the first pixel. @return false with an error
  [[nodiscard]] bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(png_, info_);
    packed_row_bytes_ = png_get_rowbytes(png_, info_);
    return true;
  }

  /// To 8 bits a sample, with neither palette nor transparent colour. @return false with an error
  [[nodiscard]] bool prepare_rows() {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    png_set_scale_16(png_);
    png_set_expand(png_);
    passes_ = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }

  /// @return false with an error
  [[nodiscard]] bool read_rows(std::uint8_t* samples) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      return false;
    }
    const std::size_t row_bytes = png_get_rowbytes(png_, info_);
    for (int pass = 0; pass < passes_; ++pass) {
      for (std::size_t row = 0; row < static_cast<std::size_t>(height()); ++row) {
        png_read_row(png_, samples + row * row_bytes, nullptr);
      }
    }
    png_read_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] std::int64_t width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] std::int64_t height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] int channels() const { return png_get_channels(png_, info_); }
  [[nodiscard]] std::int64_t packed_bytes() const { return height() * static_cast<std::int64_t>(packed_row_bytes_); }
  [[nodiscard]] std::string error() const { return message_.text; }

 private:
  std::string_view rest_;
  PngMessage message_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::size_t packed_row_bytes_ = 0;
  int passes_ = 1;
};

RasterImage decode_png(std::string_view bytes, const std::string& name, const MapLimits& limits) {
  PngReader reader(bytes);
  const auto demand = [&](bool done) {
    if (!done) {
      throw InputError(name, "PNG cannot be read: " + reader.error());
    }
  };
  demand(reader.read_header());
  check_size(reader.width(), reader.height(), name, limits);
  constexpr std::int64_t kMostDeflateCanPack = 1032;  // bytes out of one, see zlib's technical notes
  if (reader.packed_bytes() / kMostDeflateCanPack > static_cast<std::int64_t>(bytes.size())) {
    throw InputError(name, "PNG is cut off: " + std::to_string(bytes.size()) + " bytes cannot hold " +
                               std::to_string(reader.width()) + " x " + std::to_string(reader.height()) + " pixels");
  }
  demand(reader.prepare_rows());
  RasterImage image = blank_image(reader.width(), reader.height(), reader.channels());
  demand(reader.read_rows(image.samples.data()));
  return image;
}

/// @return false with an error
bool write_png(png_structp png, png_infop info, const RasterImage& image, std::string& file) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                  PNG_COLOR_TYPE_RGB_ALPHA};
  png_set_write_fn(png, &file, append_bytes, nothing_to_flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), 8,
               kColourTypes[image.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  // Maps are flat areas of few values: unfiltered rows pack better than filtered ones. Level 3 takes a third of the
  // time of zlib's own choice for half as many bytes again; the figures are in README.md.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_set_compression_level(png, 3);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  for (std::size_t row = 0; row < static_cast<std::size_t>(image.height); ++row) {
    png_write_row(png, image.samples.data() + row * row_bytes);
  }
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

RasterImage decode_image(std::string_view bytes, const std::string& name, const MapLimits& limits) {
  if (bytes.starts_with(kPngSignature)) {
    return decode_png(bytes, name, limits);
  }
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) {
    return decode_pgm(bytes, name, limits);
  }
  throw InputError(name, bytes.empty() ? "is empty" : "is neither a PGM (P2, P5) nor a PNG image");
}

std::string encode_png(const RasterImage& image) {
  check_image(image);
  PngMessage message;
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, keep_message, ignore_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool written = info != nullptr && write_png(png, info, image, file);
  png_destroy_write_struct(&png, &info);
  if (!written) {
    throw std::runtime_error(std::string("PNG cannot be made: ") + message.text);
  }
  return file;
}

std::string encode_pgm(const RasterImage& image) {
  check_image(image);
  if (image.channels != 1) {
    throw std::invalid_argument("PGM holds gray images only, not " + std::to_string(image.channels) + " channels");
  }
  std::string file = "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  file.append(image.samples.begin(), image.samples.end());
  return file;
}

void check_image(const RasterImage& image) {
  if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4) {
    throw std::invalid_argument("image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                                " pixels, " + std::to_string(image.channels) + " channels: it must hold pixels, and " +
                                "1 .. 4 channels");
  }
  const auto needed = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                      static_cast<std::size_t>(image.channels);
  if (image.samples.size() != needed) {
    throw std::invalid_argument("image holds " + std::to_string(image.samples.size()) + " samples, its size says " +
                                std::to_string(needed));
  }
}

}  // namespace gridmerge
