#pragma once
/// Many maps, merged one after the other (seed Eq. 1.1, 1.2).
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/align/pipeline.hpp"
#include "gridmerge/fuse/fuse.hpp"

namespace gridmerge::cli {

struct SerialMergeInput {
  const std::vector<OccupancyGrid>& maps;  ///< borrowed, as all the rest
  std::optional<PosePrior> prior;          ///< where the second map lies in the first; for two maps only
  const Chooser& methods;
  const PipelineOptions& options;
  const FuseOptions& fuse;
};

/// A map that is part of the merged one. Its covariance is composed along the maps that it was laid on.
struct MergedMap {
  std::size_t map = 0;
  PoseEstimate merged_from_map;
};

struct LeftOutMap {
  std::size_t map = 0;
  std::string reason;
};

/// One alignment that was tried: of a map with all that were merged by then.
struct MergeAttempt {
  std::vector<std::size_t> targets;
  std::size_t source = 0;
  Alignment alignment;
};

struct SerialMerge {
  std::vector<MergedMap> merged;       ///< the first is the target, in whose frame all lie; empty: nothing merged
  std::vector<LeftOutMap> left_out;    ///< in the order given
  std::vector<MergeAttempt> attempts;  ///< in the order tried
  bool stopped = false;                ///< the stop token ended it early
};

/// Starts from the first map, adds what fits, and goes round again over the rest as long as something was added. Where
/// nothing fits the first map, it is left out, and the next one is the start. Every attempt lays the map on the fusion
/// of the merged maps themselves, so walls do not wear out.
/// @throws std::invalid_argument as align and fuse do
[[nodiscard]] SerialMerge merge_serially(const SerialMergeInput& input, const RunContext& context);

/// The merged maps where they lie, for `fuse`.
[[nodiscard]] std::vector<PlacedMap> placed_maps(const std::vector<OccupancyGrid>& maps,
                                                 const std::vector<MergedMap>& merged);

}  // namespace gridmerge::cli
