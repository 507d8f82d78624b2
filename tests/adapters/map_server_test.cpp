#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gridmerge/base/error.hpp"
#include "map_server/map_files.hpp"

namespace gridmerge {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;
using Cells = std::vector<std::int8_t>;
using Samples = std::vector<std::uint8_t>;

// --- tools -----------------------------------------------------------------------------------------------------------

/// A folder of its own for each test, removed at the end.
class TempFolder {
 public:
  TempFolder() {
    std::string name = ::testing::TempDir() + "map_server_test_XXXXXX";
    if (mkdtemp(name.data()) == nullptr) {
      throw std::runtime_error("no temporary folder");
    }
    path_ = name;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() { fs::remove_all(path_); }

  fs::path operator/(const std::string& name) const { return path_ / name; }
  fs::path put(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

 private:
  fs::path path_;
};

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

std::string number32(std::uint32_t value) {
  return {static_cast<char>(value >> 24), static_cast<char>(value >> 16), static_cast<char>(value >> 8),
          static_cast<char>(value)};
}

std::uint32_t crc32(const std::string& bytes) {
  std::uint32_t crc = ~0U;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
    }
  }
  return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
  return number32(static_cast<std::uint32_t>(data.size())) + type + data + number32(crc32(type + data));
}

/// One stored (not packed) deflate block.
std::string zlib_stored(const std::string& bytes) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(bytes.size());
  const auto low = [](int value) { return std::string{static_cast<char>(value), static_cast<char>(value >> 8)}; };
  return "\x78\x01\x01" + low(size) + low(~size) + bytes + number32((b << 16) | a);
}

struct Png {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  int depth = 8;
  int colour_type = 0;
  std::string rows = "";    ///< each with its filter byte in front
  std::string chunks = "";  ///< between header and pixels
  int interlace = 0;
};

/// A PNG file made without libpng, so that it can be odd.
std::string file_of(const Png& png) {
  const std::string kinds = {static_cast<char>(png.depth), static_cast<char>(png.colour_type), 0, 0,
                             static_cast<char>(png.interlace)};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", number32(png.width) + number32(png.height) + kinds) + png.chunks +
         chunk("IDAT", zlib_stored(png.rows)) + chunk("IEND", "");
}

/// Bytes, zeros among them, as a string.
std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) {
    text += static_cast<char>(value);
  }
  return text;
}

constexpr const char* kPlainYaml = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n";

MapDescription description(const std::string& more = "") { return parse_map_description(kPlainYaml + more, "m.yaml"); }

/// The cells of a one-row image.
Cells cells_of(const Samples& samples, int channels, const std::string& more = "") {
  const int width = static_cast<int>(samples.size()) / channels;
  return grid_from_image({width, 1, channels, samples}, description(more)).cells;
}

/// A grid of one row with every value that a cell can have.
OccupancyGrid every_value() {
  OccupancyGrid grid{{kOccupied - kUnknown + 1, 1, 0.05, {-1.5, 2.25, 0.1}}, {}};
  for (int value = kUnknown; value <= kOccupied; ++value) {
    grid.cells.push_back(static_cast<std::int8_t>(value));
  }
  return grid;
}

/// A grid without any symmetry.
OccupancyGrid small_map() {
  return {{3, 2, 0.05, {-1.5, 2.25, 2.5}}, {kFree, kOccupied, kUnknown, kFree, kFree, kUnknown}};
}

// --- pixels to cells -------------------------------------------------------------------------------------------------

TEST(MapPixels, FirstImageRowIsTheTopOfTheMap) {
  const OccupancyGrid grid = grid_from_image({2, 2, 1, {0, 254, 205, 205}}, description());
  EXPECT_EQ(grid.at({0, 1}), kOccupied);
  EXPECT_EQ(grid.at({1, 1}), kFree);
  EXPECT_EQ(grid.at({0, 0}), kUnknown);
  EXPECT_EQ(grid.at({1, 0}), kUnknown);
}

TEST(MapPixels, TrinaryKnowsOccupiedFreeAndUnknown) {
  // p = (255 - x) / 255; occupied above 0.65 (x < 89.25), free below 0.196 (x > 205.02).
  EXPECT_THAT(cells_of({0, 89, 90, 205, 206, 255}, 1), ElementsAre(100, 100, -1, -1, 0, 0));
}

TEST(MapPixels, NegateTurnsWhiteIntoOccupied) {
  EXPECT_THAT(cells_of({255, 166, 165, 50, 49, 0}, 1, "negate: 1\n"), ElementsAre(100, 100, -1, -1, 0, 0));
  EXPECT_THAT(cells_of({255, 0}, 1, "negate: True\n"), ElementsAre(100, 0));
}

TEST(MapPixels, AThresholdItselfIsNeitherOccupiedNorFree) {
  EXPECT_THAT(cells_of({50, 51, 52, 203, 204, 205}, 1, "occupied_thresh: 0.8\nfree_thresh: 0.2\n"),
              ElementsAre(100, -1, -1, -1, -1, 0));
}

TEST(MapPixels, ScaleCountsFrom1To99BetweenTheThresholds) {
  const std::string scale = "mode: scale\noccupied_thresh: 0.8\nfree_thresh: 0.2\n";
  EXPECT_THAT(cells_of({0, 50, 51, 127, 204, 205, 255}, 1, scale), ElementsAre(100, 100, 99, 50, 1, 0, 0));
  EXPECT_THAT(cells_of({101, 102, 103}, 1, "mode: scale\noccupied_thresh: 0.6\nfree_thresh: 0.6\n"),
              ElementsAre(100, 1, 0));
}

TEST(MapPixels, RawKeepsWhatIsAPercentage) {
  EXPECT_THAT(cells_of({0, 1, 100, 101, 205, 255}, 1, "mode: raw\n"), ElementsAre(0, 1, 100, -1, -1, -1));
}

TEST(MapPixels, ColoursAreAveraged) {
  // The mean of the first is 89.33, which is free of rounding only if it is not cut to 89.
  EXPECT_THAT(cells_of({88, 90, 90, 88, 89, 90, 255, 250, 255}, 3), ElementsAre(-1, 100, 0));
}

TEST(MapPixels, TrinaryAveragesAlphaIn) {
  EXPECT_THAT(cells_of({0, 0, 0, 255, 0, 0, 0, 0, 200, 200, 200, 255}, 4), ElementsAre(100, 100, 0));
  EXPECT_THAT(cells_of({0, 255, 40, 255, 200, 255}, 2), ElementsAre(100, -1, 0));
}

TEST(MapPixels, WhatIsNotOpaqueIsUnknownInScaleMode) {
  EXPECT_THAT(cells_of({0, 255, 0, 254, 255, 0}, 2, "mode: scale\n"), ElementsAre(100, -1, -1));
  EXPECT_THAT(cells_of({0, 0, 0, 255, 0, 0, 0, 0}, 4, "mode: scale\n"), ElementsAre(100, -1));
}

TEST(MapPixels, AnImageOfTheWrongSizeIsTheCallersFault) {
  EXPECT_THROW((void)grid_from_image({2, 2, 1, {0}}, description()), std::invalid_argument);
  EXPECT_THROW((void)grid_from_image({0, 2, 1, {}}, description()), std::invalid_argument);
  EXPECT_THROW((void)grid_from_image({1, 1, 5, {0, 0, 0, 0, 0}}, description()), std::invalid_argument);
}

// --- the description -------------------------------------------------------------------------------------------------

TEST(MapDescription, HoldsWhatTheFileSays) {
  const MapDescription map = parse_map_description(
      "image: maps/floor.png\nresolution: 5e-2\norigin: [-1.5, +2, 3.5]\nnegate: 1\noccupied_thresh: 0.7\n"
      "free_thresh: .25\nmode: Scale\n",
      "m.yaml");
  EXPECT_EQ(map.image, "maps/floor.png");
  EXPECT_EQ(map.resolution_m, 0.05);
  EXPECT_EQ(map.map_from_grid, (Pose2{-1.5, 2, 3.5}));
  EXPECT_TRUE(map.negate);
  EXPECT_EQ(map.occupied_thresh, 0.7);
  EXPECT_EQ(map.free_thresh, 0.25);
  EXPECT_EQ(map.mode, MapMode::kScale);
}

TEST(MapDescription, DefaultsStandInForWhatOldFilesLeaveOut) {
  const MapDescription map = description();
  EXPECT_FALSE(map.negate);
  EXPECT_EQ(map.occupied_thresh, 0.65);
  EXPECT_EQ(map.free_thresh, 0.196);
  EXPECT_EQ(map.mode, MapMode::kTrinary);
}

TEST(MapDescription, EveryBadValueIsNamedWithItsRule) {
  const std::vector<std::array<std::string, 3>> cases = {
      {"resolution", "0", "must be a finite number of metres above 0"},
      {"resolution", "-0.05", "must be a finite number of metres above 0"},
      {"resolution", ".nan", "must be a finite number of metres above 0"},
      {"resolution", "nan", "must be a finite number of metres above 0"},
      {"resolution", ".inf", "must be a finite number of metres above 0"},
      {"resolution", "1e999", "must be a finite number of metres above 0"},
      {"resolution", "5 cm", "must be a finite number of metres above 0"},
      {"resolution", "[1, 2]", "must be a finite number of metres above 0"},
      {"resolution", "", "must be a finite number of metres above 0"},
      {"origin", "[0, 0]", "must be three finite numbers [x, y, yaw]"},
      {"origin", "[0, 0, 0, 1]", "must be three finite numbers [x, y, yaw]"},
      {"origin", "[0, .nan, 0]", "must be three finite numbers [x, y, yaw]"},
      {"origin", "[0, 0, inf]", "must be three finite numbers [x, y, yaw]"},
      {"origin", "[0, 0, [1]]", "must be three finite numbers [x, y, yaw]"},
      {"origin", "{x: 0, y: 0, yaw: 0}", "must be three finite numbers [x, y, yaw]"},
      {"origin", "0", "must be three finite numbers [x, y, yaw]"},
      {"image", "\"\"", "must name the image file"},
      {"image", "[a.pgm]", "must name the image file"},
      {"negate", "2", "must be 0, 1, true or false"},
      {"negate", "maybe", "must be 0, 1, true or false"},
      {"mode", "binary", "must be trinary, scale or raw"},
      {"occupied_thresh", "1.1", "must be a number 0 .. 1"},
      {"occupied_thresh", "65%", "must be a number 0 .. 1"},
      {"free_thresh", "-0.1", "must be a number 0 .. 1"},
      {"free_thresh", "nan", "must be a number 0 .. 1"},
      {"free_thresh", "0.7", "must not exceed occupied_thresh = 0.65"},
  };
  for (const auto& [key, value, rule] : cases) {
    std::string yaml;
    for (const auto& [plain_key, plain_value] :
         {std::pair<std::string, std::string>{"image", "map.pgm"}, {"resolution", "0.05"}, {"origin", "[0, 0, 0]"}}) {
      yaml += plain_key == key ? "" : plain_key + ": " + plain_value + "\n";
    }
    yaml += key + ": " + value + "\n";
    EXPECT_THAT(error_of([&] { (void)parse_map_description(yaml, "m.yaml"); }),
                AllOf(StartsWith("m.yaml:"), HasSubstr(": " + key + " = "), HasSubstr(rule)))
        << yaml;
  }
}

TEST(MapDescription, ABadValueIsShownAsWritten) {
  EXPECT_EQ(error_of([] { (void)description("negate: maybe\n"); }),
            "m.yaml:4: negate = 'maybe' must be 0, 1, true or false");
  EXPECT_THAT(error_of([] { (void)parse_map_description("origin: [1, x]\n", "m.yaml"); }),
              HasSubstr("m.yaml:1: origin = [1, x] must be three finite numbers [x, y, yaw]"));
}

TEST(MapDescription, MissingUnknownAndRepeatedKeysAreToldAtOnce) {
  const std::string error = error_of(
      [] { (void)parse_map_description("resolution: 0.1\nocupied_thresh: 0.6\nresolution: 0.2\n", "m.yaml"); });
  EXPECT_THAT(error, AllOf(HasSubstr("m.yaml: key 'image' is missing"), HasSubstr("m.yaml: key 'origin' is missing"),
                           HasSubstr("m.yaml:2: unknown key 'ocupied_thresh'; known keys: image, resolution, origin, "
                                     "negate, mode, occupied_thresh, free_thresh"),
                           HasSubstr("m.yaml:3: repeated key 'resolution', first given on line 1")));
}

TEST(MapDescription, WhatIsNotYamlIsSaidSo) {
  EXPECT_THAT(error_of([] { (void)parse_map_description("P5\n2 2\n255\n\1\2\3\4", "m.yaml"); }), StartsWith("m.yaml"));
  EXPECT_THAT(error_of([] { (void)parse_map_description("a: [", "m.yaml"); }), HasSubstr("is not YAML"));
  EXPECT_THAT(error_of([] { (void)parse_map_description("", "m.yaml"); }), HasSubstr("key 'image' is missing"));
}

// --- images ----------------------------------------------------------------------------------------------------------

RasterImage decoded(const std::string& file) { return decode_image(file, "i"); }

TEST(PgmImage, PlainAndBinaryFilesReadTheSame) {
  const RasterImage image{3, 2, 1, {0, 10, 255, 7, 8, 9}};
  EXPECT_EQ(decoded("P2\n3 2\n255\n0 10 255\n7 8 9\n"), image);
  EXPECT_EQ(decoded("P2 3 2 255 0 10 255 7 8 9"), image);
  EXPECT_EQ(decoded("P5\n3 2\n255\n" + bytes({0, 10, 255, 7, 8, 9})), image);
  EXPECT_EQ(decoded(encode_pgm(image)), image);
}

TEST(PgmImage, CommentsMayStandAnywhereInTheHeader) {
  EXPECT_EQ(decoded("P5# a\n# CREATOR: someone 0.05 m/pix\n 1 # b\r2#c\n#d\n255\n" + bytes({35, 10})).samples,
            (Samples{35, 10}));
  EXPECT_EQ(decoded("P2\n2 1 255\n1 # one\n2 # two").samples, (Samples{1, 2}));
}

TEST(PgmImage, OtherDepthsAreScaledTo255) {
  EXPECT_EQ(decoded("P2 4 1 15 0 1 7 15").samples, (Samples{0, 17, 119, 255}));
  EXPECT_EQ(decoded("P5 3 1 100 " + bytes({0, 50, 100})).samples, (Samples{0, 128, 255}));
  EXPECT_EQ(decoded("P5 3 1 65535 " + bytes({0, 0, 0x80, 0, 0xff, 0xff})).samples, (Samples{0, 128, 255}));
  EXPECT_EQ(decoded("P2 3 1 65535 0 32768 65535").samples, (Samples{0, 128, 255}));
  EXPECT_EQ(decoded("P5 2 1 256 " + bytes({1, 0, 0, 128})).samples, (Samples{255, 128}));
}

TEST(PgmImage, BrokenFilesAreRefusedWithTheRule) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is empty"},
      {"P6 1 1 255 abc", "is neither a PGM (P2, P5) nor a PNG image"},
      {"BM", "is neither a PGM (P2, P5) nor a PNG image"},
      {"P5", "ends before its width"},
      {"P5 2", "ends before its height"},
      {"P5 2 2", "ends before its maxval"},
      {"P5 x 2 255 ", "width is not a number"},
      {"P5 2x 2 255 ", "width is not a number"},
      {"P5 -2 2 255 ", "width is not a number"},
      {"P5 0 2 255 ", "is 0 x 2 pixels; each side must be 1 .. 32768"},
      {"P5 99999999999999999999 2 255 ", "each side must be 1 .. 32768"},
      {"P5 32768 32768 255 ", "at most 268435456 pixels are accepted"},
      {"P5 2 2 0 abcd", "maxval is 0; it must be 1 .. 65535"},
      {"P5 2 2 65536 abcdabcd", "maxval is 65536; it must be 1 .. 65535"},
      {"P5 2 2 255 abc", "is cut off: 3 bytes of samples, 2 x 2 pixels need 4"},
      {"P5 2 1 256 abc", "is cut off: 3 bytes of samples, 2 x 1 pixels need 4"},
      {"P5 16384 16384 255 abc", "is cut off"},
      {"P2 16384 16384 255 1 2 3", "is cut off"},
      {"P2 2 1 255 300 1", "sample is 300; it must not exceed the maxval 255"},
      {"P5 2 1 100 ee", "sample is 101; it must not exceed the maxval 100"},
      {"P2 2 1 255 100 ", "ends before its last sample"},
      {"P2 2 1 255 1,2", "is not a number"},
  };
  for (const auto& [file, rule] : cases) {
    EXPECT_THAT(error_of([&] { (void)decoded(file); }), AllOf(StartsWith("i: "), HasSubstr(rule))) << file;
  }
}

TEST(PngImage, EveryKindBecomesEightBits) {
  EXPECT_EQ(decoded(file_of({.width = 2, .rows = bytes({0, 7, 200})})), (RasterImage{2, 1, 1, {7, 200}}));
  EXPECT_EQ(decoded(file_of({.width = 8, .depth = 1, .rows = bytes({0, 0xa0})})).samples,
            (Samples{255, 0, 255, 0, 0, 0, 0, 0}));
  EXPECT_EQ(decoded(file_of({.width = 2, .depth = 4, .rows = bytes({0, 0x1f})})).samples, (Samples{17, 255}));
  EXPECT_EQ(decoded(file_of({.width = 2, .depth = 16, .rows = bytes({0, 0x80, 0x80, 0xff, 0x7e})})).samples,
            (Samples{128, 254}));
  EXPECT_EQ(decoded(file_of({.colour_type = 4, .rows = bytes({0, 9, 100})})), (RasterImage{1, 1, 2, {9, 100}}));
  EXPECT_EQ(decoded(file_of({.colour_type = 2, .rows = bytes({0, 1, 2, 3})})), (RasterImage{1, 1, 3, {1, 2, 3}}));
  EXPECT_EQ(decoded(file_of({.colour_type = 6, .rows = bytes({0, 1, 2, 3, 4})})), (RasterImage{1, 1, 4, {1, 2, 3, 4}}));
}

TEST(PngImage, APaletteBecomesColoursAndATransparentColourAlpha) {
  const std::string palette = chunk("PLTE", bytes({10, 20, 30, 40, 50, 60}));
  EXPECT_EQ(decoded(file_of({.width = 2, .colour_type = 3, .rows = bytes({0, 1, 0}), .chunks = palette})),
            (RasterImage{2, 1, 3, {40, 50, 60, 10, 20, 30}}));
  EXPECT_EQ(decoded(file_of({.colour_type = 3, .rows = bytes({0, 0}), .chunks = palette + chunk("tRNS", bytes({77}))})),
            (RasterImage{1, 1, 4, {10, 20, 30, 77}}));
  EXPECT_EQ(decoded(file_of({.width = 2, .rows = bytes({0, 5, 6}), .chunks = chunk("tRNS", bytes({0, 5}))})),
            (RasterImage{2, 1, 2, {5, 0, 6, 255}}));
}

TEST(PngImage, GammaIsLeftAlone) {
  EXPECT_EQ(decoded(file_of({.rows = bytes({0, 100}), .chunks = chunk("gAMA", number32(100000))})).samples,
            (Samples{100}));
}

TEST(PngImage, InterlacedFilesAreRead) {
  EXPECT_EQ(decoded(file_of({.width = 2, .rows = bytes({0, 3, 0, 4}), .interlace = 1})),
            (RasterImage{2, 1, 1, {3, 4}}));
}

TEST(PngImage, BrokenFilesAreRefusedWithTheRule) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {file_of({.width = 40000, .rows = ""}), "is 40000 x 1 pixels; each side must be 1 .. 32768"},
      {file_of({.width = 4000000, .rows = ""}), "each side must be 1 .. 32768"},
      {file_of({.width = 32768, .height = 32768, .rows = ""}), "at most 268435456 pixels are accepted"},
      {file_of({.width = 16384, .height = 16384, .rows = ""}), "bytes cannot hold 16384 x 16384 pixels"},
      {file_of({.width = 0, .rows = ""}), "PNG cannot be read"},
      {file_of({.width = 3, .height = 3, .rows = bytes({0, 1, 2, 3})}), "PNG cannot be read"},
      {file_of({.depth = 3, .rows = ""}), "PNG cannot be read"},
      {file_of({.colour_type = 3, .rows = bytes({0, 0})}), "PNG cannot be read"},
  };
  for (const auto& [file, rule] : cases) {
    EXPECT_THAT(error_of([&] { (void)decoded(file); }), AllOf(StartsWith("i: "), HasSubstr(rule)));
  }
}

TEST(PngImage, EveryKindReadsBackTheSame) {
  for (int channels = 1; channels <= 4; ++channels) {
    RasterImage image{7, 5, channels, {}};
    for (int i = 0; i < 35 * channels; ++i) {
      image.samples.push_back(static_cast<std::uint8_t>(37 * i));
    }
    EXPECT_EQ(decoded(encode_png(image)), image);
  }
}

TEST(Images, LimitsAreTheCallers) {
  EXPECT_THAT(error_of([] { (void)decode_image("P5 5 1 255 abcde", "i", {.max_side_cells = 4}); }),
              HasSubstr("each side must be 1 .. 4"));
  EXPECT_THAT(error_of([] { (void)decode_image("P5 2 2 255 abcd", "i", {.max_cells = 3}); }),
              HasSubstr("is 2 x 2 pixels; at most 3 pixels are accepted"));
}

TEST(Images, CutOffAnywhereIsAnErrorAndNoCrash) {
  const RasterImage image{5, 4, 1, Samples(20, 205)};
  for (const std::string& file : {encode_png(image), encode_pgm(image), file_of({.rows = bytes({0, 3})})}) {
    for (std::size_t size = 0; size < file.size(); ++size) {
      EXPECT_THAT(error_of([&] { (void)decoded(file.substr(0, size)); }), StartsWith("i: ")) << size;
    }
  }
  const std::string plain = "P2 # c\n3 2 255\n1 2 3\n4 5 67";
  for (std::size_t size = 0; size + 1 < plain.size(); ++size) {
    EXPECT_THAT(error_of([&] { (void)decoded(plain.substr(0, size)); }), StartsWith("i: ")) << size;
  }
}

TEST(Images, AnyBitFlippedIsReadOrRefused) {
  for (const std::string& file : {encode_png({5, 4, 1, Samples(20, 205)}), encode_pgm({5, 4, 1, Samples(20, 205)}),
                                  std::string("P2 # c\n3 2 255\n1 2 3\n4 5 67")}) {
    for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
      std::string flipped = file;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
      (void)error_of([&] { check_image(decoded(flipped)); });
    }
  }
}

// --- files -----------------------------------------------------------------------------------------------------------

TEST(ReadMap, FindsTheImageBesideTheYaml) {
  const TempFolder folder;
  fs::create_directory(folder / "images");
  folder.put("images/map.pgm", "P5 2 1 255 " + bytes({0, 254}));
  const fs::path yaml = folder.put("m.yaml", "image: images/map.pgm\nresolution: 0.1\norigin: [1, 2, 3]\n");
  EXPECT_EQ(read_map(yaml), (OccupancyGrid{{2, 1, 0.1, {1, 2, 3}}, {100, 0}}));
  const fs::path absolute =
      folder.put("a.yaml", "image: " + (folder / "images/map.pgm").string() + "\nresolution: 0.1\norigin: [1, 2, 3]\n");
  EXPECT_EQ(read_map(absolute), read_map(yaml));
}

TEST(ReadMap, NamesTheFileThatIsWrong) {
  const TempFolder folder;
  const std::string none = (folder / "none.yaml").string();
  EXPECT_EQ(error_of([&] { (void)read_map(none); }), none + ": does not exist");
  const std::string self = (folder / ".").string();
  EXPECT_EQ(error_of([&] { (void)read_map(self); }), self + ": is a directory, not a file");
  const std::string yaml = folder.put("m.yaml", kPlainYaml).string();
  const std::string image = (folder / "map.pgm").string();
  EXPECT_EQ(error_of([&] { (void)read_map(yaml); }), yaml + ": image = 'map.pgm': " + image + ": does not exist");
  folder.put("map.pgm", "P5 2 2 255 abc");
  EXPECT_THAT(error_of([&] { (void)read_map(yaml); }),
              StartsWith(yaml + ": image = 'map.pgm': " + image + ": PGM is cut off"));
}

TEST(ReadMap, RefusesFilesThatAreTooLongUnread) {
  const TempFolder folder;
  const fs::path yaml = folder.put("m.yaml", kPlainYaml);
  fs::resize_file(yaml, std::uintmax_t{1} << 40);
  EXPECT_THAT(error_of([&] { (void)read_map(yaml); }), HasSubstr("bytes long; at most 1048576 are accepted"));
}

TEST(WriteMap, EveryModeAndFormatReadsBackTheSame) {
  const TempFolder folder;
  for (const MapMode mode : {MapMode::kTrinary, MapMode::kScale, MapMode::kRaw}) {
    for (const ImageFormat format : {ImageFormat::kPgm, ImageFormat::kPng}) {
      if (mode == MapMode::kScale && format == ImageFormat::kPgm) {
        continue;
      }
      write_map(small_map(), folder / "m.yaml", {mode, format});
      EXPECT_EQ(read_map(folder / "m.yaml"), small_map());
      if (mode != MapMode::kTrinary) {
        write_map(every_value(), folder / "m.yaml", {mode, format});
        EXPECT_EQ(read_map(folder / "m.yaml"), every_value());
      }
    }
  }
  EXPECT_THAT(folder.names(), UnorderedElementsAre("m.yaml", "m.pgm", "m.png"));
}

TEST(WriteMap, WritesWhatMapServerAndNav2Know) {
  const TempFolder folder;
  write_map(small_map(), folder / "m.yaml");
  EXPECT_EQ(content_of(folder / "m.yaml"),
            "image: m.pgm\nmode: trinary\nresolution: 0.05\norigin: [-1.5, 2.25, 2.5]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(content_of(folder / "m.pgm"), "P5\n3 2\n255\n" + bytes({254, 254, 205, 254, 0, 205}));
}

TEST(WriteMap, TrinaryKeepsAProbabilityOnlyAsFreeOccupiedOrUnknown) {
  const TempFolder folder;
  const OccupancyGrid grid{{4, 1, 0.05, {}}, {19, 20, 64, 65}};
  write_map(grid, folder / "m.yaml");
  EXPECT_THAT(read_map(folder / "m.yaml").cells, ElementsAre(0, -1, -1, 100));
}

TEST(WriteMap, ScaleShowsTheProbabilityAsDarkness) {
  const TempFolder folder;
  write_map(every_value(), folder / "m.yaml", {MapMode::kScale, ImageFormat::kPng});
  const RasterImage image = decode_image(content_of(folder / "m.png"), "m.png");
  for (std::size_t value = 0; value <= 100; ++value) {
    const std::uint8_t* pixel = &image.samples[4 * (value + 1)];
    EXPECT_NEAR(100 * (255 - pixel[0]) / 255.0, static_cast<double>(value), 1.0);
    EXPECT_EQ(pixel[3], 255);
  }
  EXPECT_EQ(image.samples[3], 0) << "unknown is transparent";
}

TEST(WriteMap, OddNamesSurvive) {
  const TempFolder folder;
  for (const std::string name : {"a: b #1", "true", "12", "h\u00f6lder \"x\""}) {
    write_map(small_map(), folder / (name + ".yaml"));
    EXPECT_EQ(read_map(folder / (name + ".yaml")), small_map());
  }
}

TEST(WriteMap, LeavesNothingBehindWhenItFails) {
  const TempFolder folder;
  const std::string missing = (folder / "none/m.yaml").string();
  EXPECT_THAT(error_of([&] { write_map(small_map(), missing); }), HasSubstr("none/m.pgm: cannot be written: "));
  const fs::path file = folder.put("file", "");
  EXPECT_THAT(error_of([&] { write_map(small_map(), file / "m.yaml"); }), HasSubstr("cannot be written: "));
  fs::create_directory(folder / "taken.yaml");
  EXPECT_THAT(error_of([&] { write_map(small_map(), folder / "taken.yaml"); }),
              HasSubstr("taken.yaml: cannot be written: a directory has this name"));
  EXPECT_THAT(error_of([&] { write_map(small_map(), folder / "m.pgm"); }), HasSubstr("name the map's YAML file"));
  EXPECT_THAT(folder.names(), UnorderedElementsAre("file", "taken.yaml"));
}

TEST(WriteMap, LeavesNothingBehindInAFolderThatIsReadOnly) {
  const TempFolder folder;
  fs::permissions(folder / ".", fs::perms{0555});
  constexpr uid_t kNobody = 65534;
  const bool is_root = geteuid() == 0;
  if (is_root && seteuid(kNobody) != 0) {
    GTEST_SKIP() << "this user may write everywhere";
  }
  const std::string error = error_of([&] { write_map(small_map(), folder / "m.yaml"); });
  EXPECT_EQ(is_root ? seteuid(0) : 0, 0);
  fs::permissions(folder / ".", fs::perms::owner_all);
  EXPECT_THAT(error, HasSubstr("m.pgm: cannot be written: Permission denied"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WriteMap, AFullDiskKeepsTheOldMap) {
  const TempFolder folder;
  write_map(small_map(), folder / "m.yaml");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] { write_map(unknown_grid({100, 100, 0.05, {}}), folder / "m.yaml"); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(error, HasSubstr("m.pgm: cannot be written: File too large"));
  EXPECT_EQ(read_map(folder / "m.yaml"), small_map());
  EXPECT_THAT(folder.names(), UnorderedElementsAre("m.yaml", "m.pgm"));
}

TEST(WriteMap, WhatNoFileCanHoldIsTheCallersFault) {
  const TempFolder folder;
  EXPECT_THROW(write_map(small_map(), folder / "m.yaml", {MapMode::kScale, ImageFormat::kPgm}), std::invalid_argument);
  EXPECT_THROW(write_map(unknown_grid({0, 0, 0.05, {}}), folder / "m.yaml"), std::invalid_argument);
  EXPECT_THROW(write_map({{2, 2, 0.05, {}}, {0}}, folder / "m.yaml"), std::invalid_argument);
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WholeFiles, NothingStandsBeforeCommitAndNothingStaysWithoutIt) {
  const TempFolder folder;
  {
    WholeFiles files;
    files.stage(folder / "a", "1");
    EXPECT_FALSE(fs::exists(folder / "a"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(WholeFiles, CommitReplacesWhatWasThere) {
  const TempFolder folder;
  folder.put("a", "old");
  WholeFiles files;
  files.stage(folder / "a", "new");
  files.stage(folder / "b", "");
  EXPECT_EQ(content_of(folder / "a"), "old");
  files.commit();
  EXPECT_EQ(content_of(folder / "a"), "new");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a", "b"));
}

TEST(WholeFiles, AFailingCommitPutsBackWhatWasThere) {
  const TempFolder folder;
  folder.put("a", "old");
  {
    WholeFiles files;
    files.stage(folder / "a", "new");
    files.stage(folder / "b", "new");
    files.stage(folder / "c", "new");
    fs::create_directory(folder / "c");
    folder.put("c/in the way", "");
    EXPECT_THAT(error_of([&] { files.commit(); }), HasSubstr("c: cannot be written: a directory has this name"));
  }
  EXPECT_EQ(content_of(folder / "a"), "old");
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a", "c"));
}

TEST(WholeFiles, FilesLeftByAKilledProgramAreNoHindrance) {
  const TempFolder folder;
  folder.put("a.partial0", "left");
  write_whole_file(folder / "a", "new");
  EXPECT_EQ(content_of(folder / "a"), "new");
}

TEST(WholeFiles, ManyWritersOfOneFileDoNotDisturbEachOther) {
  const TempFolder folder;
  const auto write_often = [&] {
    for (int i = 0; i < 200; ++i) {
      try {
        write_whole_file(folder / "a", "new");
      } catch (const InputError& error) {
        ADD_FAILURE() << error.what();
      }
    }
  };
  {
    std::vector<std::jthread> writers;
    for (int i = 0; i < 4; ++i) {
      writers.emplace_back(write_often);
    }
  }
  EXPECT_THAT(folder.names(), UnorderedElementsAre("a"));
}

}  // namespace
}  // namespace gridmerge
