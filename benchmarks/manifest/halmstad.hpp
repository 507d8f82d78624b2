#pragma once
/// Halmstad-Robot-Maps [shahbandi2018]: gray pictures of four buildings, sensor maps and a floor plan each, with points
/// that a person marked in them.
#include <filesystem>

#include "gridmerge/base/options.hpp"
#include "manifest/conversion.hpp"

namespace gridmerge {

struct HalmstadOptions {
  double resolution_m = 0.05;
  int occupied_up_to = 100;
  int free_from = 200;
  bool both_orders = true;
  double bent_from_m = 0.3;
  double rigid_tolerance_m = 0.5;
  double rigid_tolerance_deg = 3;
  double bent_tolerance_m = 1;
  double bent_tolerance_deg = 5;
  int other_building_pairs = 12;

  void describe(OptionList& list);
};

/// Reads a clone of the repository: `maps/BUILDING/pseudo_occupancy/*.png`, `maps/BUILDING/layout/*.png` and
/// `annotations/*.npy`, and writes a map for each picture and pairs.csv to `out`. A map's frame: the picture's
/// lower-left corner. A floor plan's resolution is worked out from the points that it shares with sensor maps (the
/// median of their scales). The pose of a pair is the least-squares one of its points; where they are left further
/// apart than `bent_from_m`, the pair is tagged `bent`, else `rigid`. Pairs of different buildings stand for
/// `different`. What has no usable points is left out and named.
/// @throws InputError naming every file and rule broken: no clone of the repository, a picture that cannot be read, no
/// pair at all, occupied_up_to not below free_from; std::invalid_argument for options out of range
Conversion convert_halmstad(const std::filesystem::path& path, const std::filesystem::path& out,
                            const HalmstadOptions& options = {}, int num_threads = 1);

}  // namespace gridmerge
