#include "worlds/world.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "gridmerge/base/random.hpp"
#include "worlds/kinds.hpp"

namespace gridmerge::worlds {
namespace {

struct Kind {
  const char* name;
  World (*make)(const Plot&);
  double length_m;  ///< of its own, on average
  bool grows;       ///< to any other
  bool furnished = false;
};
constexpr std::array<Kind, 11> kKinds = {{{"office", office, 39, true, true},
                                          {"maze", maze, 34, true},
                                          {"flat", flat, 12.5, false, true},
                                          {"forest", forest, 40, true},
                                          {"corridor", corridor, 60, true},
                                          {"hall", hall, 30, false},
                                          {"warehouse", warehouse, 50, true},
                                          {"cave", cave, 45, true},
                                          {"spiral", spiral, 28, false},
                                          {"floors", floors, 28, true, true},
                                          {"bush_forest", bush_forest, 40, true}}};

const Kind& kind_named(std::string_view name) {
  const auto known = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == name; });
  if (known == kKinds.end()) {
    throw std::invalid_argument("there is no world of kind '" + std::string(name) + "'");
  }
  return *known;
}

}  // namespace

std::vector<std::string> world_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    names.emplace_back(kind.name);
  }
  return names;
}

bool world_grows(std::string_view kind) { return kind_named(kind).grows; }

bool world_is_furnished(std::string_view kind) { return kind_named(kind).furnished; }

double usual_length_m(std::string_view kind) { return kind_named(kind).length_m; }

World make_world(std::string_view kind, std::uint64_t seed, const WorldVariant& variant) {
  RandomStream random(seed, "world/" + std::string(kind));
  return kind_named(kind).make(
      {random, seed, variant.length_m, variant.storey, variant.rearranged_share, variant.cleared});
}

World mirrored(World world) {
  const auto flip = [&](Point2& point) { point.y_m = world.depth_m - point.y_m; };
  for (Segment& wall : world.walls) {
    flip(wall.from);
    flip(wall.to);
  }
  for (Disc& disc : world.discs) {
    flip(disc.centre);
  }
  for (Point2& place : world.places) {
    flip(place);
  }
  return world;
}

}  // namespace gridmerge::worlds
