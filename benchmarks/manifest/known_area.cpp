#include "manifest/known_area.hpp"

#include <cmath>
#include <cstdint>

namespace gridmerge {

Point2 centre_of_known(const OccupancyGrid& map) {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t count = 0;
  for (int row = 0; row < map.geometry.height; ++row) {
    for (int column = 0; column < map.geometry.width; ++column) {
      if (map.at({column, row}) != kUnknown) {
        columns += column;
        rows += row;
        ++count;
      }
    }
  }
  if (count == 0) {
    return map.geometry.map_from_grid.translation();
  }
  const auto mean_m = [&](std::int64_t sum) {
    return (static_cast<double>(sum) / static_cast<double>(count) + 0.5) * map.geometry.resolution_m;
  };
  return map.geometry.map_from_grid * Point2{mean_m(columns), mean_m(rows)};
}

double with_decimals(double value, int decimals) {
  double scale = 1;
  for (int i = 0; i < decimals; ++i) {
    scale *= 10;
  }
  return std::round(value * scale) / scale;
}

}  // namespace gridmerge
