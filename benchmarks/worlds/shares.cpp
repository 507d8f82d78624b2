#include "worlds/shares.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "worlds/lidar.hpp"
#include "worlds/point_fit.hpp"
#include "worlds/survey.hpp"

namespace gridmerge::worlds {
namespace {

constexpr double kCloseEnough = 0.03;

Pose2 first_world_from_second(const SceneOptions& options) {
  constexpr double kFarAway = 1000;  // [m]
  const bool one_world = options.relation == "overlap" || options.relation == "two_ends";
  return {one_world ? 0 : kFarAway, 0, 0};
}

/// Robots that go the other's way, one behind the other.
std::vector<Track> seen_robots(const Track& other, int count) {
  constexpr std::size_t kBehind = 12;  // [scans]
  std::vector<Track> tracks;
  for (int i = 0; i < count; ++i) {
    Track late = other;
    std::vector<Pose2>& stops = late.world_from_robot;
    stops.insert(stops.begin(), kBehind * static_cast<std::size_t>(i), stops.front());
    tracks.push_back(std::move(late));
  }
  return tracks;
}

Survey survey_among(const Flight& flight, const Track& other, const SceneOptions& options) {
  const std::vector<Track> tracks = seen_robots(other, options.robots_seen);
  std::vector<const Track*> seen;
  for (const Track& track : tracks) {
    seen.push_back(&track);
  }
  return survey(flight, seen, options);
}

double root_mean_square(double a, double b) { return std::sqrt((a * a + b * b) / 2); }

/// What a robot with that share would know, roughly.
class Outlook {
 public:
  Outlook(const SceneOptions& options, Role role) : coarse_(options), role_(role) {
    coarse_.mapping = "known";
    coarse_.drift_m = coarse_.drift_deg = 0;
    coarse_.roll_deg = 0;
    coarse_.robots_seen = 0;
    coarse_.size_cells = 0;
    coarse_.probabilistic = false;
    coarse_.range_m = options.lidar == "custom" ? options.range_m : lidar_model(options.lidar).range_m;
    coarse_.lidar = "custom";
    coarse_.range_noise_m = coarse_.dropout = 0;
    coarse_.beam_step_deg = 1.5;
    coarse_.scan_step_m = 1;
    coarse_.resolution_m = 0.25;
  }

  [[nodiscard]] const Survey& at(double share, double flown = 1) {
    const auto known =
        std::find_if(tried_.begin(), tried_.end(), [&](const Try& t) { return t.share == share && t.flown == flown; });
    if (known != tried_.end()) {
      return known->survey;
    }
    (role_ == Role::kTarget ? coarse_.target_share : coarse_.source_share) = share;
    tried_.push_back({share, flown, survey(flight_of(coarse_, role_, flown), {}, coarse_)});
    return tried_.back().survey;
  }

  /// Those tried with the whole way flown.
  [[nodiscard]] std::vector<double> shares() const {
    std::vector<double> shares;
    for (const Try& one : tried_) {
      if (one.flown == 1) {
        shares.push_back(one.share);
      }
    }
    return shares;
  }

 private:
  struct Try {
    double share = 0;
    double flown = 1;
    Survey survey;
  };

  SceneOptions coarse_;
  Role role_;
  std::vector<Try> tried_;
};

struct Shares {
  double target = 0;
  double source = 0;
  double target_flown = 1;
  double overlap = 0;  // as judged from coarse maps
};

bool same(const Shares& a, const Shares& b) { return a.target == b.target && a.source == b.source; }

/// What unequal shares cost, as a lack of overlap.
double unlikeness(const Shares& shares) { return 0.02 * std::abs(shares.target - shares.source); }

class ShareSearch {
 public:
  explicit ShareSearch(const SceneOptions& options)
      : target_(options, Role::kTarget), source_(options, Role::kSource) {}

  /// What comes nearest to an overlap. Never the same twice.
  [[nodiscard]] Shares next_for(double overlap) {
    halve_to(overlap);
    Shares best = best_of_tried(overlap);
    if (std::abs(best.overlap - overlap) > kCloseEnough / 3) {
      best = nearer(overlap, best, cut_short(least_above(overlap), overlap));
    }
    drawn_.push_back(best);
    return best;
  }

  /// The same shares, with the target's way cut short so that they overlap as much.
  [[nodiscard]] Shares cut_short(const Shares& shares, double overlap) {
    constexpr double kLeastFlown = 0.4;
    constexpr int kHalvings = 7;
    Shares cut = shares;
    double low = kLeastFlown;
    double high = 1;
    for (int i = 0; i < kHalvings; ++i) {
      cut.target_flown = (low + high) / 2;
      cut.overlap = judged(cut);
      (cut.overlap < overlap ? low : high) = cut.target_flown;
    }
    return cut;
  }

 private:
  [[nodiscard]] double judged(const Shares& shares) {
    const Survey& target = target_.at(shares.target, shares.target_flown);
    const Survey& source = source_.at(shares.source);
    return overlap_of(target.map, source.map, inverse(target.world_from_map) * source.world_from_map);
  }

  /// Tries equal shares ever closer to the overlap.
  void halve_to(double overlap) {
    constexpr int kHalvings = 7;
    double low = 0.05;
    double high = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      (judged({middle, middle}) < overlap ? low : high) = middle;
    }
  }

  /// visit(shares) for all pairs of the shares tried.
  template <typename Visit>
  void for_pairs(Visit&& visit) {
    for (const double target : target_.shares()) {
      for (const double source : source_.shares()) {
        Shares shares = {target, source};
        shares.overlap = judged(shares);
        visit(shares);
      }
    }
  }

  [[nodiscard]] bool was_drawn(const Shares& shares) const {
    return std::any_of(drawn_.begin(), drawn_.end(), [&](const Shares& other) { return same(shares, other); });
  }

  /// Of two that were not drawn yet, the better one.
  [[nodiscard]] Shares nearer(double overlap, const Shares& one, const Shares& other) const {
    const auto off = [&](const Shares& shares) {
      return was_drawn(shares) ? 3 : std::abs(shares.overlap - overlap) + unlikeness(shares);
    };
    return off(other) < off(one) ? other : one;
  }

  [[nodiscard]] Shares best_of_tried(double overlap) {
    Shares best = {.overlap = 2};
    for_pairs([&](const Shares& shares) { best = nearer(overlap, best, shares); });
    return best;
  }

  /// Of those that overlap enough, the pair that overlaps least.
  [[nodiscard]] Shares least_above(double overlap) {
    Shares least = {.target = 1, .source = 1};
    least.overlap = judged(least);
    for_pairs([&](const Shares& shares) {
      const bool less = shares.overlap + unlikeness(shares) < least.overlap + unlikeness(least);
      least = shares.overlap >= overlap && less ? shares : least;
    });
    return least;
  }

  Outlook target_;
  Outlook source_;
  std::vector<Shares> drawn_;
};

}  // namespace

namespace {

/// Where the target's robot and the source's came by one place, the source's surroundings as each believed them.
std::vector<PointMatch> met_places(const Flight& target_flight, const Survey& target, const Flight& source_flight,
                                   const Survey& source) {
  constexpr double kNear = 4;    // [m] between the two
  constexpr double kAround = 2;  // [m] from the source's robot
  std::vector<PointMatch> matches;
  for (std::size_t j = 0; j < source.map_from_robot.size(); ++j) {
    const Pose2& there = source_flight.track.world_from_robot[j];
    for (std::size_t i = 0; i < target.map_from_robot.size(); ++i) {
      const Pose2& here = target_flight.track.world_from_robot[i];
      const Point2 way = there.translation() - here.translation();
      if (way.x_m * way.x_m + way.y_m * way.y_m > kNear * kNear) {
        continue;
      }
      const Pose2 target_map_from_there = target.map_from_robot[i] * (inverse(here) * there);
      for (const Point2& at : {Point2{kAround, 0}, Point2{-kAround, 0}, Point2{0, kAround}, Point2{0, -kAround}}) {
        matches.push_back({.in_target = target_map_from_there * at, .in_source = source.map_from_robot[j] * at});
      }
    }
  }
  return matches;
}

}  // namespace

MapPair draw_with_shares(const SceneOptions& options, double target_flown) {
  const Flight target_flight = flight_of(options, Role::kTarget, target_flown);
  const Flight source_flight = flight_of(options, Role::kSource);
  Survey target = survey_among(target_flight, source_flight.track, options);
  Survey source = survey_among(source_flight, target_flight.track, options);
  const std::vector<PointMatch> met = options.relation == "overlap"
                                          ? met_places(target_flight, target, source_flight, source)
                                          : std::vector<PointMatch>{};
  MapPair pair = {
      .target = std::move(target.map),
      .source = std::move(source.map),
      .target_from_source = inverse(target.world_from_map) * first_world_from_second(options) * source.world_from_map,
      .met_target_from_source = {},
      .truth_is_same = options.relation == "overlap",
      .target_share = options.target_share,
      .source_share = options.source_share,
      .target_flown = target_flown,
      .pose_error_m = root_mean_square(target.pose_error_m, source.pose_error_m),
      .pose_error_rad = root_mean_square(target.pose_error_rad, source.pose_error_rad)};
  pair.met_target_from_source = pair.target_from_source;
  if (!met.empty()) {
    const PointFit fit = fit_points(met);
    pair.met_target_from_source = fit.target_from_source;
    pair.met_residual_m = fit.residual_m;
  }
  pair.overlap = overlap_of(pair.target, pair.source, pair.met_target_from_source);
  return pair;
}

MapPair draw_with_overlap(const SceneOptions& options) {
  constexpr int kMostDrawn = 4;
  ShareSearch search(options);
  Shares shares = search.next_for(options.wanted_overlap);
  MapPair best;
  for (int drawn = 0; drawn < kMostDrawn; ++drawn) {
    SceneOptions settled = options;
    settled.target_share = shares.target;
    settled.source_share = shares.source;
    MapPair pair = draw_with_shares(settled, shares.target_flown);
    const double excess = pair.overlap - options.wanted_overlap;
    const double aim = options.wanted_overlap - (pair.overlap - shares.overlap);  // on coarse maps
    if (drawn == 0 || std::abs(excess) < std::abs(best.overlap - options.wanted_overlap)) {
      best = std::move(pair);
    }
    if (std::abs(excess) <= kCloseEnough) {
      break;
    }
    const bool longer_or_shorter = excess > 0 || shares.target_flown < 1;
    const Shares cut = longer_or_shorter ? search.cut_short(shares, aim) : shares;
    shares = std::abs(cut.overlap - aim) < kCloseEnough / 2 ? cut : search.next_for(aim);
  }
  return best;
}

}  // namespace gridmerge::worlds
