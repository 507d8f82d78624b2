#include "manifest/halmstad.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "config/read_file.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/folder_entries.hpp"
#include "manifest/halmstad_annotations.hpp"
#include "manifest/known_area.hpp"
#include "manifest/problem_list.hpp"
#include "map_server/raster_image.hpp"
#include "worlds/point_fit.hpp"

namespace gridmerge {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxImageBytes = std::uintmax_t{1} << 28;

/// A picture of the repository, and what is known of it.
struct Picture {
  std::string name;
  std::string building;
  bool is_layout = false;
  fs::path file;
  std::vector<Point2> points;  ///< marked in it, in pixels
  bool usable = true;
  NamedGrid map;
};

/// The points that two pictures share.
struct Shared {
  std::size_t target = 0;
  std::size_t source = 0;
  std::vector<PointMatch> matches;  ///< in pixels
};

// --- reading ---------------------------------------------------------------------------------------------------------

std::vector<fs::path> pictures_in(const fs::path& folder) {
  return fs::is_directory(folder) ? folder_entries(folder, {".png"}) : std::vector<fs::path>();
}

std::vector<Picture> list_pictures(const fs::path& root) {
  for (const char* needed : {"maps", "annotations"}) {
    if (!fs::is_directory(root / needed)) {
      throw InputError(root.string(),
                       std::string("has no folder ") + needed + ": it must be a clone of Halmstad-Robot-Maps");
    }
  }
  std::vector<Picture> pictures;
  for (const fs::path& building : folder_entries(root / "maps")) {
    for (const bool is_layout : {false, true}) {
      for (const fs::path& file : pictures_in(building / (is_layout ? "layout" : "pseudo_occupancy"))) {
        pictures.push_back({.name = file.stem().string(),
                            .building = building.filename().string(),
                            .is_layout = is_layout,
                            .file = file,
                            .points = {},
                            .map = {}});
      }
    }
  }
  if (pictures.empty()) {
    throw InputError((root / "maps").string(), "holds no BUILDING/pseudo_occupancy/*.png and no BUILDING/layout/*.png");
  }
  return pictures;
}

/// Brightness 0..255; alpha is passed over.
int gray_of(const std::uint8_t* pixel, int channels) {
  return channels < 3 ? pixel[0] : (299 * pixel[0] + 587 * pixel[1] + 114 * pixel[2] + 500) / 1000;
}

OccupancyGrid read_picture(const fs::path& file, const HalmstadOptions& options) {
  const RasterImage image = decode_image(read_file(file, kMaxImageBytes), file.string());
  OccupancyGrid map = unknown_grid(
      {.width = image.width, .height = image.height, .resolution_m = options.resolution_m, .map_from_grid = {}});
  const std::uint8_t* pixel = image.samples.data();
  for (int row = image.height - 1; row >= 0; --row) {
    for (int column = 0; column < image.width; ++column, pixel += image.channels) {
      const int gray = gray_of(pixel, image.channels);
      map.at({column, row}) = gray <= options.occupied_up_to ? kOccupied : gray >= options.free_from ? kFree : kUnknown;
    }
  }
  return map;
}

void read_pictures(std::vector<Picture>& pictures, const HalmstadOptions& options, int num_threads) {
  std::vector<ProblemList> problems(pictures.size());
  parallel_for(pictures.size(), num_threads, [&](std::size_t i, std::size_t) {
    problems[i].collect([&] {
      pictures[i].map = {.name = pictures[i].name, .grid = read_picture(pictures[i].file, options), .centre = {}};
    });
  });
  ProblemList all;
  for (const ProblemList& each : problems) {
    all.collect([&] { each.throw_if_any(); });
  }
  all.throw_if_any();
}

void leave_out(Picture& picture, const std::string& why, Conversion& result) {
  picture.usable = false;
  result.left_out.push_back(why);
}

void read_points(std::vector<Picture>& pictures, const fs::path& annotations, Conversion& result) {
  for (Picture& picture : pictures) {
    try {
      picture.points = read_keypoints(annotations, picture.name);
    } catch (const InputError& error) {
      leave_out(picture, error.what(), result);
    }
  }
}

std::vector<Shared> read_shared(const std::vector<Picture>& pictures, const fs::path& annotations, Conversion& result) {
  std::vector<Shared> all;
  for (std::size_t target = 0; target < pictures.size(); ++target) {
    for (std::size_t source = target + 1; source < pictures.size(); ++source) {
      const Picture& a = pictures[target];
      const Picture& b = pictures[source];
      if (a.building != b.building || !a.usable || !b.usable) {
        continue;
      }
      try {
        all.push_back({.target = target,
                       .source = source,
                       .matches = read_matches(annotations, a.name, a.points, b.name, b.points)});
      } catch (const InputError& error) {
        result.left_out.emplace_back(error.what());
      }
    }
  }
  return all;
}

// --- the floor plans' scales -----------------------------------------------------------------------------------------

/// How many pixels of a sensor map a pixel of the floor plan measures: the median, which a bent map does not move.
std::optional<double> scale_of(std::size_t layout, const std::vector<Picture>& pictures,
                               const std::vector<Shared>& shared) {
  std::vector<double> scales;
  for (const Shared& each : shared) {
    if (each.source == layout && !pictures[each.target].is_layout) {  // a building's floor plans come last
      const double scale = scale_between(each.matches);
      if (std::isfinite(scale) && scale > 0) {
        scales.push_back(scale);
      }
    }
  }
  if (scales.empty()) {
    return std::nullopt;
  }
  std::sort(scales.begin(), scales.end());
  return 0.5 * (scales[(scales.size() - 1) / 2] + scales[scales.size() / 2]);
}

void scale_layouts(std::vector<Picture>& pictures, const std::vector<Shared>& shared, Conversion& result) {
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    Picture& picture = pictures[i];
    if (!picture.is_layout || !picture.usable) {
      continue;
    }
    const std::optional<double> scale = scale_of(i, pictures, shared);
    if (!scale) {
      leave_out(picture, picture.file.string() + ": shares no points with a sensor map, so its scale is not known",
                result);
      continue;
    }
    double& resolution_m = picture.map.grid.geometry.resolution_m;
    resolution_m = with_decimals(resolution_m * *scale, 6);
  }
}

// --- the pairs -------------------------------------------------------------------------------------------------------

/// From pixels, counted from the lower-left pixel's centre, to the map's frame.
Point2 in_map(Point2 pixel, const NamedGrid& map) {
  return map.grid.geometry.resolution_m * (pixel + Point2{0.5, 0.5});
}

std::string set_of(const std::string& building) {
  std::string set = "halmstad-" + building;
  std::transform(set.begin(), set.end(), set.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return set;
}

ManifestPair same_pair(const Picture& target, const Picture& source, std::vector<PointMatch> matches,
                       const HalmstadOptions& options) {
  for (PointMatch& match : matches) {
    match = {.in_target = in_map(match.in_target, target.map), .in_source = in_map(match.in_source, source.map)};
  }
  const PointFit fit = fit_points(matches);
  const bool bent = fit.residual_m > options.bent_from_m;
  const KnownPose truth = {.target_from_source = fit.target_from_source,
                           .tolerance_m = bent ? options.bent_tolerance_m : options.rigid_tolerance_m,
                           .tolerance_rad = radians(bent ? options.bent_tolerance_deg : options.rigid_tolerance_deg)};
  const std::string tags =
      std::string(bent ? "bent" : "rigid") + (target.is_layout || source.is_layout ? " layout" : " sensor");
  return pair_of(set_of(target.building), target.map, source.map, truth, tags);
}

std::vector<PointMatch> turned(std::vector<PointMatch> matches) {
  for (PointMatch& match : matches) {
    std::swap(match.in_target, match.in_source);
  }
  return matches;
}

std::vector<ManifestPair> same_pairs(const std::vector<Picture>& pictures, const std::vector<Shared>& shared,
                                     const HalmstadOptions& options, int num_threads) {
  std::vector<Shared> wanted;
  for (const Shared& each : shared) {
    if (pictures[each.target].usable && pictures[each.source].usable) {
      wanted.push_back(each);
      if (options.both_orders) {
        wanted.push_back({.target = each.source, .source = each.target, .matches = turned(each.matches)});
      }
    }
  }
  std::sort(wanted.begin(), wanted.end(), [](const Shared& a, const Shared& b) {
    return std::tie(a.target, a.source) < std::tie(b.target, b.source);
  });
  std::vector<ManifestPair> pairs(wanted.size());
  parallel_for(wanted.size(), num_threads, [&](std::size_t i, std::size_t) {
    pairs[i] = same_pair(pictures[wanted[i].target], pictures[wanted[i].source], wanted[i].matches, options);
  });
  return pairs;
}

/// Sensor maps of different buildings, spread evenly over all such pairs.
std::vector<ManifestPair> different_pairs(const std::vector<Picture>& pictures, int count) {
  std::vector<std::pair<const Picture*, const Picture*>> all;
  for (const Picture& target : pictures) {
    for (const Picture& source : pictures) {
      const bool sensors = !target.is_layout && !source.is_layout && target.usable && source.usable;
      if (sensors && target.building < source.building) {
        all.emplace_back(&target, &source);
      }
    }
  }
  std::vector<ManifestPair> pairs;
  const std::size_t wanted = std::min(all.size(), static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < wanted; ++i) {
    const auto [target, source] = all[i * all.size() / wanted];
    pairs.push_back(pair_of(set_of(target->building), target->map, source->map, std::nullopt, "other-building"));
  }
  return pairs;
}

std::vector<NamedGrid> usable_maps(std::vector<Picture>& pictures) {
  std::vector<NamedGrid> maps;
  for (Picture& picture : pictures) {
    if (picture.usable) {
      maps.push_back(std::move(picture.map));
    }
  }
  return maps;
}

}  // namespace

void HalmstadOptions::describe(OptionList& list) {
  list.add("resolution_m", resolution_m, 0.001, 10,
           {"m", "Side of a sensor map's pixel.",
            "The repository does not tell it; with 0.05 the buildings have the size that such buildings have."});
  list.add("occupied_up_to", occupied_up_to, 0, 254,
           {"", "Pixels up to this brightness are occupied.", "As the authors' own program takes them."});
  list.add("free_from", free_from, 1, 255,
           {"", "Pixels from this brightness on are free; those between are unknown.", "As for occupied_up_to."});
  list.add("both_orders", both_orders, {"", "Whether each of two maps is target once.", "Twice the pairs."});
  list.add("bent_from_m", bent_from_m, 0, 100,
           {"m", "A pair whose points stay further apart than this (root mean square) is tagged bent.",
            "Drift has warped one of its maps: no rigid pose fits all of it."});
  list.add("rigid_tolerance_m", rigid_tolerance_m, 0, 100,
           {"m", "How far off an answer may be for a rigid pair.", "The points are good to about 0.15 m."});
  list.add("rigid_tolerance_deg", rigid_tolerance_deg, 0, 180,
           {"deg", "How far turned an answer may be for a rigid pair.", "The points are good to about half a degree."});
  list.add("bent_tolerance_m", bent_tolerance_m, 0, 100,
           {"m", "How far off an answer may be for a bent pair.", "As for rigid_tolerance_m."});
  list.add("bent_tolerance_deg", bent_tolerance_deg, 0, 180,
           {"deg", "How far turned an answer may be for a bent pair.", "As for rigid_tolerance_deg."});
  list.add("other_building_pairs", other_building_pairs, 0, 100000,
           {"", "How many pairs of sensor maps of different buildings.",
            "Without any, nothing tells whether a method knows when not to merge."});
}

Conversion convert_halmstad(const fs::path& path, const fs::path& out, const HalmstadOptions& options,
                            int num_threads) {
  require_valid(options, "convert_halmstad");
  if (options.occupied_up_to >= options.free_from) {
    throw InputError("occupied_up_to", std::to_string(options.occupied_up_to) + " must lie below free_from, " +
                                           std::to_string(options.free_from));
  }
  check_output_folder(path, out);
  Conversion result;
  std::vector<Picture> pictures = list_pictures(path);
  read_pictures(pictures, options, num_threads);
  read_points(pictures, path / "annotations", result);
  const std::vector<Shared> shared = read_shared(pictures, path / "annotations", result);
  scale_layouts(pictures, shared, result);
  for (Picture& picture : pictures) {
    picture.map.centre = centre_of_known(picture.map.grid);
  }
  std::vector<ManifestPair> pairs = same_pairs(pictures, shared, options, num_threads);
  if (pairs.empty()) {
    ProblemList problems;
    problems.add((path / "annotations").string() + ": no two maps share usable points");
    for (const std::string& left_out : result.left_out) {
      problems.add(left_out);
    }
    problems.throw_if_any();
  }
  const std::vector<ManifestPair> different = different_pairs(pictures, options.other_building_pairs);
  pairs.insert(pairs.end(), different.begin(), different.end());
  const std::vector<NamedGrid> maps = usable_maps(pictures);
  write_conversion(out, maps, pairs);
  result.maps = maps.size();
  result.pairs = pairs.size();
  return result;
}

}  // namespace gridmerge
