#include "methods/som/posts.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/base/disjoint_sets.hpp"

namespace gridmerge::som {
namespace {

/// For each sample, the name of the group of samples whose cells of level 1 touch.
std::vector<std::uint32_t> touching(const std::vector<WallSample>& samples, const MapLevel& level) {
  constexpr std::uint32_t kNone = 0xffffffffU;
  std::vector<std::uint32_t> sample_in(level.state.size(), kNone);
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const auto [column, row] = level.cell_at(samples[i].at);
    sample_in[level.offset(column, row)] = i;
  }
  DisjointSets groups(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const auto [column, row] = level.cell_at(samples[i].at);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (level.contains(column + dx, row + dy) && sample_in[level.offset(column + dx, row + dy)] != kNone) {
          groups.unite(i, sample_in[level.offset(column + dx, row + dy)]);
        }
      }
    }
  }
  std::vector<std::uint32_t> names(samples.size());
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    names[i] = groups.name_of(i);
  }
  return names;
}

struct Extent {
  Point2f low{1e9F, 1e9F};
  Point2f high{-1e9F, -1e9F};

  void take_in(Point2f p) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  [[nodiscard]] double width() const { return static_cast<double>(std::max(high.x_m - low.x_m, high.y_m - low.y_m)); }
};

}  // namespace

Posts posts_of(const PreparedMap& map, double widest_m) {
  const std::vector<WallSample> samples = wall_samples(map);
  if (samples.empty()) {
    return {};
  }
  const std::vector<std::uint32_t> names = touching(samples, map.level(1));
  std::vector<Extent> extent(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    extent[names[i]].take_in(samples[i].at);
  }
  std::vector<WallSample> small;
  std::vector<std::uint32_t> owner;
  float all_m = 0;
  float small_m = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    all_m += samples[i].weight;
    if (extent[names[i]].width() <= widest_m) {
      small.push_back(samples[i]);
      owner.push_back(names[i]);
      small_m += samples[i].weight;
    }
  }
  Posts posts{.points = summarised(small, owner, samples.size()).points, .share = static_cast<double>(small_m / all_m)};
  for (ClusterPoint& one : posts.points) {
    one.normal = {};
    one.sided = false;
  }
  std::stable_sort(posts.points.begin(), posts.points.end(),
                   [](const ClusterPoint& a, const ClusterPoint& b) { return a.weight > b.weight; });
  return posts;
}

std::vector<double> even_turns(double step_rad, const std::optional<PoseWindow>& window) {
  const double centre = window ? window->centre.theta_rad : 0;
  const double reach = window ? std::min(window->angle_rad, kPi) : kPi;
  const int each_way = static_cast<int>(reach / step_rad);
  std::vector<double> turns;
  for (int k = -each_way; k <= each_way; ++k) {
    turns.push_back(wrap_angle(centre + k * step_rad));
  }
  return turns;
}

}  // namespace gridmerge::som
