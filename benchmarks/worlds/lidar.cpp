#include "worlds/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

constexpr double kWallHeight = 3;  // [m]

double cross(Point2 a, Point2 b) { return a.x_m * b.y_m - a.y_m * b.x_m; }
double dot(Point2 a, Point2 b) { return a.x_m * b.x_m + a.y_m * b.y_m; }

/// From the plane in which the lidar turns to the horizontal plane below it, and the heights.
class Tilt {
 public:
  explicit Tilt(const Attitude& attitude)
      : roll_(direction(attitude.roll_rad)),
        pitch_(direction(attitude.pitch_rad)),
        per_roll_(1 / roll_.x_m),
        per_pitch_(1 / pitch_.x_m),
        height_m_(attitude.height_m) {}

  [[nodiscard]] Point2 horizontal(Point2 in_lidar) const {
    return {pitch_.x_m * in_lidar.x_m + pitch_.y_m * roll_.y_m * in_lidar.y_m, roll_.x_m * in_lidar.y_m};
  }
  /// Where a vertical through the point meets the lidar's plane.
  [[nodiscard]] Point2 in_lidar(Point2 horizontal) const {
    const double y_m = horizontal.y_m * per_roll_;
    return {(horizontal.x_m - pitch_.y_m * roll_.y_m * y_m) * per_pitch_, y_m};
  }
  /// Above the lidar's centre, of a point in its plane.
  [[nodiscard]] double rise_m(Point2 in_lidar) const {
    return pitch_.x_m * roll_.y_m * in_lidar.y_m - pitch_.y_m * in_lidar.x_m;
  }
  [[nodiscard]] double height_m() const { return height_m_; }

 private:
  Point2 roll_;  // cosine and sine
  Point2 pitch_;
  double per_roll_;  // 1 / cosine
  double per_pitch_;
  double height_m_;
};

/// What every beam has met so far. An obstacle is shown only to the beams that can hit it, plus one on either side, so
/// that the rounding of an angle decides nothing. Obstacles are vertical, so that it does not matter in which plane
/// they are cut: what is met lies in the lidar's.
class Turn {
 public:
  Turn(const std::vector<Point2>& beams, double range_m, const Tilt& tilt)
      : beams_(beams), range_m_(range_m), tilt_(tilt), ranges_m_(beams.size(), range_m) {}

  /// By beam; the range given at first where nothing was met.
  [[nodiscard]] const std::vector<double>& ranges_m() const { return ranges_m_; }

  /// A wall, in the horizontal plane.
  void meet(Point2 from, Point2 to) {
    from = tilt_.in_lidar(from);
    to = tilt_.in_lidar(to);
    const double turn = cross(from, to);  // twice the area of the triangle seen
    if (out_of_range(from, to, turn)) {
      return;
    }
    if (turn < 0) {
      std::swap(from, to);
    }
    const double begin_rad = std::atan2(from.y_m, from.x_m);
    const double span_rad = wrap_angle(std::atan2(to.y_m, to.x_m) - begin_rad);
    if (std::abs(turn) < 1e-12 || span_rad < 0) {
      return;  // seen edge-on
    }
    for_beams(begin_rad, span_rad, [&](Point2 beam) {
      const bool within = cross(from, beam) >= 0 && cross(beam, to) >= 0;
      return within ? std::abs(turn) / cross(beam, to - from) : -1.0;
    });
  }

  /// A column, in the horizontal plane.
  void meet(const Disc& disc) {
    const double far2 = dot(disc.centre, disc.centre);
    const double reach_m = kSlack * range_m_ + disc.radius_m;
    if (far2 <= disc.radius_m * disc.radius_m || far2 > reach_m * reach_m) {
      return;  // the lidar stands in it, or far away
    }
    const double sine = disc.radius_m / std::sqrt(far2);
    const double cosine = std::sqrt(1 - sine * sine);
    const Point2 across = {-disc.centre.y_m, disc.centre.x_m};
    const Point2 right = tilt_.in_lidar(cosine * disc.centre - sine * across);
    const Point2 left = tilt_.in_lidar(cosine * disc.centre + sine * across);
    const double begin_rad = std::atan2(right.y_m, right.x_m);
    for_beams(begin_rad, wrap_angle(std::atan2(left.y_m, left.x_m) - begin_rad), [&](Point2 beam) {
      const Point2 shadow = tilt_.horizontal(beam);
      const double shorter2 = dot(shadow, shadow) / dot(beam, beam);  // 1 where the lidar is level
      const double aside = cross(shadow, disc.centre);
      const double inside2 = shorter2 * (disc.radius_m * disc.radius_m) - aside * aside;
      return inside2 >= 0 ? (dot(shadow, disc.centre) - std::sqrt(inside2)) / shorter2 : -1.0;
    });
  }

  /// The ground, and the sky above the walls.
  void meet_ground() {
    for (std::size_t beam = 0; beam < beams_.size(); ++beam) {
      const double rise = tilt_.rise_m(beams_[beam]);
      if (tilt_.height_m() + rise * ranges_m_[beam] > kWallHeight) {
        ranges_m_[beam] = range_m_;
      }
      if (rise < 0) {
        ranges_m_[beam] = std::min(ranges_m_[beam], -tilt_.height_m() / rise);
      }
    }
  }

 private:
  static constexpr double kSlack = 1.001;  // so that rounding never hides what is just within range

  [[nodiscard]] bool out_of_range(Point2 from, Point2 to, double turn) const {
    const double reach_m = kSlack * range_m_;
    const Point2 span = to - from;
    return (from.x_m > reach_m && to.x_m > reach_m) || (from.x_m < -reach_m && to.x_m < -reach_m) ||
           (from.y_m > reach_m && to.y_m > reach_m) || (from.y_m < -reach_m && to.y_m < -reach_m) ||
           turn * turn > reach_m * reach_m * dot(span, span);
  }

  template <typename Range>
  void for_beams(double begin_rad, double span_rad, Range&& range_of) {
    const auto count = static_cast<int>(beams_.size());
    const double step_rad = 2 * kPi / count;
    const auto first = static_cast<int>(std::floor(begin_rad / step_rad));
    const int last = std::min(static_cast<int>(std::ceil((begin_rad + span_rad) / step_rad)), first + count - 1);
    auto index = static_cast<std::size_t>(((first % count) + count) % count);
    for (int beam = first; beam <= last; ++beam) {
      const double range_m = range_of(beams_[index]);
      if (range_m > 0 && range_m < ranges_m_[index]) {
        ranges_m_[index] = range_m;
      }
      index = index + 1 < beams_.size() ? index + 1 : 0;
    }
  }

  const std::vector<Point2>& beams_;
  double range_m_;
  const Tilt& tilt_;
  std::vector<double> ranges_m_;
};

struct NamedModel {
  const char* name;
  LidarModel model;
};

std::vector<NamedModel> known_models() {
  return {{"rplidar_a3",
           {.range_m = 25, .step_rad = radians(0.225), .noise_m = 0.005, .noise_share = 0.005, .nearest_m = 0.2}},
          {"hokuyo_utm30lx",
           {.range_m = 30,
            .step_rad = radians(0.25),
            .noise_m = 0.01,
            .field_of_view_rad = radians(270),
            .noise_share = 0.001,
            .nearest_m = 0.1}},
          {"hokuyo_urg04lx",
           {.range_m = 5.6,
            .step_rad = radians(360.0 / 1024),
            .noise_m = 0.005,
            .field_of_view_rad = radians(240),
            .noise_share = 0.005,
            .nearest_m = 0.06}}};
}

}  // namespace

std::vector<std::string> lidar_names() {
  std::vector<std::string> names;
  for (const NamedModel& known : known_models()) {
    names.emplace_back(known.name);
  }
  return names;
}

LidarModel lidar_model(std::string_view name) {
  std::string names;
  for (const NamedModel& known : known_models()) {
    if (name == known.name) {
      return known.model;
    }
    names += (names.empty() ? "" : ", ") + std::string(known.name);
  }
  throw std::invalid_argument("lidar '" + std::string(name) + "' is not one of: " + names);
}

Lidar::Lidar(const LidarModel& model) : model_(model) {
  const int count = std::max(1, static_cast<int>(std::lround(2 * kPi / model.step_rad)));
  for (int beam = 0; beam < count; ++beam) {
    beams_.push_back(direction(2 * kPi * beam / count));
  }
  widest_ = static_cast<int>(std::floor(model.field_of_view_rad * count / (4 * kPi) + 1e-6));
}

bool Lidar::has(std::size_t beam) const { return static_cast<int>(std::min(beam, beams_.size() - beam)) <= widest_; }

std::vector<Point2> Lidar::scan(const World& world, const Share& sight, const Pose2& world_from_lidar,
                                RandomStream& random, const Attitude& attitude, const std::vector<Disc>& others) const {
  const Point2 ahead = direction(world_from_lidar.theta_rad);
  const Point2 here = world_from_lidar.translation();
  const auto seen_from_here = [&](Point2 point) -> Point2 {
    const Point2 way = point - here;
    return {dot(ahead, way), cross(ahead, way)};
  };
  const Tilt tilt(attitude);
  Turn turn(beams_, model_.range_m, tilt);
  for (const Segment& wall : world.walls) {
    turn.meet(seen_from_here(wall.from), seen_from_here(wall.to));
  }
  for (const std::vector<Disc>* discs : {&world.discs, &others}) {
    for (const Disc& disc : *discs) {
      turn.meet({seen_from_here(disc.centre), disc.radius_m});
    }
  }
  turn.meet_ground();
  std::vector<Point2> hits;
  for (std::size_t beam = 0; beam < beams_.size(); ++beam) {
    if (!has(beam)) {
      continue;
    }
    const double range_m = turn.ranges_m()[beam];
    const double noise_m = snapped(std::max(model_.noise_m, model_.noise_share * range_m) * random.normal());
    const bool lost = random.uniform() < model_.dropout;
    const Point2 shadow = tilt.horizontal(beams_[beam]);
    const double hit_x_m = here.x_m + range_m * (ahead.x_m * shadow.x_m - ahead.y_m * shadow.y_m);
    if (range_m >= model_.nearest_m && range_m < model_.range_m && !lost && sight.contains(hit_x_m)) {
      hits.push_back(std::max(0.0, range_m + noise_m) * (attitude.levelled ? shadow : beams_[beam]));
    }
  }
  return hits;
}

}  // namespace gridmerge::worlds
