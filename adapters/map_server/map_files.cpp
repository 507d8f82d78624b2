#include "map_server/map_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <vector>

#include "config/read_file.hpp"
#include "config/yaml_text.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"

namespace gridmerge {
namespace {

// --- the YAML description --------------------------------------------------------------------------------------------

constexpr std::array<const char*, 3> kModeNames = {"trinary", "scale", "raw"};  // in the order of MapMode

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> keys = {"image", "resolution",      "origin",     "negate",
                                                "mode",  "occupied_thresh", "free_thresh"};
  return keys;
}

std::optional<double> finite_number(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) {
    return std::nullopt;
  }
  return number;
}

/// The value as a message shows it.
std::string shown(const YamlEntry& entry) {
  if (entry.children.empty()) {
    return "'" + entry.text + "'";
  }
  std::string list;
  for (const YamlEntry& child : entry.children) {
    list += list.empty() ? "[" : ", ";
    list += child.text;
  }
  return list + "]";
}

/// Reads the entries of one description, and collects what is wrong with them.
class DescriptionReader {
 public:
  DescriptionReader(std::string_view yaml, const std::string& name)
      : entries_(parse_yaml_mapping(yaml, name)), problems_(name) {
    problems_.add_repeated_keys(entries_);
    for (const YamlEntry& entry : entries_) {
      if (std::find(known_keys().begin(), known_keys().end(), entry.key) == known_keys().end()) {
        problems_.add_unknown_key(entry, known_keys());
      }
    }
  }

  MapDescription read() {
    MapDescription map;
    if (const YamlEntry* entry = required("image"); entry != nullptr) {
      map.image = entry->text;
      demand(!map.image.empty(), *entry, "must name the image file");
    }
    if (const YamlEntry* entry = required("resolution"); entry != nullptr) {
      map.resolution_m = finite_number(entry->text).value_or(0);
      demand(map.resolution_m > 0, *entry, "must be a finite number of metres above 0");
    }
    if (const YamlEntry* entry = required("origin"); entry != nullptr) {
      map.map_from_grid = origin(*entry);
    }
    if (const YamlEntry* entry = find_entry(entries_, "negate"); entry != nullptr) {
      const std::string text = lower_case(entry->text);
      map.negate = text == "1" || text == "true";
      demand(map.negate || text == "0" || text == "false", *entry, "must be 0, 1, true or false");
    }
    if (const YamlEntry* entry = find_entry(entries_, "mode"); entry != nullptr) {
      const auto mode = std::find(kModeNames.begin(), kModeNames.end(), lower_case(entry->text));
      const bool is_mode = mode != kModeNames.end();
      demand(is_mode, *entry, "must be trinary, scale or raw");
      map.mode = is_mode ? static_cast<MapMode>(mode - kModeNames.begin()) : map.mode;
    }
    map.occupied_thresh = share("occupied_thresh", map.occupied_thresh);
    map.free_thresh = share("free_thresh", map.free_thresh);
    if (map.free_thresh > map.occupied_thresh) {
      const YamlEntry* entry = find_entry(entries_, "free_thresh");
      entry = entry != nullptr ? entry : find_entry(entries_, "occupied_thresh");
      problems_.add(entry->line, "free_thresh = " + exact(map.free_thresh) +
                                     " must not exceed occupied_thresh = " + exact(map.occupied_thresh));
    }
    problems_.throw_if_any();
    return map;
  }

 private:
  const YamlEntry* required(const std::string& key) {
    const YamlEntry* entry = find_entry(entries_, key);
    if (entry == nullptr) {
      problems_.add(0, "key '" + key + "' is missing");
    }
    return entry;
  }

  void demand(bool holds, const YamlEntry& entry, const std::string& rule) {
    if (!holds) {
      problems_.add(entry.line, entry.key + " = " + shown(entry) + " " + rule);
    }
  }

  Pose2 origin(const YamlEntry& entry) {
    std::vector<double> numbers;
    for (const YamlEntry& child : entry.children) {
      numbers.push_back(finite_number(child.text).value_or(std::nan("")));
    }
    const auto is_number = [](double number) { return !std::isnan(number); };
    const bool is_pose = entry.kind == YamlEntry::Kind::kSequence && numbers.size() == 3 &&
                         std::all_of(numbers.begin(), numbers.end(), is_number);
    demand(is_pose, entry, "must be three finite numbers [x, y, yaw]");
    return is_pose ? Pose2{numbers[0], numbers[1], numbers[2]} : Pose2{};
  }

  double share(const std::string& key, double otherwise) {
    const YamlEntry* entry = find_entry(entries_, key);
    if (entry == nullptr) {
      return otherwise;
    }
    const double number = finite_number(entry->text).value_or(-1);
    const bool is_share = number >= 0 && number <= 1;
    demand(is_share, *entry, "must be a number 0 .. 1");
    return is_share ? number : otherwise;
  }

  std::vector<YamlEntry> entries_;
  FileProblems problems_;
};

std::string yaml_text(const MapDescription& map) {
  const Pose2& origin = map.map_from_grid;
  return "image: " + yaml_word(map.image) + "\nmode: " + kModeNames[static_cast<std::size_t>(map.mode)] +
         "\nresolution: " + exact(map.resolution_m) + "\norigin: [" + exact(origin.x_m) + ", " + exact(origin.y_m) +
         ", " + exact(origin.theta_rad) + "]\nnegate: " + (map.negate ? "1" : "0") +
         "\noccupied_thresh: " + exact(map.occupied_thresh) + "\nfree_thresh: " + exact(map.free_thresh) + "\n";
}

// --- pixels and cells ------------------------------------------------------------------------------------------------

/// map_server's arithmetic, step by step, for the mean of a pixel's channels.
std::int8_t cell_of(double mean, const MapDescription& map) {
  const double shade = map.negate ? 255 - mean : mean;
  if (map.mode == MapMode::kRaw) {
    return shade <= kOccupied ? static_cast<std::int8_t>(shade) : kUnknown;
  }
  const double p = (255 - shade) / 255;
  if (p > map.occupied_thresh) {
    return kOccupied;
  }
  if (p < map.free_thresh) {
    return kFree;
  }
  if (map.mode == MapMode::kTrinary) {
    return kUnknown;
  }
  const double span = map.occupied_thresh - map.free_thresh;
  return static_cast<std::int8_t>(1 + 98 * (span > 0 ? (p - map.free_thresh) / span : 0));
}

/// The cell for each sum that `channels` averaged channels can have.
std::vector<std::int8_t> cells_by_sum(int channels, const MapDescription& map) {
  std::vector<std::int8_t> cells(static_cast<std::size_t>(255 * channels) + 1);
  for (std::size_t sum = 0; sum < cells.size(); ++sum) {
    cells[sum] = cell_of(static_cast<double>(sum) / channels, map);
  }
  return cells;
}

/// Turns `count` pixels into cells.
class PixelConverter {
 public:
  PixelConverter(int channels, const MapDescription& map)
      : channels_(static_cast<std::size_t>(channels)),
        has_alpha_(channels % 2 == 0),
        averages_alpha_(has_alpha_ && map.mode == MapMode::kTrinary),
        needs_opaque_(has_alpha_ && map.mode == MapMode::kScale),
        cell_of_sum_(cells_by_sum(averages_alpha_ ? 4 : (channels < 3 ? 1 : 3), map)) {}

  void convert(const std::uint8_t* pixel, std::size_t count, std::int8_t* cell) const {
    if (channels_ == 1) {
      std::transform(pixel, pixel + count, cell, [&](std::uint8_t gray) { return cell_of_sum_[gray]; });
      return;
    }
    for (const auto* end = cell + count; cell != end; ++cell, pixel += channels_) {
      *cell = needs_opaque_ && pixel[channels_ - 1] != 255 ? kUnknown : cell_of_sum_[sum(pixel)];
    }
  }

 private:
  /// In trinary mode map_server averages alpha in, as a fourth channel; gray counts as red, green and blue then.
  std::size_t sum(const std::uint8_t* pixel) const {
    const auto alpha = averages_alpha_ ? std::size_t{pixel[channels_ - 1]} : 0;
    if (channels_ == 2) {
      return averages_alpha_ ? std::size_t{3} * pixel[0] + alpha : pixel[0];
    }
    return std::size_t{pixel[0]} + pixel[1] + pixel[2] + alpha;
  }

  std::size_t channels_;
  bool has_alpha_;
  bool averages_alpha_;
  bool needs_opaque_;
  std::vector<std::int8_t> cell_of_sum_;
};

/// The thresholds of the files that we write. kScale spends one pixel value on each end, so that all others are left
/// for 1 .. 99.
MapDescription description_for(MapMode mode, const GridGeometry& geometry, std::string image) {
  MapDescription map{.image = std::move(image),
                     .resolution_m = geometry.resolution_m,
                     .map_from_grid = geometry.map_from_grid,
                     .mode = mode};
  if (mode == MapMode::kScale) {
    map.free_thresh = 1 / 255.0;
    map.occupied_thresh = 254 / 255.0;
  }
  return map;
}

/// The gray value to write for a known cell.
std::uint8_t gray_for(int cell, const MapDescription& map) {
  if (map.mode == MapMode::kRaw) {
    return static_cast<std::uint8_t>(cell);
  }
  if (map.mode == MapMode::kTrinary) {
    const bool is_occupied = cell >= 100 * map.occupied_thresh;
    const bool is_free = cell < 100 * map.free_thresh;
    return is_occupied ? 0 : (is_free ? 254 : 205);
  }
  // Of the gray values that read back as this cell, the one whose darkness says so best.
  const auto misfit = [&](int gray) {
    return (cell_of(gray, map) == cell ? 0 : 1000) + std::abs(100 * (255 - gray) / 255.0 - cell);
  };
  int best = 0;
  for (int gray = 1; gray <= 255; ++gray) {
    best = misfit(gray) < misfit(best) ? gray : best;
  }
  return static_cast<std::uint8_t>(best);
}

RasterImage image_from_grid(const OccupancyGrid& grid, const MapDescription& map) {
  using Pixel = std::array<std::uint8_t, 4>;
  std::array<Pixel, kOccupied - kUnknown + 1> pixel_for;
  const std::uint8_t unknown = map.mode == MapMode::kTrinary ? 205 : (map.mode == MapMode::kScale ? 128 : 255);
  pixel_for[0] = {unknown, unknown, unknown, 0};
  for (int cell = kFree; cell <= kOccupied; ++cell) {
    const std::uint8_t gray = gray_for(cell, map);
    pixel_for[static_cast<std::size_t>(cell - kUnknown)] = {gray, gray, gray, 255};
  }

  const GridGeometry& geometry = grid.geometry;
  const auto width = static_cast<std::size_t>(geometry.width);
  RasterImage image{geometry.width, geometry.height, map.mode == MapMode::kScale ? 4 : 1, {}};
  const auto channels = static_cast<std::size_t>(image.channels);
  image.samples.resize(geometry.cell_count() * channels);
  std::uint8_t* out = image.samples.data();
  for (int row = geometry.height - 1; row >= 0; --row) {
    const std::int8_t* cell = grid.cells.data() + geometry.offset({0, row});
    for (std::size_t column = 0; column < width; ++column, out += channels) {
      std::copy_n(pixel_for[static_cast<std::size_t>(cell[column] - kUnknown)].begin(), channels, out);
    }
  }
  return image;
}

std::uintmax_t max_image_bytes(const MapLimits& limits) {
  constexpr std::uintmax_t kPlainSampleBytes = 8;  // " 65535" and some white space
  constexpr std::uintmax_t kHeaderBytes = 1 << 20;
  return kPlainSampleBytes * static_cast<std::uintmax_t>(limits.max_cells) + kHeaderBytes;
}

}  // namespace

MapDescription parse_map_description(std::string_view yaml, const std::string& name) {
  return DescriptionReader(yaml, name).read();
}

OccupancyGrid grid_from_image(const RasterImage& image, const MapDescription& description) {
  check_image(image);
  const PixelConverter converter(image.channels, description);
  const auto width = static_cast<std::size_t>(image.width);
  OccupancyGrid grid{{image.width, image.height, description.resolution_m, description.map_from_grid}, {}};
  grid.cells.resize(grid.geometry.cell_count());
  const std::uint8_t* pixels = image.samples.data();
  for (int row = image.height - 1; row >= 0; --row) {
    converter.convert(pixels, width, grid.cells.data() + grid.geometry.offset({0, row}));
    pixels += width * static_cast<std::size_t>(image.channels);
  }
  return grid;
}

OccupancyGrid read_map(const std::filesystem::path& yaml, const MapLimits& limits) {
  const MapDescription map = parse_map_description(read_file(yaml, kMaxYamlBytes), yaml.string());
  const std::filesystem::path image = yaml.parent_path() / map.image;
  try {
    return grid_from_image(decode_image(read_file(image, max_image_bytes(limits)), image.string(), limits), map);
  } catch (const InputError& error) {
    throw InputError(yaml.string(), "image = '" + map.image + "': " + error.what());
  }
}

void stage_map(WholeFiles& files, const OccupancyGrid& grid, const std::filesystem::path& yaml,
               const WriteOptions& options) {
  check_grid(grid);
  if (options.mode == MapMode::kScale && options.format == ImageFormat::kPgm) {
    throw std::invalid_argument("a map in scale mode marks unknown cells by transparency, which PGM cannot hold");
  }
  std::filesystem::path image = yaml;
  image.replace_extension(options.format == ImageFormat::kPgm ? ".pgm" : ".png");
  if (image == yaml) {
    throw InputError(yaml.string(), "is the name of the image; name the map's YAML file");
  }
  const MapDescription map = description_for(options.mode, grid.geometry, image.filename().string());
  const RasterImage pixels = image_from_grid(grid, map);
  files.stage(image, options.format == ImageFormat::kPgm ? encode_pgm(pixels) : encode_png(pixels));
  files.stage(yaml, yaml_text(map));
}

void write_map(const OccupancyGrid& grid, const std::filesystem::path& yaml, const WriteOptions& options) {
  WholeFiles files;
  stage_map(files, grid, yaml, options);
  files.commit();
}

}  // namespace gridmerge
