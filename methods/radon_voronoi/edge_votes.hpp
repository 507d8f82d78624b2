#pragma once
/// The translation between two Voronoi diagrams, for a given rotation: every pair of cells that could be the same place
/// votes for the shift that puts one on the other.
///
/// The 2-D cross-correlation of every edge of one map with every edge of the other, summed over all pairs of edges, is
/// the cross-correlation of the two skeletons; cells multiply only where their clearances and directions agree.
#include <vector>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/options.hpp"
#include "methods/radon_voronoi/radon.hpp"
#include "methods/radon_voronoi/voronoi.hpp"

namespace gridmerge::voronoi {

struct VoteOptions {
  double bin_m = 0.2;
  double blur_m = 0.2;
  double clearance_m = 0.1;
  double direction_deg = 20;
  double vertex_weight = 8;
  int max_ridge = 2000;
  int max_vertices = 400;

  void describe(OptionList& list);
};

/// Votes over the translations of the source's local origin, in the target's local frame.
struct VoteSurface {
  int width = 0;
  int height = 0;
  double bin_m = 0;
  Point2 lower_left;  ///< outer corner of bin (0, 0)
  std::vector<float> votes;
};

/// Room for the votes of two diagrams; empty where they cannot touch within the window.
[[nodiscard]] VoteSurface empty_surface(const Diagram& target, const Diagram& source, double angle_rad,
                                        const std::optional<PoseWindow>& window, double bin_m);

/// Adds to the bin that holds a translation; nothing outside the surface.
void cast(VoteSurface& surface, Point2 translation, double weight);

/// Spreads every vote to a Gaussian.
void blur(VoteSurface& surface, double sigma_m);

/// @param window  votes outside it are not counted; none: all that let the two diagrams touch count
[[nodiscard]] VoteSurface vote(const Diagram& target, const Diagram& source, const radon::Rotation& rotation,
                               const std::optional<PoseWindow>& window, const VoteOptions& options);

/// Local maxima, best first, to a fraction of a bin.
[[nodiscard]] std::vector<ScoredPose> peaks(const VoteSurface& surface, double angle_rad, std::size_t at_most);

/// Pairs of vertices that a pose puts on each other, within `within_m`: a point of the target, then the source's moved
/// there, and so on.
[[nodiscard]] std::vector<Point2> matched_vertices(const Diagram& target, const Diagram& source,
                                                   const Pose2& local_target_from_source, double within_m);

[[nodiscard]] View vote_view(const VoteSurface& surface, const std::vector<ScoredPose>& peaks);
[[nodiscard]] View match_view(const Diagram& target, const Diagram& source, const Pose2& local_target_from_source);

}  // namespace gridmerge::voronoi
