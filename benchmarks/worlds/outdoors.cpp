#include <algorithm>
#include <vector>

#include "worlds/builder.hpp"
#include "worlds/kinds.hpp"
#include "worlds/portable.hpp"

namespace gridmerge::worlds {

namespace {

/// Trunks at least 1.6 m apart.
void plant_trees(Builder& builder, Point2 size, int attempts, RandomStream& random) {
  std::vector<Point2> trunks;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    const Point2 at = {random.uniform(0, size.x_m), random.uniform(0, size.y_m)};
    const auto near = [&](Point2 trunk) {
      const Point2 way = trunk - at;
      return way.x_m * way.x_m + way.y_m * way.y_m < 1.6 * 1.6;
    };
    if (std::none_of(trunks.begin(), trunks.end(), near)) {
      trunks.push_back(at);
      builder.disc(at, random.uniform(0.06, 0.3));
    }
  }
}

void mark_places(Builder& builder, Point2 size, RandomStream& random) {
  for (double x = 3; x < size.x_m; x += 5) {
    for (double y = 3; y < size.y_m; y += 5) {
      builder.place({x + random.uniform(-1, 1), y + random.uniform(-1, 1)});
    }
  }
}

/// The sides of a wood of that length: as wide as it is deep up to 40 m, then no deeper than half its length.
Point2 wood_size(const Plot& plot) {
  constexpr double kSide = 40;
  const double length_m = plot.length_m > 0 ? plot.length_m : kSide;
  return {length_m, std::min(length_m, std::max(kSide, length_m / 2))};
}

int in_proportion(double count, Point2 size) { return static_cast<int>(count * size.x_m * size.y_m / 1600); }

}  // namespace

World forest(const Plot& plot) {
  RandomStream& random = plot.random;
  const Point2 size = wood_size(plot);
  Builder builder(size.x_m, size.y_m);
  plant_trees(builder, size, in_proportion(400, size), random);
  for (int bush = 0; bush < in_proportion(12, size); ++bush) {
    const Point2 at = {random.uniform(2, size.x_m - 2), random.uniform(2, size.y_m - 2)};
    for (int twig = 0; twig < 15; ++twig) {
      builder.disc(at + Point2{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)}, 0.03);
    }
  }
  mark_places(builder, size, random);
  return builder.finish();
}

/// Fewer trees, and thickets: a beam ends on some twig of them, another one each time, and many go through.
World bush_forest(const Plot& plot) {
  RandomStream& random = plot.random;
  const Point2 size = wood_size(plot);
  Builder builder(size.x_m, size.y_m);
  plant_trees(builder, size, in_proportion(130, size), random);
  for (int thicket = 0; thicket < in_proportion(80, size); ++thicket) {
    const Point2 at = {random.uniform(1, size.x_m - 1), random.uniform(1, size.y_m - 1)};
    const int bushes = 1 + static_cast<int>(random.below(4));
    for (int bush = 0; bush < bushes; ++bush) {
      const Point2 stem = at + Point2{random.uniform(-1.6, 1.6), random.uniform(-1.6, 1.6)};
      const double reach_m = random.uniform(0.3, 0.9);
      for (int twig = 0; twig < 22; ++twig) {
        const Point2 towards = direction(random.uniform(0, 2 * kPi));
        const double way_m = reach_m * random.uniform();  // densest at the stem
        builder.disc(stem + way_m * towards, random.uniform(0.008, 0.025));
      }
    }
  }
  mark_places(builder, size, random);
  return builder.finish();
}

}  // namespace gridmerge::worlds
