#include "methods/features/paper_features.hpp"

#include <utility>

#include "methods/features/feature_views.hpp"
#include "methods/features/keypoints.hpp"
#include "methods/features/rigid_ransac.hpp"

namespace gridmerge {
namespace {

/// How sure the node is of a pose (Brown & Lowe 2007, as OpenCV's stitching has it): more inliers than chance brings.
double confidence_of(std::size_t inliers, std::size_t matches) {
  return static_cast<double>(inliers) / (8 + 0.3 * static_cast<double>(matches));
}

}  // namespace

void PaperFeaturesOptions::describe(OptionList& list) {
  list.add("detector", detector, {"akaze", "orb"},
           {"", "Which of OpenCV's detectors and descriptors looks for keypoints.",
            "The thesis has ORB, later nodes AKAZE."})
      .add("max_keypoints", max_keypoints, 10, 100000,
           {"points", "Strongest keypoints of each map that are matched.", ""})
      .add("akaze_threshold", akaze_threshold, 1e-6, 1,
           {"", "Response from which AKAZE takes a spot for a keypoint.", ""})
      .add("ratio", ratio, 0.01, 1,
           {"", "A match counts where it is nearer than this share of the distance of the second nearest.", ""})
      .add("min_matches", min_matches, 2, 100000, {"matches", "With fewer matches there is no pose.", ""})
      .add("samples", samples, 1, 100000000, {"pairs", "Pairs of matches that RANSAC draws.", ""})
      .add("inlier_cells", inlier_cells, 0.1, 1000,
           {"cells", "Farthest that a match may be off and still agrees with a pose.", ""})
      .add("confidence", confidence, 0, 1000,
           {"", "Inliers over (8 + 0.3 matches) from which a pose is believed.",
            "Users of the nodes lower it to 0.3 for maps that overlap little."});
}

PaperFeaturesMerger::PaperFeaturesMerger(PaperFeaturesOptions options) : options_(std::move(options)) {
  require_valid(options_, "features (paper)");
}

MergerTraits PaperFeaturesMerger::traits() const {
  return {.stochastic = true, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal PaperFeaturesMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const PaperFeaturesOptions& o = options_;
  Proposal proposal;
  announce(context, "propose/match");
  if (context.stop.stop_requested()) {
    proposal.stopped = true;
    return proposal;
  }
  const KeypointMatches found = match_keypoints(request.target, request.source,
                                                {.detector = o.detector,
                                                 .image = MapImage::kBytes,
                                                 .level = 0,
                                                 .max_keypoints = o.max_keypoints,
                                                 .threshold = o.akaze_threshold,
                                                 .neighbours = 1,
                                                 .ratio = o.ratio});
  announce(context, "propose/ransac");
  SequentialPoses one;
  if (found.matches.size() >= static_cast<std::size_t>(o.min_matches)) {
    const RansacRules rules{.samples = o.samples,
                            .inlier_m = o.inlier_cells * request.target.resolution_m(),
                            .apart_m = 0,
                            .turn_rad = kPi};
    one = sequential_ransac(found.matches, rules, 1, request, context);
  }
  for (const RansacPose& pose : one.poses) {
    if (confidence_of(pose.inliers.size(), found.matches.size()) >= o.confidence) {
      proposal.candidates.push_back(
          {from_local(pose.pose, request.target, request.source), static_cast<double>(pose.inliers.size())});
    }
  }
  if (wants_views(context)) {
    show_matches(*context.trace, found, one.poses);
  }
  proposal.iterations = one.rounds;
  proposal.stopped = context.stop.stop_requested();
  return proposal;
}

}  // namespace gridmerge
