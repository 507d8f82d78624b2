#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "worlds/builder.hpp"
#include "worlds/kinds.hpp"

namespace gridmerge::worlds {
namespace {

/// Where a row of rooms stands: along the corridor's edge at `corridor_y`; `side` is +1 above it, -1 below.
struct Row {
  double from_x = 0;
  double to_x = 0;
  double corridor_y = 0;
  double side = 1;
  double depth_m = 0;
};

/// Rooms of varying width and depth along one side of a corridor.
void office_row(Builder& builder, const Row& row, RandomStream& random, RandomStream& furniture) {
  const auto [from_x, length_m, corridor_y, side, depth_m] = row;
  double x = from_x;
  builder.wall({x, corridor_y}, {x, corridor_y + side * depth_m});
  while (x < length_m) {
    double next = x + random.uniform(3.2, 7.5);
    next = length_m - next < 3.2 ? length_m : next;
    const double width_m = next - x;
    const double back_y = corridor_y + side * (depth_m - random.uniform(0, 1.8));
    const bool open_bay = random.below(7) == 0;
    builder.wall({x, corridor_y}, {next, corridor_y}, {open_bay ? Gap{0.4, width_m - 0.7} : door(width_m, random)});
    builder.wall({x, back_y}, {next, back_y});
    if (random.below(3) == 0) {  // a corner cut off
      const Point2 cut = {random.uniform(0.8, 2), random.uniform(0.8, 2)};
      builder.wall({x, back_y - side * cut.y_m}, {x + cut.x_m, back_y});
    }
    const bool passage = random.below(4) == 0;
    const Gap to_neighbour = door(depth_m - 2, random);
    builder.wall({next, corridor_y}, {next, corridor_y + side * depth_m},
                 passage && next < length_m ? std::vector<Gap>{to_neighbour} : std::vector<Gap>{});
    const Rect room{x, std::min(corridor_y, back_y), next, std::max(corridor_y, back_y)};
    builder.furnish(room, furniture);
    builder.place(room.centre());
    x = next;
  }
}

/// A corridor with a row of rooms on either side.
struct Wing {
  double from_x = 0;
  double to_x = 0;
  double from_y = 0;
  double below_m = 0;
  double corridor_m = 0;
  double above_m = 0;
};

void office_wing(Builder& builder, const Wing& wing, RandomStream& random, RandomStream& furniture) {
  const double low_y = wing.from_y + wing.below_m;
  const double high_y = low_y + wing.corridor_m;
  office_row(builder, {wing.from_x, wing.to_x, low_y, -1, wing.below_m}, random, furniture);
  office_row(builder, {wing.from_x, wing.to_x, high_y, +1, wing.above_m}, random, furniture);
  for (double x = wing.from_x + 1.5; x < wing.to_x - 1; x += 4) {
    builder.place({x, low_y + wing.corridor_m / 2});
  }
}

World office_block(const Plot& plot, double length_m) {
  constexpr double kCross = 2.4;  // [m] width of a cross corridor
  RandomStream& random = plot.random;
  std::vector<Wing> wings;
  double depth_m = 0;
  for (int i = 0; i < static_cast<int>(std::lround(length_m / 40)); ++i) {
    Wing wing = {.from_x = kCross, .to_x = length_m - kCross, .from_y = depth_m};
    wing.below_m = random.uniform(5, 7);
    wing.corridor_m = random.uniform(1.9, 2.6);
    wing.above_m = random.uniform(6, 8);
    depth_m += wing.below_m + wing.corridor_m + wing.above_m;
    wings.push_back(wing);
  }
  Builder builder(length_m, depth_m);
  builder.change_furniture(plot);
  builder.outer_walls();
  for (const Wing& wing : wings) {
    office_wing(builder, wing, random, random);
  }
  for (double y = 2; y < depth_m - 1; y += 4) {
    builder.place({kCross / 2, y});
    builder.place({length_m - kCross / 2, y});
  }
  return builder.finish();
}

/// Splits a room in two by a wall with a door until it is small, then furnishes it.
void divide(Builder& builder, const Rect& room, RandomStream& random) {
  const bool across = room.width() >= room.depth();  // the wall stands across the longer side
  const double side_m = across ? room.width() : room.depth();
  const auto in_a_doorway = [&](double at) {
    const std::vector<Point2>& doors = builder.doorways();
    return std::any_of(doors.begin(), doors.end(), [&](Point2 d) {
      const bool on_border =
          across ? d.y_m > room.y0 - 0.1 && d.y_m < room.y1 + 0.1 : d.x_m > room.x0 - 0.1 && d.x_m < room.x1 + 0.1;
      return on_border && std::abs((across ? d.x_m : d.y_m) - at) < 0.8;
    });
  };
  for (int attempt = 0; side_m > 4.6 && attempt < 10; ++attempt) {
    const double at = (across ? room.x0 : room.y0) + side_m * random.uniform(0.35, 0.65);
    if (in_a_doorway(at)) {
      continue;
    }
    const Gap gap = door(across ? room.depth() : room.width(), random);
    if (across) {
      builder.wall({at, room.y0}, {at, room.y1}, {gap});
      divide(builder, {room.x0, room.y0, at, room.y1}, random);
      divide(builder, {at, room.y0, room.x1, room.y1}, random);
    } else {
      builder.wall({room.x0, at}, {room.x1, at}, {gap});
      divide(builder, {room.x0, room.y0, room.x1, at}, random);
      divide(builder, {room.x0, at, room.x1, room.y1}, random);
    }
    return;
  }
  builder.furnish(room, random);
  builder.place(room.centre());
}

}  // namespace

/// One corridor with rooms on either side; a larger one has several, side by side, between two cross corridors.
World office(const Plot& plot) {
  constexpr double kLongest = 60;  // [m] of a single corridor
  RandomStream& random = plot.random;
  const double own_length_m = random.uniform(36, 42);
  const double length_m = plot.length_m > 0 ? plot.length_m : own_length_m;
  if (length_m > kLongest) {
    return office_block(plot, length_m);
  }
  const double below_m = random.uniform(5, 7);
  const double corridor_m = random.uniform(1.9, 2.6);
  const double above_m = random.uniform(6, 8);
  Builder builder(length_m, below_m + corridor_m + above_m);
  builder.change_furniture(plot);
  office_wing(builder, {0, length_m, 0, below_m, corridor_m, above_m}, random, random);
  for (const double end_x : {0.0, length_m}) {
    builder.wall({end_x, below_m}, {end_x, below_m + corridor_m});
  }
  return builder.finish();
}

/// Every storey has the same walls, and furniture of its own.
World floors(const Plot& plot) {
  RandomStream& random = plot.random;
  RandomStream furniture(plot.seed, "world/floors/furniture", static_cast<std::uint64_t>(plot.storey));
  const double own_length_m = random.uniform(26, 30);
  const double length_m = plot.length_m > 0 ? plot.length_m : own_length_m;
  const double below_m = random.uniform(5, 6);
  const double above_m = random.uniform(5, 6);
  Builder builder(length_m, below_m + 2.2 + above_m);
  builder.change_furniture(plot);
  office_wing(builder, {0, length_m, 0, below_m, 2.2, above_m}, random, furniture);
  for (const double end_x : {0.0, length_m}) {
    builder.wall({end_x, below_m}, {end_x, below_m + 2.2});
  }
  return builder.finish();
}

World flat(const Plot& plot) {
  RandomStream& random = plot.random;
  const double length_m = random.uniform(11, 14);
  const double depth_m = random.uniform(8, 10);
  Builder builder(length_m, depth_m);
  builder.change_furniture(plot);
  builder.outer_walls();
  divide(builder, {0, 0, length_m, depth_m}, random);
  return builder.finish();
}

/// Nothing in it says how far along it one is.
World corridor(const Plot& plot) {
  const double length_m = plot.length_m > 0 ? plot.length_m : 60;
  Builder builder(length_m, 2.4);
  builder.outer_walls();
  for (double x = 1.5; x < length_m - 1; x += 3) {
    builder.place({x, 1.2});
  }
  return builder.finish();
}

/// Turned by half a turn, or mirrored, it looks the same.
World hall(const Plot& /*plot*/) {
  Builder builder(30, 20);
  builder.outer_walls();
  for (const double x : {5.0, 10.0, 15.0, 20.0, 25.0}) {
    for (const double y : {5.0, 15.0}) {
      builder.box({x, y}, {0.5, 0.5});
      builder.place({x + 1.5, y + 1.5});
      builder.place({x - 1.5, y - 1.5});
    }
  }
  return builder.finish();
}
}  // namespace gridmerge::worlds
