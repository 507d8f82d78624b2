#include "worlds/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "worlds/portable.hpp"

namespace gridmerge::worlds {
namespace {

double cross(Point2 a, Point2 b) { return a.x_m * b.y_m - a.y_m * b.x_m; }
double dot(Point2 a, Point2 b) { return a.x_m * b.x_m + a.y_m * b.y_m; }

/// What every beam has met so far. An obstacle is shown only to the beams that can hit it, plus one on either side, so
/// that the rounding of an angle decides nothing.
class Turn {
 public:
  Turn(const std::vector<Point2>& beams, double range_m) : beams_(beams), ranges_m_(beams.size(), range_m) {}

  /// By beam; the range given at first where nothing was met.
  [[nodiscard]] const std::vector<double>& ranges_m() const { return ranges_m_; }

  void meet(Point2 from, Point2 to) {
    const double turn = cross(from, to);  // twice the area of the triangle seen
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

  void meet(const Disc& disc) {
    const double far2 = dot(disc.centre, disc.centre);
    if (far2 <= disc.radius_m * disc.radius_m) {
      return;  // the lidar stands in it
    }
    const double half_rad = std::asin(disc.radius_m / std::sqrt(far2));
    for_beams(std::atan2(disc.centre.y_m, disc.centre.x_m) - half_rad, 2 * half_rad, [&](Point2 beam) {
      const double aside = cross(beam, disc.centre);
      const double inside2 = disc.radius_m * disc.radius_m - aside * aside;
      return inside2 >= 0 ? dot(beam, disc.centre) - std::sqrt(inside2) : -1.0;
    });
  }

 private:
  template <typename Range>
  void for_beams(double begin_rad, double span_rad, Range&& range_of) {
    const auto count = static_cast<int>(beams_.size());
    const double step_rad = 2 * kPi / count;
    const auto first = static_cast<int>(std::floor(begin_rad / step_rad));
    const int last = std::min(static_cast<int>(std::ceil((begin_rad + span_rad) / step_rad)), first + count - 1);
    for (int beam = first; beam <= last; ++beam) {
      const auto index = static_cast<std::size_t>(((beam % count) + count) % count);
      const double range_m = range_of(beams_[index]);
      if (range_m > 0 && range_m < ranges_m_[index]) {
        ranges_m_[index] = range_m;
      }
    }
  }

  const std::vector<Point2>& beams_;
  std::vector<double> ranges_m_;
};

}  // namespace

Lidar::Lidar(const LidarModel& model) : model_(model) {
  const int count = std::max(1, static_cast<int>(std::lround(2 * kPi / model.step_rad)));
  for (int beam = 0; beam < count; ++beam) {
    beams_.push_back(direction(2 * kPi * beam / count));
  }
}

std::vector<Point2> Lidar::scan(const World& world, const Share& sight, const Pose2& world_from_lidar,
                                RandomStream& random) const {
  const Point2 ahead = direction(world_from_lidar.theta_rad);
  const Point2 here = world_from_lidar.translation();
  const auto in_lidar = [&](Point2 point) -> Point2 {
    const Point2 way = point - here;
    return {dot(ahead, way), cross(ahead, way)};
  };
  Turn turn(beams_, model_.range_m);
  for (const Segment& wall : world.walls) {
    turn.meet(in_lidar(wall.from), in_lidar(wall.to));
  }
  for (const Disc& disc : world.discs) {
    turn.meet({in_lidar(disc.centre), disc.radius_m});
  }
  std::vector<Point2> hits;
  for (std::size_t beam = 0; beam < beams_.size(); ++beam) {
    const double noise_m = snapped(model_.noise_m * random.normal());
    const bool lost = random.uniform() < model_.dropout;
    const double range_m = turn.ranges_m()[beam];
    const double hit_x_m = here.x_m + range_m * (ahead.x_m * beams_[beam].x_m - ahead.y_m * beams_[beam].y_m);
    if (range_m < model_.range_m && !lost && sight.contains(hit_x_m)) {
      hits.push_back(std::max(0.0, range_m + noise_m) * beams_[beam]);
    }
  }
  return hits;
}

}  // namespace gridmerge::worlds
