#include "manifest/carpin.hpp"

#include <algorithm>
#include <charconv>

#include "config/read_file.hpp"
#include "config/yaml_text.hpp"
#include "gridmerge/base/error.hpp"
#include "manifest/csv_table.hpp"
#include "manifest/folder_entries.hpp"
#include "manifest/known_area.hpp"
#include "manifest/problem_list.hpp"
#include "map_server/raster_image.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 30;
constexpr int kMostProblems = 10;  ///< of one file

/// The table as it is read, the top row first.
class Table {
 public:
  Table(const std::string& name, bool nearest) : name_(name), problems_(name), nearest_(nearest) {}

  void add_line(std::string_view line) {
    ++line_;
    const std::size_t before = cells_.size();
    int column = 0;
    for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
      add_word(line.substr(at, end - at), ++column);
      at = line.find_first_not_of(kBlanks, end);
    }
    const std::size_t added = cells_.size() - before;
    if (added == 0) {
      return;
    }
    width_ = rows_ == 0 ? added : width_;
    ++rows_;
    if (added != width_) {
      add_problem("has " + std::to_string(added) + " numbers, the first row has " + std::to_string(width_));
    }
    check_size();
  }

  OccupancyGrid grid(double resolution_m) {
    problems_.throw_if_any();
    if (rows_ == 0) {
      throw InputError(name_, "holds no number");
    }
    OccupancyGrid map = unknown_grid({.width = static_cast<int>(width_),
                                      .height = static_cast<int>(rows_),
                                      .resolution_m = resolution_m,
                                      .map_from_grid = {}});
    for (std::size_t row = 0; row < rows_; ++row) {
      const auto from = cells_.begin() + static_cast<std::ptrdiff_t>((rows_ - 1 - row) * width_);
      std::copy(from, from + static_cast<std::ptrdiff_t>(width_),
                map.cells.begin() + static_cast<std::ptrdiff_t>(row * width_));
    }
    return map;
  }

 private:
  static constexpr const char* kBlanks = " \t\r";

  void add_word(std::string_view word, int column) {
    int value = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool number = error == std::errc{} && end == word.data() + word.size() && value >= 0 && value <= 255;
    if (!number || (!nearest_ && value != 0 && value != 127 && value != 255)) {
      add_problem("number " + std::to_string(column) + ": '" + std::string(word.substr(0, 20)) + "' is none of " +
                  (nearest_ ? "0..255" : "0 (occupied), 127 (unknown), 255 (free)"));
    }
    cells_.push_back(value < 64 ? kOccupied : value < 191 ? kUnknown : kFree);
  }

  void add_problem(const std::string& problem) {
    if (++found_ <= kMostProblems) {
      problems_.add(line_, problem);
    }
    if (found_ > kMostProblems) {
      problems_.throw_if_any();
    }
  }

  void check_size() {
    const MapLimits limits;
    const auto most = static_cast<std::size_t>(limits.max_side_cells);
    if (width_ > most || rows_ > most || cells_.size() > static_cast<std::size_t>(limits.max_cells)) {
      throw InputError(name_, "has more than " + std::to_string(most) + " cells a side, or too many");
    }
  }

  std::string name_;
  FileProblems problems_;
  bool nearest_;
  int line_ = 0;
  int found_ = 0;
  std::size_t width_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::int8_t> cells_;
};

bool begins_with_number(std::string_view text) {
  const std::size_t at = text.find_first_not_of(" \t\r\n");
  return at != std::string_view::npos && text[at] >= '0' && text[at] <= '9';
}

std::vector<fs::path> text_files(const fs::path& path) {
  if (fs::is_regular_file(path)) {
    return {path};
  }
  if (!fs::is_directory(path)) {
    throw InputError(path.string(), "is neither a folder nor a file");
  }
  return folder_entries(path, {".txt"});
}

std::vector<NamedGrid> read_grids(const fs::path& path, const CarpinOptions& options, Conversion& result) {
  std::vector<NamedGrid> maps;
  ProblemList problems;
  for (const fs::path& file : text_files(path)) {
    problems.collect([&] {
      const std::string text = read_file(file, kMaxBytes);
      if (!begins_with_number(text) && fs::is_directory(path)) {
        result.left_out.push_back(file.string() + ": does not begin with a number");
        return;
      }
      OccupancyGrid grid = parse_carpin(text, file.string(), options);
      const Point2 centre = centre_of_known(grid);
      maps.push_back({.name = file.stem().string(), .grid = std::move(grid), .centre = centre});
    });
  }
  problems.throw_if_any();
  if (maps.empty()) {
    throw InputError(path.string(), "holds no grid: no .txt file that begins with a number");
  }
  return maps;
}

const NamedGrid& grid_named(const CsvRow& row, const char* column, const std::vector<NamedGrid>& maps) {
  const std::string yaml = row.text(column);
  const auto map =
      std::find_if(maps.begin(), maps.end(), [&](const NamedGrid& each) { return each.name + ".yaml" == yaml; });
  if (map == maps.end()) {
    throw InputError(row.where(), std::string(column) + ": there is no grid for '" + yaml + "'");
  }
  return *map;
}

std::vector<ManifestPair> told_pairs(const fs::path& csv, const std::vector<NamedGrid>& maps) {
  std::vector<ManifestPair> pairs;
  if (!fs::exists(csv)) {
    return pairs;
  }
  ProblemList problems;
  const std::vector<CsvRow> rows = read_csv(csv);
  const std::vector<ManifestPair> told = read_manifest(csv);
  for (std::size_t i = 0; i < told.size(); ++i) {
    problems.collect([&] {
      const NamedGrid& target = grid_named(rows[i], "a", maps);
      const NamedGrid& source = grid_named(rows[i], "b", maps);
      pairs.push_back(pair_of(told[i].set, target, source, told[i].truth, told[i].tags));
    });
  }
  problems.throw_if_any();
  return pairs;
}

}  // namespace

void CarpinOptions::describe(OptionList& list) {
  list.add("resolution_m", resolution_m, 0.001, 10,
           {"m", "Side of a cell.", "The data do not tell it; what a pose means in metres hangs on it."});
  list.add("nearest", nearest,
           {"", "Whether numbers other than 0, 127 and 255 are taken for the nearest of them.",
            "For maps that a program has turned: by default they are refused."});
}

OccupancyGrid parse_carpin(std::string_view text, const std::string& name, const CarpinOptions& options) {
  require_valid(options, "parse_carpin");
  Table table(name, options.nearest);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    table.add_line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return table.grid(options.resolution_m);
}

Conversion convert_carpin(const fs::path& path, const fs::path& out, const CarpinOptions& options) {
  check_output_folder(path, out);
  Conversion result;
  const std::vector<NamedGrid> maps = read_grids(path, options, result);
  const std::vector<ManifestPair> pairs =
      told_pairs((fs::is_directory(path) ? path : path.parent_path()) / "pairs.csv", maps);
  write_conversion(out, maps, pairs);
  result.maps = maps.size();
  result.pairs = pairs.size();
  return result;
}

}  // namespace gridmerge
