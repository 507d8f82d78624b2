/// Composes poses, draws a map, writes it and reads it again, lists the methods.
#include <cstdio>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "map_server/map_files.hpp"
#include "methods/register_all.hpp"

int main() {
  const gridmerge::Pose2 a_from_b = {1, 2, 0.5};
  const gridmerge::Pose2 identity = a_from_b * inverse(a_from_b);

  gridmerge::OccupancyGrid room =
      gridmerge::unknown_grid({.width = 30, .height = 20, .resolution_m = 0.1, .map_from_grid = {}});
  room.at({3, 4}) = gridmerge::kOccupied;
  write_map(room, "room.yaml");
  const bool same = gridmerge::read_map("room.yaml") == room;

  const gridmerge::MethodRegistry methods = gridmerge::all_methods();
  for (const gridmerge::MethodEntry& method : methods.entries()) {
    std::printf("%s: %s\n", method.name.c_str(), method.summary.c_str());
  }
  return same && norm(identity.translation()) < 1e-12 ? 0 : 1;
}
