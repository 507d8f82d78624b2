#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "worlds/builder.hpp"
#include "worlds/kinds.hpp"
#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

constexpr double kBay = 2.7;         // [m] from one upright of a rack to the next
constexpr double kRackDepth = 1.1;   // [m] of one side
constexpr double kBackToBack = 0.2;  // [m] between the two sides of a rack
constexpr double kNicheDepth = 1.3;  // [m] of a dock
constexpr double kForecourt = 7.5;   // [m] between the docks and the racks
constexpr double kSideAisle = 3.2;   // [m]

/// What stands in one bay of one side of a rack, whose middle lies at `centre`: it differs from bay to bay, or a
/// warehouse would fit itself, moved by an aisle.
void fill_bay(Builder& builder, Point2 centre, RandomStream& random) {
  const std::uint32_t load = random.below(8);
  if (load < 3) {  // full
    builder.box(centre, {kBay - 0.25, kRackDepth - 0.1});
  } else if (load < 5) {  // one pallet
    const Point2 off = {random.uniform(-0.6, 0.6), random.uniform(-0.1, 0.1)};
    builder.box(centre + off, {1.2, random.uniform(0.7, 1)});
  } else if (load < 7) {  // two, not in line
    for (const double aside_m : {-0.65, 0.65}) {
      const Point2 off = {aside_m, random.uniform(-0.15, 0.15)};
      builder.box(centre + off, {random.uniform(0.8, 1.15), 0.8});
    }
  }
}

/// A rack along x, open to the aisles above and below it.
void rack(Builder& builder, Point2 from, int bays, RandomStream& random) {
  for (const double side : {-1.0, 1.0}) {
    const double y = from.y_m + side * (kRackDepth + kBackToBack) / 2;
    for (int bay = 0; bay <= bays; ++bay) {
      for (const double edge : {-0.5, 0.5}) {
        builder.box({from.x_m + bay * kBay, y + edge * (kRackDepth - 0.1)}, {0.1, 0.1});
      }
      if (bay < bays) {
        fill_bay(builder, {from.x_m + (bay + 0.5) * kBay, y}, random);
      }
    }
  }
}

/// The lower wall with its docks: niches of one width at uneven distances, some of them shut.
void docks(Builder& builder, double length_m, RandomStream& random) {
  constexpr double kDoor = 3.2;
  double x = 0;
  while (true) {
    const double next = x + random.uniform(1.6, 3.8);
    if (next + kDoor > length_m - 1) {
      break;
    }
    builder.wall({x, kNicheDepth}, {next, kNicheDepth});
    const bool shut = random.below(3) == 0;
    if (shut) {
      builder.wall({next, kNicheDepth - 0.3}, {next + kDoor, kNicheDepth - 0.3});
    } else {
      builder.wall({next, 0}, {next + kDoor, 0});
    }
    builder.wall({next, shut ? kNicheDepth - 0.3 : 0}, {next, kNicheDepth});
    builder.wall({next + kDoor, shut ? kNicheDepth - 0.3 : 0}, {next + kDoor, kNicheDepth});
    x = next + kDoor;
  }
  builder.wall({x, kNicheDepth}, {length_m, kNicheDepth});
}

/// Goods put down between the docks and the racks.
void stage_goods(Builder& builder, double length_m, RandomStream& random) {
  for (int i = 0; i < static_cast<int>(length_m / 3.5); ++i) {
    const Point2 at = {random.uniform(2, length_m - 2), random.uniform(kNicheDepth + 2.2, kForecourt - 1.2)};
    const Point2 size = {random.uniform(0.8, 2.4), random.uniform(0.8, 1.2)};
    builder.box(at, size, direction(random.uniform(-0.15, 0.15)));
  }
}

/// The foremen's room, in the corner at the right of the docks.
void site_office(Builder& builder, double length_m, RandomStream& random) {
  const Rect room = {length_m - random.uniform(4.5, 6), kNicheDepth, length_m, kNicheDepth + random.uniform(3.2, 4.2)};
  builder.wall({room.x0, room.y0}, {room.x0, room.y1}, {door(room.depth(), random)});
  builder.wall({room.x0, room.y1}, {room.x1, room.y1});
  builder.furnish(room, random);
  builder.place(room.centre());
}

}  // namespace

/// Racks between aisles, docks along one wall. Some racks are shorter than others, some have a gap to pass through.
World warehouse(const Plot& plot) {
  RandomStream& random = plot.random;
  const double own_length_m = random.uniform(46, 54);
  const double length_m = plot.length_m > 0 ? plot.length_m : own_length_m;
  const int racks = std::max(3, static_cast<int>(std::lround(length_m / 9)));
  std::vector<double> rack_y;
  double y = kForecourt + kRackDepth;
  for (int i = 0; i < racks; ++i) {
    rack_y.push_back(y);
    y += 2 * kRackDepth + kBackToBack + random.uniform(2.5, 3.3);
  }
  Builder builder(length_m, y - kRackDepth);
  builder.wall({0, kNicheDepth}, {0, builder.depth_m()});
  builder.wall({length_m, kNicheDepth}, {length_m, builder.depth_m()});
  builder.wall({0, builder.depth_m()}, {length_m, builder.depth_m()});
  docks(builder, length_m, random);
  stage_goods(builder, length_m - 7, random);
  site_office(builder, length_m, random);
  const double racked_m = length_m - 2 * kSideAisle;
  const int blocks = std::max(2, static_cast<int>(racked_m / 24));  // of bays, with a cross aisle between
  const int bays = static_cast<int>((racked_m - (blocks - 1) * kSideAisle) / (blocks * kBay));
  const double aisle_m = (racked_m - blocks * bays * kBay) / (blocks - 1);
  for (const double at_y : rack_y) {
    for (int block = 0; block < blocks; ++block) {
      const int left_out = static_cast<int>(random.below(4)) == 0 ? 1 + static_cast<int>(random.below(3)) : 0;
      const int moved = left_out > 0 ? static_cast<int>(random.below(static_cast<std::uint32_t>(left_out) + 1)) : 0;
      const double from_x = kSideAisle + block * (bays * kBay + aisle_m) + moved * kBay;
      rack(builder, {from_x, at_y}, bays - left_out, random);
    }
  }
  for (std::size_t i = 0; i <= rack_y.size(); ++i) {
    const double aisle_y = i == 0               ? kForecourt - 1.2
                           : i == rack_y.size() ? builder.depth_m() - 1.2
                                                : (rack_y[i - 1] + rack_y[i]) / 2;
    for (double x = kSideAisle / 2; x < length_m - 1; x += 4) {
      builder.place({x, aisle_y});
    }
  }
  return builder.finish();
}

}  // namespace gridmerge::worlds
