#include "worlds/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gridmerge/base/random.hpp"
#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

constexpr double kWallThickness = 0.12;
constexpr double kDoorWidth = 1.05;

struct Rect {
  double x0 = 0;
  double y0 = 0;
  double x1 = 0;
  double y1 = 0;
  [[nodiscard]] double width() const { return x1 - x0; }
  [[nodiscard]] double depth() const { return y1 - y0; }
  [[nodiscard]] Point2 centre() const { return {(x0 + x1) / 2, (y0 + y1) / 2}; }
};

/// An opening in a wall, measured along it from its first end [m].
struct Gap {
  double from = 0;
  double to = 0;
};

class Builder {
 public:
  Builder(double length_m, double depth_m) {
    world_.length_m = length_m;
    world_.depth_m = depth_m;
  }

  /// A box given by its centre, its size and the direction of its length.
  void box(Point2 centre, Point2 size, Point2 along = {1, 0}) {
    const Point2 half_length = 0.5 * size.x_m * along;
    const Point2 half_width = 0.5 * size.y_m * Point2{-along.y_m, along.x_m};
    const std::array<Point2, 4> corners = {centre - half_length - half_width, centre + half_length - half_width,
                                           centre + half_length + half_width, centre - half_length + half_width};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      world_.walls.push_back({corners[i], corners[(i + 1) % corners.size()]});
    }
  }

  /// A wall of the usual thickness, with openings in ascending order.
  void wall(Point2 from, Point2 to, const std::vector<Gap>& gaps = {}) {
    const Point2 span = to - from;
    const double length_m = std::sqrt(span.x_m * span.x_m + span.y_m * span.y_m);
    const Point2 along = (1 / length_m) * span;
    double begin = 0;
    const auto piece = [&](double end) {
      if (end - begin > kWallThickness) {
        box(from + (begin + end) / 2 * along, {end - begin + kWallThickness, kWallThickness}, along);
      }
    };
    for (const Gap& gap : gaps) {
      piece(gap.from);
      begin = gap.to;
      doorways_.push_back(from + (gap.from + gap.to) / 2 * along);
    }
    piece(length_m);
  }

  void outer_walls() {
    const double x = world_.length_m;
    const double y = world_.depth_m;
    wall({0, 0}, {x, 0});
    wall({x, 0}, {x, y});
    wall({x, y}, {0, y});
    wall({0, y}, {0, 0});
  }

  void disc(Point2 centre, double radius_m) { world_.discs.push_back({centre, radius_m}); }
  void place(Point2 at) { world_.places.push_back(at); }

  /// Tables, cupboards, columns, clear of the doorways there are: no two rooms alike. (Draws stand in braces, which fix
  /// their order.)
  void furnish(const Rect& room, RandomStream& random) {
    const auto count = 1 + static_cast<int>(room.width() * room.depth() / 8);
    const double scale = std::min(1.0, std::min(room.width(), room.depth()) / 4);
    const Point2 inset = {std::min(1.2, room.width() / 2), std::min(1.2, room.depth() / 2)};
    for (int i = 0; i < count; ++i) {
      const Point2 at = {random.uniform(room.x0 + inset.x_m, room.x1 - inset.x_m),
                         random.uniform(room.y0 + inset.y_m, room.y1 - inset.y_m)};
      const Point2 size = scale * Point2{random.uniform(0.7, 1.6), random.uniform(0.5, 0.9)};
      const Point2 along = direction(random.uniform(0, kPi));
      const Point2 at_side = {random.below(2) == 0 ? room.x0 + 0.3 : room.x1 - 0.3, at.y_m};
      const std::uint32_t thing = random.below(4);
      if (near_doorway(thing == 1 ? at_side : at)) {
        continue;
      }
      if (thing == 0) {
        disc(at, size.x_m / 5);
      } else if (thing == 1) {  // a cupboard with its back to a side wall
        box(at_side, {0.45, size.x_m});
      } else {
        box(at, size, thing == 2 ? along : Point2{1, 0});
      }
    }
  }

  [[nodiscard]] const std::vector<Point2>& doorways() const { return doorways_; }
  [[nodiscard]] World finish() { return std::move(world_); }

 private:
  [[nodiscard]] bool near_doorway(Point2 at) const {
    return std::any_of(doorways_.begin(), doorways_.end(), [&](Point2 doorway) {
      const Point2 way = doorway - at;
      return way.x_m * way.x_m + way.y_m * way.y_m < 1.4 * 1.4;
    });
  }

  World world_;
  std::vector<Point2> doorways_;
};

/// A door somewhere in a wall of that length, off the corners.
Gap door(double wall_length_m, RandomStream& random) {
  const double from = random.uniform(0.3, std::max(0.3, wall_length_m - kDoorWidth - 0.3));
  return {from, from + kDoorWidth};
}

/// One side of the office's corridor: rooms of varying width and depth. `side` is +1 above the corridor, -1 below.
void office_row(Builder& builder, double corridor_y, double side, double depth_m, double length_m,
                RandomStream& random) {
  double x = 0;
  builder.wall({0, corridor_y}, {0, corridor_y + side * depth_m});
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
    builder.furnish(room, random);
    builder.place(room.centre());
    x = next;
  }
}

World office(RandomStream& random) {
  const double length_m = random.uniform(36, 42);
  const double below_m = random.uniform(5, 7);
  const double corridor_m = random.uniform(1.9, 2.6);
  const double above_m = random.uniform(6, 8);
  Builder builder(length_m, below_m + corridor_m + above_m);
  office_row(builder, below_m, -1, below_m, length_m, random);
  office_row(builder, below_m + corridor_m, +1, above_m, length_m, random);
  for (const double end_x : {0.0, length_m}) {
    builder.wall({end_x, below_m}, {end_x, below_m + corridor_m});
  }
  for (double x = 1.5; x < length_m - 1; x += 4) {
    builder.place({x, below_m + corridor_m / 2});
  }
  return builder.finish();
}

/// About the size of the thesis's maze, 34 m x 17 m.
World maze(RandomStream& random) {
  constexpr int kColumns = 10;
  constexpr int kRows = 5;
  struct Cell {
    bool visited = false;
    bool open_right = false;
    bool open_up = false;
  };
  std::array<std::array<Cell, kRows>, kColumns> cells{};
  const auto at = [&](int column, int row) -> Cell& {
    return cells[static_cast<std::size_t>(column)][static_cast<std::size_t>(row)];
  };
  struct Step {
    int column = 0;
    int row = 0;
  };
  constexpr std::array<Step, 4> kSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

  std::vector<Step> trail = {{0, 0}};
  at(0, 0).visited = true;
  while (!trail.empty()) {  // depth first, with a way back
    const Step here = trail.back();
    std::vector<Step> fresh;
    for (const Step& step : kSteps) {
      const Step to = {here.column + step.column, here.row + step.row};
      const bool inside = to.column >= 0 && to.row >= 0 && to.column < kColumns && to.row < kRows;
      if (inside && !at(to.column, to.row).visited) {
        fresh.push_back(to);
      }
    }
    if (fresh.empty()) {
      trail.pop_back();
      continue;
    }
    const Step to = fresh[random.below(static_cast<std::uint32_t>(fresh.size()))];
    at(to.column, to.row).visited = true;
    Cell& lower = at(std::min(here.column, to.column), std::min(here.row, to.row));
    (to.column != here.column ? lower.open_right : lower.open_up) = true;
    trail.push_back(to);
  }

  // Passages of unequal width: on an even lattice a maze fits itself, and any other, in many places.
  std::array<double, kColumns + 1> x_m{};
  std::array<double, kRows + 1> y_m{};
  for (std::size_t i = 1; i < x_m.size(); ++i) {
    x_m[i] = x_m[i - 1] + random.uniform(2.6, 4.2);
  }
  for (std::size_t i = 1; i < y_m.size(); ++i) {
    y_m[i] = y_m[i - 1] + random.uniform(2.6, 4.2);
  }
  Builder builder(x_m.back(), y_m.back());
  builder.outer_walls();
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < kRows; ++row) {
      const auto i = static_cast<std::size_t>(column);
      const auto j = static_cast<std::size_t>(row);
      const Point2 low = {x_m[i], y_m[j]};
      const Point2 high = {x_m[i + 1], y_m[j + 1]};
      // A quarter of the inner walls falls, so that there is more than one way round.
      if (column + 1 < kColumns && !at(column, row).open_right && random.below(4) != 0) {
        builder.wall({high.x_m, low.y_m}, high);
      }
      if (row + 1 < kRows && !at(column, row).open_up && random.below(4) != 0) {
        builder.wall({low.x_m, high.y_m}, high);
      }
      const Point2 centre = 0.5 * (low + high);
      if (random.below(5) == 0) {
        const Point2 at_off = centre + Point2{random.uniform(-1, 1), random.uniform(-1, 1)};
        const Point2 size = {random.uniform(0.4, 1.6), random.uniform(0.3, 0.8)};
        if (random.below(2) == 0) {
          builder.disc(at_off, size.y_m / 2);
        } else {
          builder.box(at_off, size, direction(random.uniform(0, kPi)));
        }
      }
      builder.place(centre);
    }
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

World flat(RandomStream& random) {
  const double length_m = random.uniform(11, 14);
  const double depth_m = random.uniform(8, 10);
  Builder builder(length_m, depth_m);
  builder.outer_walls();
  divide(builder, {0, 0, length_m, depth_m}, random);
  return builder.finish();
}

World forest(RandomStream& random) {
  constexpr double kSide = 40;
  Builder builder(kSide, kSide);
  std::vector<Point2> trunks;
  for (int attempt = 0; attempt < 400; ++attempt) {
    const Point2 at = {random.uniform(0, kSide), random.uniform(0, kSide)};
    const auto near = [&](Point2 trunk) {
      const Point2 way = trunk - at;
      return way.x_m * way.x_m + way.y_m * way.y_m < 1.6 * 1.6;
    };
    if (std::none_of(trunks.begin(), trunks.end(), near)) {
      trunks.push_back(at);
      builder.disc(at, random.uniform(0.06, 0.3));
    }
  }
  for (int bush = 0; bush < 12; ++bush) {
    const Point2 at = {random.uniform(2, kSide - 2), random.uniform(2, kSide - 2)};
    for (int twig = 0; twig < 15; ++twig) {
      builder.disc(at + Point2{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)}, 0.03);
    }
  }
  for (double x = 3; x < kSide; x += 5) {
    for (double y = 3; y < kSide; y += 5) {
      builder.place({x + random.uniform(-1, 1), y + random.uniform(-1, 1)});
    }
  }
  return builder.finish();
}

/// Nothing in it says how far along it one is.
World corridor(RandomStream& /*random*/) {
  Builder builder(60, 2.4);
  builder.outer_walls();
  for (double x = 1.5; x < 59; x += 3) {
    builder.place({x, 1.2});
  }
  return builder.finish();
}

/// Turned by half a turn, or mirrored, it looks the same.
World hall(RandomStream& /*random*/) {
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

struct Kind {
  const char* name;
  World (*make)(RandomStream&);
};
constexpr std::array<Kind, 6> kKinds = {
    {{"office", office}, {"maze", maze}, {"flat", flat}, {"forest", forest}, {"corridor", corridor}, {"hall", hall}}};

}  // namespace

std::vector<std::string> world_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    names.emplace_back(kind.name);
  }
  return names;
}

World make_world(std::string_view kind, std::uint64_t seed) {
  const auto known = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == kind; });
  if (known == kKinds.end()) {
    throw std::invalid_argument("there is no world of kind '" + std::string(kind) + "'");
  }
  RandomStream random(seed, "world/" + std::string(kind));
  return known->make(random);
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
