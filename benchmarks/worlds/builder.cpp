#include "worlds/builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

constexpr double kWallThickness = 0.12;
constexpr double kDoorWidth = 1.05;

}  // namespace

Builder::Builder(double length_m, double depth_m) {
  world_.length_m = length_m;
  world_.depth_m = depth_m;
}

void Builder::box(Point2 centre, Point2 size, Point2 along) {
  const Point2 half_length = 0.5 * size.x_m * along;
  const Point2 half_width = 0.5 * size.y_m * Point2{-along.y_m, along.x_m};
  const std::array<Point2, 4> corners = {centre - half_length - half_width, centre + half_length - half_width,
                                         centre + half_length + half_width, centre - half_length + half_width};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    world_.walls.push_back({corners[i], corners[(i + 1) % corners.size()]});
  }
}

void Builder::wall(Point2 from, Point2 to, const std::vector<Gap>& gaps) {
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

void Builder::outer_walls() {
  const double x = world_.length_m;
  const double y = world_.depth_m;
  wall({0, 0}, {x, 0});
  wall({x, 0}, {x, y});
  wall({x, y}, {0, y});
  wall({0, y}, {0, 0});
}

// Draws stand in braces, which fix their order.
Builder::Piece Builder::draw_piece(const Rect& room, RandomStream& random) {
  const double scale = std::min(1.0, std::min(room.width(), room.depth()) / 4);
  const Point2 inset = {std::min(1.2, room.width() / 2), std::min(1.2, room.depth() / 2)};
  Piece piece;
  piece.at = {random.uniform(room.x0 + inset.x_m, room.x1 - inset.x_m),
              random.uniform(room.y0 + inset.y_m, room.y1 - inset.y_m)};
  piece.size = scale * Point2{random.uniform(0.7, 1.6), random.uniform(0.5, 0.9)};
  piece.along = direction(random.uniform(0, kPi));
  piece.at_side = {random.below(2) == 0 ? room.x0 + 0.3 : room.x1 - 0.3, piece.at.y_m};
  piece.thing = random.below(4);
  return piece;
}

void Builder::put(const Piece& piece) {
  if (near_doorway(piece.thing == 1 ? piece.at_side : piece.at)) {
    return;
  }
  if (piece.thing == 0) {
    disc(piece.at, piece.size.x_m / 5);
  } else if (piece.thing == 1) {  // a cupboard with its back to a side wall
    box(piece.at_side, {0.45, piece.size.x_m});
  } else {
    box(piece.at, piece.size, piece.thing == 2 ? piece.along : Point2{1, 0});
  }
}

void Builder::furnish(const Rect& room, RandomStream& random) {
  const auto count = 1 + static_cast<int>(room.width() * room.depth() / 8);
  for (int i = 0; i < count; ++i) {
    const Piece piece = draw_piece(room, random);
    if (cleared_) {
      continue;
    }
    if (!rearranging_ || rearranging_->uniform() >= rearranged_share_) {
      put(piece);
    } else if (rearranging_->below(2) == 0) {
      put(draw_piece(room, *rearranging_));
    }
  }
}

void Builder::change_furniture(const Plot& plot) {
  cleared_ = plot.cleared;
  rearranged_share_ = plot.rearranged_share;
  if (rearranged_share_ > 0) {
    rearranging_.emplace(plot.seed, "world/rearranged");
  }
}

World Builder::finish() { return std::move(world_); }

bool Builder::near_doorway(Point2 at) const {
  return std::any_of(doorways_.begin(), doorways_.end(), [&](Point2 doorway) {
    const Point2 way = doorway - at;
    return way.x_m * way.x_m + way.y_m * way.y_m < 1.4 * 1.4;
  });
}

Gap door(double wall_length_m, RandomStream& random) {
  const double from = random.uniform(0.3, std::max(0.3, wall_length_m - kDoorWidth - 0.3));
  return {from, from + kDoorWidth};
}

}  // namespace gridmerge::worlds
