#include "page/failures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/parallel.hpp"
#include "map_server/raster_image.hpp"
#include "page/scene_picture.hpp"
#include "report/overlay.hpp"

namespace gridmerge::page {
namespace {

using study::Row;

double confidence_of(const Row& row) { return std::isfinite(row.confidence) ? row.confidence : 0; }

/// The failures of one set and one method, the most confident first, each pair's best before any pair's second.
std::vector<std::size_t> in_turn(std::span<const Row> rows, std::vector<std::size_t> group) {
  std::stable_sort(group.begin(), group.end(),
                   [&](std::size_t a, std::size_t b) { return confidence_of(rows[a]) > confidence_of(rows[b]); });
  std::map<std::string, int> seen;
  std::vector<std::pair<int, std::size_t>> turns;
  for (const std::size_t index : group) {
    turns.emplace_back(seen[rows[index].pair]++, index);
  }
  std::stable_sort(turns.begin(), turns.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::transform(turns.begin(), turns.end(), group.begin(), [](const auto& turn) { return turn.second; });
  return group;
}

/// What is shown first.
constexpr std::array<std::string_view, 3> kByGravity = {"false", "wrong", "missed"};

std::size_t gravity(const Row& row) {
  return static_cast<std::size_t>(std::find(kByGravity.begin(), kByGravity.end(), row.result) - kByGravity.begin());
}

/// Failures with a gravity in [first, last]: the first of every group, then the second of every group, and so on.
std::vector<std::size_t> spread(std::span<const Row> rows, std::size_t first, std::size_t last) {
  std::map<std::tuple<std::size_t, std::string, std::string, std::string, std::string>, std::vector<std::size_t>>
      groups;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    if (row.robots <= 2 && gravity(row) >= first && gravity(row) <= last) {
      groups[{gravity(row), row.set, row.method, row.profile, row.options}].push_back(i);
    }
  }
  std::size_t longest = 0;
  std::vector<std::vector<std::size_t>> ordered;
  for (auto& [name, group] : groups) {
    ordered.push_back(in_turn(rows, std::move(group)));
    longest = std::max(longest, ordered.back().size());
  }
  std::vector<std::size_t> all;
  for (std::size_t turn = 0; turn < longest; ++turn) {
    for (const std::vector<std::size_t>& group : ordered) {
      if (turn < group.size()) {
        all.push_back(group[turn]);
      }
    }
  }
  return all;
}

/// Both maps, the source at a pose of the target's frame; empty where that is not known.
std::string overlay_png(const PairMaps& maps, const Pose2& target_from_source, int max_side_px) {
  if (!std::isfinite(target_from_source.x_m + target_from_source.y_m + target_from_source.theta_rad)) {
    return {};
  }
  const Overlay overlay = draw_overlay({{{&maps.target, {}}, "target"}, {{&maps.source, target_from_source}, "source"}},
                                       {.max_side_px = max_side_px});
  return encode_png(overlay.image);
}

FailurePicture draw(const Row& row, const FailureOptions& options) {
  FailurePicture picture;
  picture.run = row.run;
  try {
    const PairMaps maps = options.maps_of(row);
    const bool has_pose = !row.figures.empty();
    if (has_pose) {
      picture.found = overlay_png(maps, {row.x_m, row.y_m, row.theta_rad}, options.max_side_px);
    }
    if (row.truth == "same") {
      const Pose2 truth{row.truth_x_m, row.truth_y_m, row.truth_theta_rad};
      picture.truth = overlay_png(maps, truth, options.max_side_px);
    }
    if (maps.tracks) {
      picture.scene = encode_png(draw_scene(*maps.tracks, options.max_side_px));
    }
  } catch (const InputError& error) {
    picture.note = error.what();
  }
  return picture;
}

}  // namespace

std::vector<std::size_t> choose_failures(std::span<const Row> rows, int most) {
  std::vector<std::size_t> chosen = spread(rows, 0, 1);
  const std::vector<std::size_t> missed = spread(rows, 2, 2);
  chosen.insert(chosen.end(), missed.begin(), missed.end());
  chosen.resize(std::min(chosen.size(), static_cast<std::size_t>(std::max(0, most))));
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&](std::size_t a, std::size_t b) { return gravity(rows[a]) < gravity(rows[b]); });
  return chosen;
}

std::vector<FailurePicture> draw_failures(std::span<const Row> rows, const FailureOptions& options) {
  const std::vector<std::size_t> chosen = choose_failures(rows, options.most);
  std::vector<FailurePicture> pictures(chosen.size());
  if (!options.maps_of) {
    return {};
  }
  parallel_for(chosen.size(), options.num_threads,
               [&](std::size_t i, std::size_t) { pictures[i] = draw(rows[chosen[i]], options); });
  return pictures;
}

}  // namespace gridmerge::page
