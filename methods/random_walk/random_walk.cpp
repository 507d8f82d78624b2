#include "methods/random_walk/random_walk.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/random_walk/adaptive_steps.hpp"
#include "methods/random_walk/random_pose.hpp"
#include "methods/random_walk/walk_views.hpp"

namespace gridmerge {
namespace {

/// Steps between two looks at the stop token and two reports.
constexpr int kBlock = 8;

/// From the coarsest level on which rooms can still be told apart to one fine enough for the refinement behind.
std::vector<int> levels_to_walk(const PreparedMap& map) {
  constexpr double kCoarsest_m = 0.45;
  constexpr double kFinest_m = 0.11;
  std::vector<int> levels;
  for (int k = PreparedMap::kLevels - 1; k >= 0; --k) {
    const double resolution_m = map.level(k).resolution_m;
    if (resolution_m <= kCoarsest_m || k == 0) {
      levels.push_back(k);
      if (resolution_m <= kFinest_m) {
        break;
      }
    }
  }
  return levels;
}

/// One walker: where it stands, the best it has seen, how it steps.
struct Walker {
  Pose2 at;
  double delta = 0;
  Pose2 best;
  double best_delta = 0;
  AdaptiveSteps steps;
  RandomStream random;
  int accepted = 0;
  std::vector<Point2> path;  ///< of the source's local origin, where somebody watches
};

/// First steps are about as long as a cell is wide, and turn the rim of the smaller map about as far.
StepRules rules_at(const AlignRequest& request, int level, int memory) {
  const double cell_m = request.target.level(level).resolution_m;
  const double lever_m = std::max(1.0, 0.6 * std::min(request.source.radius_m(), request.target.radius_m()));
  return {.first_sigma = {cell_m, cell_m, std::min(radians(5), cell_m / lever_m)},
          .floor_share = 0.25,
          .memory = static_cast<std::size_t>(memory),
          .on_accepted = 1.5,
          .on_rejected = 0.9,
          .mean_fade = 0.5,
          .least_width = 0.1,
          .most_width = 3};
}

class Search {
 public:
  Search(const RandomWalkOptions& options, const AlignRequest& request, const RunContext& context)
      : options_(options),
        request_(request),
        context_(context),
        window_(window_of(request)),
        levels_(levels_to_walk(request.target)),
        watched_(wants_views(context)) {}

  Proposal run() {
    announce(context_, "propose/starts");
    std::vector<ScoredPose> found = scored_starts();
    const std::vector<ScoredPose> starts = watched_ ? found : std::vector<ScoredPose>{};
    found = distinct(std::move(found), request_.target.level(levels_.front()).resolution_m,
                     static_cast<std::size_t>(options_.walks));
    announce(context_, "propose/walk");
    Proposal proposal;
    for (std::size_t k = 0; k < levels_.size(); ++k) {
      const LockedDistance delta = delta_at(levels_[k]);
      gather(found, delta, levels_[k]);
      walk(delta, proposal.iterations);
      // Half the walks or fewer go on to the next level; they are more than the candidates to the end.
      const auto share = static_cast<double>(k + 1) / static_cast<double>(levels_.size());
      const double survivors =
          options_.walks * std::pow(static_cast<double>(options_.candidates) / options_.walks, share);
      found = best_of_walkers();
      const bool last = k + 1 == levels_.size();
      found = distinct(std::move(found), last ? options_.niche_m : request_.target.level(levels_[k]).resolution_m,
                       static_cast<std::size_t>(std::lround(survivors)));
    }
    proposal.stopped = stopped_;
    proposal.candidates = candidates_of(found, request_);
    if (watched_) {
      show_starts(*context_.trace, starts);
      show_walks(*context_.trace, paths_);
      show_progress(*context_.trace, progress_);
    }
    return proposal;
  }

 private:
  [[nodiscard]] LockedDistance delta_at(int level) const {
    const auto points = static_cast<std::size_t>(options_.max_points);
    return {request_.target, request_.source, level, options_.lock, level == levels_.back() ? points : points / 2};
  }

  [[nodiscard]] std::vector<ScoredPose> distinct(std::vector<ScoredPose> poses, double reach_m,
                                                 std::size_t at_most) const {
    return distinct_poses(std::move(poses), {reach_m, radians(options_.niche_deg)}, at_most);
  }

  /// Every start with its -Delta at the coarsest level. A start that the prior gives comes first.
  std::vector<ScoredPose> scored_starts() {
    RandomStream random(context_.seed, "random_walk/starts");
    std::vector<ScoredPose> starts;
    if (request_.prior) {
      starts.push_back({to_local(request_.prior->target_from_source, request_.target, request_.source), 0});
    } else {
      starts.push_back({{}, 0});
    }
    for (const Pose2& pose : start_poses(request_, window_, start_count(), random)) {
      starts.push_back({pose, 0});
    }
    // A race: all of them on few points, the better ones on more.
    starts = scored(std::move(starts), static_cast<std::size_t>(options_.max_points) / 16);
    const std::size_t better = std::max(starts.size() / 10, static_cast<std::size_t>(10 * options_.walks));
    starts = best_first(std::move(starts), better);
    return scored(std::move(starts), static_cast<std::size_t>(options_.max_points) / 3);
  }

  /// The more walls there are, the more wrong ways there are to lay one on another.
  [[nodiscard]] std::size_t start_count() const {
    if (window_) {
      return static_cast<std::size_t>(options_.window_starts);
    }
    const auto walls = [&](const PreparedMap& map) { return thinned_walls(map, map.level(levels_.front())).size(); };
    const std::size_t wanted =
        static_cast<std::size_t>(options_.starts_per_wall) * std::max(walls(request_.target), walls(request_.source));
    return std::min(wanted, static_cast<std::size_t>(options_.max_starts));
  }

  /// The poses with their -Delta on the coarsest maps; those that are reached before the search is stopped.
  std::vector<ScoredPose> scored(std::vector<ScoredPose> poses, std::size_t max_points) {
    const LockedDistance delta(request_.target, request_.source, levels_.front(), options_.lock, max_points);
    constexpr std::size_t kChunk = 256;
    std::vector<char> done((poses.size() + kChunk - 1) / kChunk, 0);
    parallel_for(done.size(), context_.num_threads, [&](std::size_t chunk, std::size_t) {
      if (chunk > 0 && context_.stop.stop_requested()) {
        stopped_ = true;
        return;
      }
      const std::size_t end = std::min((chunk + 1) * kChunk, poses.size());
      for (std::size_t i = chunk * kChunk; i < end; ++i) {
        poses[i].score = -delta(poses[i].pose);
      }
      done[chunk] = 1;
    });
    std::vector<ScoredPose> reached;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (done[i / kChunk] != 0) {
        reached.push_back(poses[i]);
      }
    }
    return reached;
  }

  static std::vector<ScoredPose> best_first(std::vector<ScoredPose> poses, std::size_t at_most) {
    std::stable_sort(poses.begin(), poses.end(),
                     [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
    poses.resize(std::min(poses.size(), at_most));
    return poses;
  }

  /// Walkers at the poses, as seen at a level.
  void gather(const std::vector<ScoredPose>& poses, const LockedDistance& delta, int level) {
    const StepRules rules = rules_at(request_, level, options_.memory);
    walkers_.clear();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      RandomStream random(context_.seed, "random_walk/steps",
                          static_cast<std::uint64_t>(level) * 1000000 + static_cast<std::uint64_t>(i));
      walkers_.push_back({.at = poses[i].pose,
                          .delta = 0,
                          .best = poses[i].pose,
                          .best_delta = 0,
                          .steps = AdaptiveSteps(rules),
                          .random = random,
                          .accepted = 0,
                          .path = {}});
    }
    parallel_for(walkers_.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      walkers_[i].delta = walkers_[i].best_delta = delta(walkers_[i].at);
    });
  }

  /// All walkers, block by block.
  void walk(const LockedDistance& delta, int& blocks) {
    const int first = blocks;
    for (int step = 0; step < options_.steps; step += kBlock) {
      if (stopped_ || blocks >= context_.stop.iteration_budget() || context_.stop.stop_requested()) {
        stopped_ = stopped_ || context_.stop.stop_requested();
        break;
      }
      const int steps = std::min(kBlock, options_.steps - step);
      parallel_for(walkers_.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
        for (int s = step; s < step + steps; ++s) {
          const double still = 1 - static_cast<double>(s) / options_.steps;
          take_step(walkers_[i], delta, options_.worse_percent / 100 * still);
        }
      });
      report(blocks++, steps);
    }
    if (watched_ && blocks > first) {
      for (const Walker& walker : walkers_) {
        paths_.push_back(walker.path);
      }
    }
  }

  void take_step(Walker& walker, const LockedDistance& delta, double worse_chance) const {
    const PoseStep step = walker.steps.draw(walker.random);
    const Pose2 pose = stepped(walker.at, step);
    const bool anyway = walker.random.uniform() < worse_chance;
    const double found = inside(pose, window_) ? delta(pose) : 0;
    if (!inside(pose, window_) || (found >= walker.delta && !anyway)) {
      walker.steps.rejected();
      return;
    }
    walker.steps.accepted(step);
    walker.at = pose;
    walker.delta = found;
    ++walker.accepted;
    if (found < walker.best_delta) {
      walker.best = pose;
      walker.best_delta = found;
    }
    if (watched_) {
      walker.path.push_back(pose.translation());
    }
  }

  [[nodiscard]] std::vector<ScoredPose> best_of_walkers() const {
    std::vector<ScoredPose> best;
    for (const Walker& walker : walkers_) {
      best.push_back({walker.best, -walker.best_delta});
    }
    return best;
  }

  void report(int block, int steps) {
    if (context_.trace == nullptr) {
      return;
    }
    const std::vector<ScoredPose> best = best_of_walkers();
    const auto top =
        std::max_element(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
    IterationRecord record{.stage = "propose/walk",
                           .iteration = block,
                           .iterations = static_cast<int>(levels_.size()) * ((options_.steps + kBlock - 1) / kBlock),
                           .best_score = top->score,
                           .mean_score = 0,
                           .best_target_from_source = from_local(top->pose, request_.target, request_.source),
                           .population = {}};
    BlockProgress progress{.best_delta = -top->score, .mean_delta = 0, .acceptance_percent = 0, .sigma_m = 0};
    const auto count = static_cast<double>(walkers_.size());
    for (Walker& walker : walkers_) {
      record.mean_score -= walker.best_delta / count;
      record.population.push_back(from_local(walker.at, request_.target, request_.source));
      progress.mean_delta += walker.delta / count;
      progress.acceptance_percent += 100.0 * walker.accepted / (steps * count);
      progress.sigma_m += walker.steps.sigma_m() / count;
      walker.accepted = 0;
    }
    progress_.push_back(progress);
    context_.trace->on_iteration(record);
  }

  const RandomWalkOptions& options_;
  const AlignRequest& request_;
  const RunContext& context_;
  std::optional<PoseWindow> window_;
  std::vector<int> levels_;
  bool watched_;
  std::atomic<bool> stopped_ = false;
  std::vector<Walker> walkers_;
  std::vector<std::vector<Point2>> paths_;
  std::vector<BlockProgress> progress_;
};

}  // namespace

void RandomWalkOptions::describe(OptionList& list) {
  list.add("starts_per_wall", starts_per_wall, 1, 100000,
           {"poses",
            "Poses drawn to start from for each wall cell of the coarsest maps (the larger count of the two); those of "
            "least Delta start a walk.",
            "Raise it for large, self-similar places; time grows with it."})
      .add("max_starts", max_starts, 1, 100000000, {"poses", "Their number at the most.", ""})
      .add("window_starts", window_starts, 1, 10000000,
           {"poses", "Their number where a prior's fence is given.",
            "Raise it for fences much wider than 5 m and 20 deg."})
      .add("walks", walks, 1, 100000, {"walks", "Walks on the coarsest maps; fewer go on at each finer level.", ""})
      .add("steps", steps, 1, 100000, {"steps", "Steps of a walk at each level.", "Time grows with it."})
      .add("memory", memory, 1, 1000,
           {"steps", "Accepted steps from which the mean and the covariance of the next are learnt.", ""})
      .add("worse_percent", worse_percent, 0, 100,
           {"%", "Chance that a worse pose is accepted at the start of a level; it falls to 0 towards its end.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Walks proposed at the end.", "More give the Evaluator more to choose from, and cost time."})
      .add("niche_m", niche_m, 0.01, 100,
           {"m", "Walks that end nearer than this, and than niche_deg, are one answer: only the best is proposed.", ""})
      .add("niche_deg", niche_deg, 0.1, 180, {"deg", "See niche_m.", ""})
      .add("max_points", max_points, 100, 1000000,
           {"points",
            "Cells of each value and map that a pose is tried on; half of them but on the finest maps, fewer for "
            "starts.",
            ""});
  lock.describe(list);
}

RandomWalkMerger::RandomWalkMerger(RandomWalkOptions options) : options_(std::move(options)) {
  require_valid(options_, "random_walk");
}

MergerTraits RandomWalkMerger::traits() const {
  return {.stochastic = true, .uses_prior = true, .needs_prior = false, .anytime = true, .warm_start = false};
}

Proposal RandomWalkMerger::propose(const AlignRequest& request, const RunContext& context) const {
  return Search(options_, request, context).run();
}

}  // namespace gridmerge
