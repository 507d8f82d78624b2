#include "methods/features/features.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/features/feature_views.hpp"
#include "methods/features/keypoints.hpp"
#include "methods/features/rigid_ransac.hpp"

namespace gridmerge {
namespace {

constexpr PoseReach kNiche{0.6, radians(4)};

/// The finest level whose image is not larger than that.
int image_level(const AlignRequest& request, int max_side_cells) {
  const auto side = [&](int k) {
    const MapLevel& target = request.target.level(k);
    const MapLevel& source = request.source.level(k);
    return std::max({target.width, target.height, source.width, source.height});
  };
  int level = 0;
  while (level + 2 < PreparedMap::kLevels && side(level) > max_side_cells) {
    ++level;
  }
  return level;
}

/// What every detector finds, on two sizes of the maps. What is left out when stopped, is not there.
KeypointMatches all_matches(const FeaturesOptions& options, const AlignRequest& request, const RunContext& context) {
  KeypointMatches all;
  const int finest = image_level(request, options.max_side_cells);
  for (const std::string detector : {"akaze", "orb"}) {
    for (int level = finest; level <= finest + 1; ++level) {
      if ((options.detector == detector || options.detector == "both") && !context.stop.stop_requested()) {
        all.append(match_keypoints(request.target, request.source,
                                   {.detector = detector,
                                    .image = MapImage::kShading,
                                    .level = level,
                                    .max_keypoints = options.max_keypoints,
                                    .threshold = options.akaze_threshold,
                                    .neighbours = options.neighbours,
                                    .ratio = 1}));
      }
    }
  }
  return all;
}

}  // namespace

void FeaturesOptions::describe(OptionList& list) {
  list.add("detector", detector, {"akaze", "orb", "both"},
           {"", "Which of OpenCV's detectors and descriptors looks for keypoints.",
            "`both` finds most and takes longest."})
      .add("max_keypoints", max_keypoints, 10, 100000,
           {"points", "Strongest keypoints of each map, detector and size of image that are matched.",
            "Time grows with its square."})
      .add("akaze_threshold", akaze_threshold, 1e-6, 1,
           {"", "Response from which AKAZE takes a spot for a keypoint.", ""})
      .add("neighbours", neighbours, 1, 20,
           {"points", "A keypoint is matched with so many of those that look most like it.",
            "Raise it where many corners look alike; wrong matches grow with it."})
      .add("max_side_cells", max_side_cells, 100, 100000,
           {"cells", "Maps wider than this are looked at in halved resolution.", ""})
      .add("samples", samples, 1, 100000000, {"pairs", "Pairs of matches drawn for each hypothesis.", ""})
      .add("inlier_m", inlier_m, 0.01, 10, {"m", "Farthest that a match may be off and still agrees with a pose.", ""})
      .add("apart_m", apart_m, 0, 100,
           {"m", "Two matches nearer to each other than this are not made into a pose.", ""})
      .add("turn_deg", turn_deg, 0.1, 180,
           {"deg", "Farthest that a match's own turn may be off the pose's.", "180 leaves it out of account."})
      .add("hypotheses", hypotheses, 1, 10000,
           {"poses", "Rounds of RANSAC at the most; each takes the matches that the ones before have not used.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Poses proposed at the end.", "More give the Evaluator more to choose from, and cost time."});
  fit.describe(list);
}

FeaturesMerger::FeaturesMerger(FeaturesOptions options) : options_(std::move(options)) {
  require_valid(options_, "features");
}

MergerTraits FeaturesMerger::traits() const {
  return {.stochastic = true, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal FeaturesMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const FeaturesOptions& o = options_;
  const std::optional<PoseWindow> window = window_of(request);
  announce(context, "propose/match");
  const KeypointMatches found = all_matches(o, request, context);

  announce(context, "propose/ransac");
  const RansacRules rules{
      .samples = o.samples, .inlier_m = o.inlier_m, .apart_m = o.apart_m, .turn_rad = radians(o.turn_deg)};
  const SequentialPoses rounds = sequential_ransac(found.matches, rules, o.hypotheses, request, context);

  announce(context, "propose/polish");
  const WallFit fitness(request.target, request.source, 1, o.fit, 2000);
  std::vector<ScoredPose> poses(rounds.poses.size());
  parallel_for(poses.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    const Pose2& pose = rounds.poses[i].pose;
    poses[i] = context.stop.stop_requested() ? ScoredPose{pose, fitness(pose)}
                                             : climb(fitness, pose, {0.2, radians(1.5)}, {0.05, radians(0.3)}, window);
  });
  poses = distinct_poses(std::move(poses), kNiche, static_cast<std::size_t>(o.candidates));

  if (wants_views(context)) {
    show_matches(*context.trace, found, rounds.poses);
  }
  Proposal proposal;
  proposal.candidates = candidates_of(poses, request);
  proposal.iterations = rounds.rounds;
  proposal.stopped = context.stop.stop_requested();
  return proposal;
}

}  // namespace gridmerge
