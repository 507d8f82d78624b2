#pragma once
/// What every kind of world is put together from: walls with doors, boxes, discs, furniture.
#include <optional>
#include <vector>

#include "gridmerge/base/random.hpp"
#include "worlds/kinds.hpp"
#include "worlds/world.hpp"

namespace gridmerge::worlds {

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
  Builder(double length_m, double depth_m);

  /// A box given by its centre, its size and the direction of its length.
  void box(Point2 centre, Point2 size, Point2 along = {1, 0});

  /// A wall of the usual thickness, with openings in ascending order.
  void wall(Point2 from, Point2 to, const std::vector<Gap>& gaps = {});

  void outer_walls();

  /// A face without a thickness.
  void face(Point2 from, Point2 to) { world_.walls.push_back({from, to}); }
  void disc(Point2 centre, double radius_m) { world_.discs.push_back({centre, radius_m}); }
  void in_rock() { world_.rock = true; }
  void winds() { world_.winding = true; }
  void place(Point2 at) { world_.places.push_back(at); }

  /// Tables, cupboards, columns, clear of the doorways there are: no two rooms alike.
  void furnish(const Rect& room, RandomStream& random);
  /// From now on furniture is moved within its room or taken away, as the plot says.
  void change_furniture(const Plot& plot);

  [[nodiscard]] double depth_m() const { return world_.depth_m; }
  [[nodiscard]] const std::vector<Point2>& doorways() const { return doorways_; }
  [[nodiscard]] World finish();

 private:
  /// One piece of furniture, as it is drawn.
  struct Piece {
    Point2 at;
    Point2 size;
    Point2 along;
    Point2 at_side;
    std::uint32_t thing = 0;
  };
  [[nodiscard]] static Piece draw_piece(const Rect& room, RandomStream& random);
  void put(const Piece& piece);
  [[nodiscard]] bool near_doorway(Point2 at) const;

  World world_;
  std::vector<Point2> doorways_;
  double rearranged_share_ = 0;
  bool cleared_ = false;
  std::optional<RandomStream> rearranging_;
};

/// A door somewhere in a wall of that length, off the corners.
[[nodiscard]] Gap door(double wall_length_m, RandomStream& random);

}  // namespace gridmerge::worlds
