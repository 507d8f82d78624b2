#include "cli/read_maps.hpp"

#include <exception>

#include "gridmerge/base/parallel.hpp"
#include "map_server/map_files.hpp"

namespace gridmerge::cli {

std::vector<OccupancyGrid> read_maps(const std::vector<std::string>& files, int num_threads) {
  std::vector<OccupancyGrid> maps(files.size());
  std::vector<std::exception_ptr> failures(files.size());
  parallel_for(files.size(), num_threads, [&](std::size_t i, std::size_t) {
    try {
      maps[i] = read_map(files[i]);
    } catch (...) {
      failures[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
  return maps;
}

}  // namespace gridmerge::cli
