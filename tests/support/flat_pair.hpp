#pragma once
/// One small pair of maps, prepared: what a method is tried on by itself.
#include <optional>

#include "gridmerge/align/merger.hpp"
#include "support/scenes.hpp"

namespace gridmerge {

/// The known pair "flat" in cells of 0.08 m.
struct FlatPair {
  worlds::MapPair pair;
  PreparedMap target;
  PreparedMap source;

  explicit FlatPair(int seed = 1);
  [[nodiscard]] AlignRequest request(const std::optional<PosePrior>& prior = {},
                                     const Population* carried = nullptr) const {
    return {.target = target, .source = source, .prior = prior, .carried = carried};
  }
  [[nodiscard]] Pose2 local_truth() const { return to_local(pair.target_from_source, target, source); }
  /// The truth, moved and turned at the source's centre.
  [[nodiscard]] Pose2 truth_off_by(double x_m, double y_m, double turn_deg) const;
  /// Whether a pose lies so near the truth.
  [[nodiscard]] bool right(const Pose2& target_from_source, double distance_m, double angle_deg) const;
  /// Whether the first candidate is right.
  [[nodiscard]] bool found_by(const Proposal& proposal, double distance_m = 0.3, double angle_deg = 2) const;
};

/// Seed 1, made once.
[[nodiscard]] const FlatPair& flat();

}  // namespace gridmerge
