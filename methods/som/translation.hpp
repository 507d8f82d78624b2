#pragma once
/// Where one turned map lies on the other: clusters that face the same way vote, matched clusters pull.
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/grid/cluster_points.hpp"

namespace gridmerge::som {

/// Votes for every translation on a lattice, at one turn of the source.
struct VoteSurface {
  int width = 0;
  int height = 0;
  double cell_m = 0;
  Point2 lower_left;  ///< outer corner of cell (0, 0): of the source's local origin, in the target's local frame
  double angle_rad = 0;
  std::vector<float> votes;  ///< row-major

  [[nodiscard]] std::size_t offset(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] Point2 centre_of(int column, int row) const {
    return lower_left + Point2{(column + 0.5) * cell_m, (row + 0.5) * cell_m};
  }
};

/// Every pair of a target and a source cluster whose normals agree to within `facing_rad` votes for the translation
/// that puts one on the other, by the metres of wall they share. A wall slides along a wall, so straight walls make
/// ridges; where ridges of different directions cross, a pose stands out. Clusters without a normal vote among
/// themselves.
[[nodiscard]] VoteSurface translation_votes(std::span<const ClusterPoint> target, std::span<const ClusterPoint> source,
                                            double angle_rad, double facing_rad, double cell_m);

/// Local maxima inside the window, best first.
[[nodiscard]] std::vector<ScoredPose> vote_peaks(const VoteSurface& surface, const std::optional<PoseWindow>& window,
                                                 std::size_t at_most);

/// Which clusters of the two maps are one piece of wall, at a pose.
struct ClusterMatch {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< of the target's and the source's
  double distance_sum_m = 0;                                   ///< J, Eq. 2.13
};

/// Finds the nearest target cluster that faces the same way. Const after construction; borrows the clusters.
class ClusterMatcher {
 public:
  /// @param along_share  what a metre along the wall counts, where a metre across counts 1: neurons lie anywhere along
  ///                     a wall
  ClusterMatcher(std::span<const ClusterPoint> target, double reach_m, double facing_rad, double along_share);

  [[nodiscard]] ClusterMatch operator()(std::span<const ClusterPoint> source, const Pose2& pose) const;

  /// One step of iterative closest points: the pose that brings matched walls onto each other, across the target's
  /// walls with full weight and along them with `along_share`. The same pose where fewer than three match.
  [[nodiscard]] Pose2 step(std::span<const ClusterPoint> source, const Pose2& pose) const;

 private:
  std::span<const ClusterPoint> target_;
  float reach_;
  float least_cosine_;
  float along_share_;
  Point2f low_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_;  ///< of each square's members; one more at the end
  std::vector<std::uint32_t> members_;
};

}  // namespace gridmerge::som
