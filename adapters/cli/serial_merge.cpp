#include "cli/serial_merge.hpp"

#include <algorithm>
#include <numeric>

#include "cli/text.hpp"

namespace gridmerge::cli {
namespace {

/// How many known cells of the one map fall on known cells of the other; every few are looked at.
std::size_t shared_cells(const OccupancyGrid& fixed, const OccupancyGrid& moving, const Pose2& fixed_from_moving) {
  constexpr int kStep = 4;
  std::size_t count = 0;
  for (int row = 0; row < moving.geometry.height; row += kStep) {
    for (int column = 0; column < moving.geometry.width; column += kStep) {
      if (moving.at({column, row}) != kUnknown) {
        const CellIndex cell = fixed.geometry.cell_at(fixed_from_moving * moving.geometry.cell_centre({column, row}));
        count += fixed.geometry.contains(cell) && fixed.at(cell) != kUnknown ? 1 : 0;
      }
    }
  }
  return count;
}

/// The pose's own covariance is that against the maps it was laid on, as if they lay exactly. It lies mostly on one of
/// them: that one's covariance comes on top.
PoseEstimate composed(const SerialMergeInput& input, const std::vector<MergedMap>& merged, std::size_t map,
                      const PoseEstimate& merged_from_map) {
  const auto shared_with = [&](const MergedMap& one) {
    return shared_cells(input.maps[one.map], input.maps[map], inverse(one.merged_from_map.pose) * merged_from_map.pose);
  };
  const MergedMap* under = &merged.front();
  std::size_t most = shared_with(*under);
  for (const MergedMap& one : merged) {
    if (const std::size_t shared = shared_with(one); shared > most) {
      most = shared;
      under = &one;
    }
  }
  const PoseEstimate under_from_merged{inverse(under->merged_from_map.pose), PoseCovariance::Zero()};
  return compose(under->merged_from_map, compose(under_from_merged, merged_from_map));
}

/// One try after the other, with all that it needs to know of the last ones.
class SerialMerger {
 public:
  SerialMerger(const SerialMergeInput& input, const RunContext& context)
      : input_(input), context_(context), reasons_(input.maps.size(), "stopped before it was tried") {}

  SerialMerge run() {
    std::vector<std::size_t> waiting(input_.maps.size());
    std::iota(waiting.begin(), waiting.end(), std::size_t{0});
    while (waiting.size() > 1 && result_.merged.size() < 2 && !stopped()) {
      const std::size_t start = waiting.front();
      waiting.erase(waiting.begin());
      result_.merged = {{start, {{}, PoseCovariance::Zero()}}};
      add_what_fits(waiting);
      reasons_[start] = reason_to_drop_start(waiting);
    }
    if (result_.merged.size() < 2) {
      result_.merged.clear();
    }
    for (std::size_t map = 0; map < input_.maps.size(); ++map) {
      const auto is_map = [&](const MergedMap& one) { return one.map == map; };
      if (std::none_of(result_.merged.begin(), result_.merged.end(), is_map)) {
        result_.left_out.push_back({map, reasons_[map]});
      }
    }
    result_.stopped = stopped();
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool stopped() const { return context_.stop.stop_requested(); }

  /// Rounds over the waiting maps, as long as there is one that has not been tried on all that are merged by now.
  void add_what_fits(std::vector<std::size_t>& waiting) {
    OccupancyGrid target = input_.maps[result_.merged.front().map];
    std::vector<std::size_t> tried_on(input_.maps.size(), 0);  // by map: how many were merged then
    const auto next = [&] {
      return std::find_if(waiting.begin(), waiting.end(),
                          [&](std::size_t map) { return tried_on[map] < result_.merged.size(); });
    };
    for (auto map = next(); map != waiting.end() && !stopped(); map = next()) {
      tried_on[*map] = result_.merged.size();
      if (add_if_it_fits(target, *map)) {
        waiting.erase(map);
        target = fuse(placed_maps(input_.maps, result_.merged), input_.fuse, context_.num_threads);
      } else {
        std::rotate(map, map + 1, waiting.end());
      }
    }
    std::sort(waiting.begin(), waiting.end());
  }

  bool add_if_it_fits(const OccupancyGrid& target, std::size_t map) {
    Alignment alignment = align({target, input_.maps[map], input_.prior}, input_.methods, input_.options, context_);
    reasons_[map] = status_of(alignment.outcome) + ": " + reasons_of(alignment).front();
    std::vector<std::size_t> targets;
    for (const MergedMap& one : result_.merged) {
      targets.push_back(one.map);
    }
    const bool fits = alignment.outcome == Outcome::kMerged;
    if (fits) {
      const PoseEstimate& pose = alignment.hypotheses.front().target_from_source;
      result_.merged.push_back({map, composed(input_, result_.merged, map, pose)});
    }
    result_.attempts.push_back({std::move(targets), map, std::move(alignment)});
    return fits;
  }

  /// What all others were told, where that is one and the same (the start is empty, say).
  [[nodiscard]] std::string reason_to_drop_start(const std::vector<std::size_t>& waiting) const {
    const bool all_the_same = std::all_of(waiting.begin(), waiting.end(),
                                          [&](std::size_t map) { return reasons_[map] == reasons_[waiting.front()]; });
    return waiting.size() > 1 && all_the_same ? reasons_[waiting.front()] : "no other map fits it";
  }

  const SerialMergeInput& input_;
  const RunContext& context_;
  std::vector<std::string> reasons_;  ///< why a map is not merged, as last seen
  SerialMerge result_;
};

}  // namespace

SerialMerge merge_serially(const SerialMergeInput& input, const RunContext& context) {
  return SerialMerger(input, context).run();
}

std::vector<PlacedMap> placed_maps(const std::vector<OccupancyGrid>& maps, const std::vector<MergedMap>& merged) {
  std::vector<PlacedMap> placed;
  for (const MergedMap& one : merged) {
    placed.push_back({&maps[one.map], one.merged_from_map.pose});
  }
  return placed;
}

}  // namespace gridmerge::cli
