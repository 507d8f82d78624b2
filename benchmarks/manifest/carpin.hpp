#pragma once
/// Carpin's occupancy grids (mapmerge 0.3, the data of [carpin2008]): a text table of 0 occupied, 127 unknown, 255
/// free.
#include <filesystem>
#include <string>
#include <string_view>

#include "gridmerge/base/options.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "manifest/conversion.hpp"

namespace gridmerge {

struct CarpinOptions {
  double resolution_m = 0.05;
  bool nearest = false;

  void describe(OptionList& list);
};

/// One grid: a line a row, the top row first, numbers with spaces between. Its lower-left corner is the frame's origin.
/// @param name  the file's name, for messages
/// @throws InputError naming file, line, column and rule (the first ten): a word that is no number of the three (with
/// `nearest`: of 0..255), a line that is shorter or longer than the first, no number at all
[[nodiscard]] OccupancyGrid parse_carpin(std::string_view text, const std::string& name,
                                         const CarpinOptions& options = {});

/// Turns every .txt file in the folder that begins with a number (or the one file) into a map in `out`. The data hold
/// no poses: if the folder has a pairs.csv in the referee's form, that names the maps as they are to be called
/// (robot0_cast.yaml), its truth is checked against the maps and written beside them, with centre and overlap worked
/// out.
/// @throws InputError naming every file, line and rule broken; std::invalid_argument for options out of range
Conversion convert_carpin(const std::filesystem::path& path, const std::filesystem::path& out,
                          const CarpinOptions& options = {});

}  // namespace gridmerge
