#pragma once
/// What the best fit is worth on these very maps: held against the best fit of the source in a mirror.
#include <optional>
#include <vector>

#include "gridmerge/align/scored_pose.hpp"

namespace gridmerge {

/// Borrows the maps.
class Decoy {
 public:
  /// Sweeps over poses of the mirrored source (angles by 5 degrees, cells of 0.2 or 0.4 m) and climbs from the best of
  /// them in cells of 0.2 m: over all in the prior's fence, or, where there is none, at the third of the angles at
  /// which the walls of both maps run most alike.
  Decoy(const AlignRequest& request, const RunContext& context);

  /// The best smooth fit of the mirrored source [points of wall].
  [[nodiscard]] double best() const { return best_; }
  /// The best smooth fit of the source as it is, of those that these candidates climb to.
  [[nodiscard]] double fit_of(const std::vector<Candidate>& candidates, int num_threads = 1) const;
  /// The run was stopped before all angles were swept: the best is too low to be worth anything.
  [[nodiscard]] bool stopped() const { return stopped_; }

 private:
  const PreparedMap& target_;
  const PreparedMap& source_;
  std::optional<PoseWindow> window_;
  std::optional<WallFit> fit_;  ///< of the maps as they are
  double resolution_m_ = 0;
  double best_ = 0;
  bool stopped_ = false;
};

}  // namespace gridmerge
