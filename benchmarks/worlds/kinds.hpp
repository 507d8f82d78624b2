#pragma once
/// One function for each kind of world; world.cpp lists them.
#include <cstdint>

#include "gridmerge/base/random.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

/// What a world is drawn from.
struct Plot {
  RandomStream& random;         // of the kind and the seed
  std::uint64_t seed = 1;       // for streams of its own
  double length_m = 0;          // 0: the kind's own
  int storey = 0;               // of a kind with storeys
  double rearranged_share = 0;  // of the furniture
  bool cleared = false;         // of all of it
};

[[nodiscard]] World office(const Plot& plot);
[[nodiscard]] World maze(const Plot& plot);
[[nodiscard]] World flat(const Plot& plot);
[[nodiscard]] World forest(const Plot& plot);
[[nodiscard]] World corridor(const Plot& plot);
[[nodiscard]] World hall(const Plot& plot);
[[nodiscard]] World warehouse(const Plot& plot);
[[nodiscard]] World cave(const Plot& plot);
[[nodiscard]] World spiral(const Plot& plot);
[[nodiscard]] World floors(const Plot& plot);
[[nodiscard]] World bush_forest(const Plot& plot);

}  // namespace gridmerge::worlds
