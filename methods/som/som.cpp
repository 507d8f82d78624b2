#include "methods/som/som.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/som/orientation.hpp"
#include "methods/som/posts.hpp"
#include "methods/som/translation.hpp"
#include "methods/som/views.hpp"

namespace gridmerge {
namespace {

using som::ClusterMatcher;
using som::Rotation;
using som::VoteSurface;

/// The level whose table cluster points are read in: fine enough to tell the faces of a wall apart.
constexpr int kClusterLevel = 1;
/// The level on which the last poses climb.
constexpr int kClimbLevel = 1;
constexpr PoseReach kFirstStep{0.1, radians(1)};
constexpr PoseReach kLastStep{0.05, radians(0.5)};

/// What both maps have become.
struct LearntMaps {
  ClusterPoints target;
  ClusterPoints source;
  bool posts = false;  ///< the clusters are posts, which face nowhere
};

LearntMaps learnt_walls(const SomOptions& o, const AlignRequest& request, const RunContext& context) {
  return {.target = cluster_points(request.target, o.clusters, context.num_threads, context.stop),
          .source = cluster_points(request.source, o.clusters, context.num_threads, context.stop)};
}

/// None where posts are not much of what both maps hold.
std::optional<LearntMaps> learnt_posts(const SomOptions& o, const AlignRequest& request) {
  const auto heaviest = [&](som::Posts posts) {
    posts.points.resize(std::min(posts.points.size(), static_cast<std::size_t>(o.posts)));
    return ClusterPoints{.points = std::move(posts.points), .spacing_m = o.clusters.spacing_m};
  };
  som::Posts target = som::posts_of(request.target, o.post_m);
  if (target.share <= o.post_share) {
    return {};
  }
  som::Posts source = som::posts_of(request.source, o.post_m);
  if (source.share <= o.post_share) {
    return {};
  }
  return LearntMaps{.target = heaviest(std::move(target)), .source = heaviest(std::move(source)), .posts = true};
}

/// Turns that nothing speaks for or against.
std::vector<Rotation> all_turns(double step_rad, const std::optional<PoseWindow>& window) {
  std::vector<Rotation> turns;
  for (const double angle : som::even_turns(step_rad, window)) {
    turns.push_back({angle, 0});
  }
  return turns;
}

/// The poses that are under way.
class Search {
 public:
  Search(const SomOptions& options, const AlignRequest& request, const RunContext& context, LearntMaps maps)
      : o_(options),
        request_(request),
        context_(context),
        window_(window_of(request)),
        maps_(std::move(maps)),
        target_(maps_.target),
        source_(maps_.source),
        fit_(request.target, request.source, kClusterLevel, options.fit, as_walls(target_), as_walls(source_)),
        matcher_(target_.points, std::max(options.match_reach_m, 1.5 * target_.spacing_m), radians(options.facing_deg),
                 options.along_share) {}
  Search(const Search&) = delete;  // its parts borrow from each other
  Search& operator=(const Search&) = delete;

  /// The turns that the normals allow.
  void turn() {
    if (maps_.posts) {
      turns_ = all_turns(radians(o_.post_turn_deg), window_);
      return;
    }
    spectrum_ = som::rotation_spectrum(target_.points, source_.points, o_.blur_deg, 2 * request_.target.resolution_m());
    turns_ = som::rotations(spectrum_,
                            {.tuning_rad = radians(o_.tuning_deg),
                             .flank_rad = radians(o_.flank_deg),
                             .at_most = static_cast<std::size_t>(o_.turns)},
                            window_);
  }

  /// The translations that the clusters vote for, at each turn; the best of all by their fitness on clusters.
  void vote() {
    const auto peaks = static_cast<std::size_t>(maps_.posts ? kPeaksOfPosts : o_.peaks_per_turn);
    std::vector<std::vector<ScoredPose>> of_turn(turns_.size());
    parallel_for(turns_.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      if (i > 0 && context_.stop.stop_requested()) {
        return;
      }
      of_turn[i] = som::vote_peaks(votes_at(turns_[i].angle_rad), window_, peaks);
      if (!maps_.posts) {
        for (ScoredPose& one : of_turn[i]) {
          one.score = fit_(one.pose);
        }
      }
    });
    std::vector<ScoredPose> all;
    for (const std::vector<ScoredPose>& some : of_turn) {
      all.insert(all.end(), some.begin(), some.end());
    }
    for (const ScoredPose& one :
         distinct_poses(std::move(all), {0.5 * o_.vote_cell_m, radians(1)}, static_cast<std::size_t>(o_.starts))) {
      starts_.push_back({.best = {one.pose, fit_(one.pose)}, .at = one.pose});
    }
  }

  /// Pulls the poses into place, cluster by cluster; every second step the weaker half is given up.
  /// @return how many steps there were, at most `budget`
  int converge(int budget) {
    const int steps = starts_.empty() ? 0 : std::min(o_.icp_steps, budget);
    int done = 0;
    for (; done < steps && !context_.stop.stop_requested(); ++done) {
      parallel_for(starts_.size(), context_.num_threads, [&](std::size_t i, std::size_t) { pull(starts_[i]); });
      std::stable_sort(starts_.begin(), starts_.end(),
                       [](const Start& a, const Start& b) { return a.best.score > b.best.score; });
      record(done, steps);
      if (done % 2 == 1) {
        starts_.resize(std::max(starts_.size() / 2, std::min(starts_.size(), static_cast<std::size_t>(o_.climbed))));
      }
    }
    return done;
  }

  /// The best, distinct.
  [[nodiscard]] std::vector<ScoredPose> found() const {
    std::vector<ScoredPose> poses;
    for (const Start& one : starts_) {
      poses.push_back(one.best);
    }
    return distinct_poses(std::move(poses), {0.5 * o_.distinct_m, 0.5 * radians(o_.distinct_deg)},
                          static_cast<std::size_t>(o_.climbed));
  }

  void show(const std::vector<ScoredPose>& poses) const {
    if (context_.trace == nullptr || !context_.trace->wants_views()) {
      return;
    }
    TraceSink& trace = *context_.trace;
    trace.on_view(som::neurons_view(MapView::Map::kTarget, target_.points));
    trace.on_view(som::neurons_view(MapView::Map::kSource, source_.points));
    trace.on_view(som::normals_view(target_.points, source_.points, o_.blur_deg));
    trace.on_view(som::turns_view(spectrum_, turns_));
    if (!poses.empty()) {
      const Pose2& best = poses.front().pose;
      const VoteSurface surface = votes_at(best.theta_rad);
      trace.on_view(som::votes_view(surface, som::vote_peaks(surface, window_, kPeaksShown)));
      trace.on_view(som::matches_view(target_.points, source_.points, matcher_(source_.points, best), best));
    }
  }

 private:
  static constexpr std::size_t kPeaksShown = 10;
  static constexpr int kPeaksOfPosts = 10;

  [[nodiscard]] VoteSurface votes_at(double angle_rad) const {
    const double cell_m = std::max(o_.vote_cell_m, 0.5 * std::max(target_.spacing_m, source_.spacing_m));
    return som::translation_votes(target_.points, source_.points, angle_rad, radians(o_.facing_deg), cell_m);
  }

  /// A pose on its way, and the best it has been.
  struct Start {
    ScoredPose best;
    Pose2 at;
  };

  /// One step of iterative closest clusters.
  void pull(Start& start) const {
    const Pose2 moved = matcher_.step(source_.points, start.at);
    if (moved == start.at || !inside(moved, window_)) {
      return;
    }
    start.at = moved;
    const double score = fit_(moved);
    if (score > start.best.score) {
      start.best = {moved, score};
    }
  }

  void record(int step, int steps) const {
    if (context_.trace == nullptr) {
      return;
    }
    IterationRecord record{
        .stage = "propose/converge",
        .iteration = step,
        .iterations = steps,
        .best_score = starts_.front().best.score,
        .mean_score = 0,
        .best_target_from_source = from_local(starts_.front().best.pose, request_.target, request_.source),
        .population = {}};
    for (const Start& one : starts_) {
      record.mean_score += one.best.score / static_cast<double>(starts_.size());
      record.population.push_back(from_local(one.best.pose, request_.target, request_.source));
    }
    context_.trace->on_iteration(record);
  }

  const SomOptions& o_;
  const AlignRequest& request_;
  const RunContext& context_;
  std::optional<PoseWindow> window_;
  LearntMaps maps_;
  const ClusterPoints& target_;
  const ClusterPoints& source_;
  WallFit fit_;  ///< on clusters alone
  ClusterMatcher matcher_;
  som::RotationSpectrum spectrum_;
  std::vector<Rotation> turns_;  ///< best first
  std::vector<Start> starts_;    ///< best first
};

/// One way of seeing the maps, from turns to poses.
void run(Search& search, Proposal& proposal, const RunContext& context) {
  announce(context, "propose/turn");
  search.turn();
  announce(context, "propose/vote");
  search.vote();
  announce(context, "propose/converge");
  proposal.iterations += search.converge(context.stop.iteration_budget() - proposal.iterations);
}

/// Every pose climbs on the fitness of all walls.
std::vector<ScoredPose> climbed(std::vector<ScoredPose> poses, const SomOptions& o, const AlignRequest& request,
                                const RunContext& context) {
  const std::optional<PoseWindow> window = window_of(request);
  const WallFit fitness(request.target, request.source, kClimbLevel, o.fit, static_cast<std::size_t>(o.max_points));
  parallel_for(poses.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    ScoredPose& one = poses[i];
    one = context.stop.stop_requested() ? ScoredPose{one.pose, fitness(one.pose)}
                                        : climb(fitness, one.pose, kFirstStep, kLastStep, window);
  });
  return distinct_poses(std::move(poses), {o.distinct_m, radians(o.distinct_deg)},
                        static_cast<std::size_t>(o.candidates));
}

}  // namespace

void SomOptions::describe(OptionList& list) {
  clusters.describe(list);
  list.add("blur_deg", blur_deg, 0.1, 30,
           {"deg", "Standard deviation of the blur of the normals' histogram.", "Raise it for maps bent by drift."})
      .add("tuning_deg", tuning_deg, 0, 30,
           {"deg", "How far the Radon transform may move a turn that the histogram suggests.", "0 turns it off."})
      .add("flank_deg", flank_deg, 0, 45,
           {"deg", "Turns this far to either side of a good one are tried too; 0: not.", "For maps bent by drift."})
      .add("turns", turns, 1, 360,
           {"turns", "How many turns are tried at the most.",
            "Time grows with it; round or cluttered places need more."})
      .add("facing_deg", facing_deg, 1, 90, {"deg", "How far the normals of clusters that match may differ.", ""})
      .add("vote_cell_m", vote_cell_m, 0.02, 100,
           {"m", "Side of a cell of the translation votes; at least half the clusters' spacing.", ""})
      .add("post_m", post_m, 0.05, 100,
           {"m", "Touching walls no wider than this are a post: a trunk, a leg, a column.", ""})
      .add("post_share", post_share, 0, 1,
           {"", "Where posts are more than this share of the walls of both maps, posts are matched too.",
            "1 turns it off."})
      .add("post_turn_deg", post_turn_deg, 0.2, 45,
           {"deg", "Step of the turns tried with posts, whose normals tell nothing.", "Time grows with its inverse."})
      .add("posts", posts, 3, 100000,
           {"points", "Posts of each map that are used, the heaviest.", "Time grows with its square."})
      .add("peaks_per_turn", peaks_per_turn, 1, 100000,
           {"poses", "Translations that are scored for each turn.", "Raise it for maps that overlap little."})
      .add("starts", starts, 1, 100000, {"poses", "Of these, how many the closest clusters then pull into place.", ""})
      .add("icp_steps", icp_steps, 0, 1000, {"", "Steps of iterative closest clusters.", ""})
      .add("match_reach_m", match_reach_m, 0.02, 100,
           {"m", "Clusters farther apart than this do not match; at least 1.5 times their spacing.", ""})
      .add("along_share", along_share, 0, 1,
           {"", "What a distance along a wall counts in a match, where one across it counts 1.",
            "1 is the plain distance of points."})
      .add("climbed", climbed, 1, 100000, {"poses", "How many poses climb on the fitness of all walls.", ""})
      .add("candidates", candidates, 1, 1000, {"poses", "Poses proposed at the end.", ""})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses nearer than this, and than distinct_deg, are one: the better is proposed.", ""})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "See distinct_m.", ""})
      .add("max_points", max_points, 100, 1000000, {"points", "Wall points of each map that a climb reads.", ""});
  fit.describe(list);
}

SomMerger::SomMerger(SomOptions options) : options_(std::move(options)) { require_valid(options_, "som"); }

MergerTraits SomMerger::traits() const { return {.stochastic = false, .uses_prior = true, .anytime = true}; }

Proposal SomMerger::propose(const AlignRequest& request, const RunContext& context) const {
  Proposal proposal;
  announce(context, "propose/learn");
  Search walls(options_, request, context, learnt_walls(options_, request, context));
  run(walls, proposal, context);
  std::vector<ScoredPose> poses = walls.found();

  std::optional<Search> posts;
  if (std::optional<LearntMaps> maps = learnt_posts(options_, request)) {
    posts.emplace(options_, request, context, std::move(*maps));
    run(*posts, proposal, context);
    const std::vector<ScoredPose> more = posts->found();
    poses.insert(poses.end(), more.begin(), more.end());
  }

  announce(context, "propose/climb");
  poses = climbed(std::move(poses), options_, request, context);
  proposal.stopped = context.stop.stop_requested();
  proposal.candidates = candidates_of(poses, request);
  (posts ? *posts : walls).show(poses);
  return proposal;
}

}  // namespace gridmerge
