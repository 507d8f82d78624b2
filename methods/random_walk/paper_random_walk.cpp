#include "methods/random_walk/paper_random_walk.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "gridmerge/align/scored_pose.hpp"
#include "methods/random_walk/adaptive_steps.hpp"
#include "methods/random_walk/map_distance.hpp"
#include "methods/random_walk/random_pose.hpp"
#include "methods/random_walk/walk_views.hpp"

namespace gridmerge {
namespace {

/// Samples between two reports.
constexpr int kBlock = 50;

StepRules published_rules(const PaperRandomWalkOptions& options, const AlignRequest& request) {
  const double sigma_m = options.first_sigma_cells * request.target.resolution_m();
  return {.first_sigma = {sigma_m, sigma_m, radians(options.first_sigma_deg)},
          .floor_share = options.floor_percent / 100,
          .memory = static_cast<std::size_t>(options.memory)};
}

/// The finest level on which neither map is wider than that, or the coarsest.
int level_to_walk(const AlignRequest& request, int max_side_cells) {
  const auto side = [&](int k) {
    const MapLevel& target = request.target.level(k);
    const MapLevel& source = request.source.level(k);
    return std::max({target.width, target.height, source.width, source.height});
  };
  int level = 0;
  while (level + 1 < PreparedMap::kLevels && side(level) > max_side_cells) {
    ++level;
  }
  return level;
}

/// t_start: what is known beforehand, or anywhere.
Pose2 start_pose(const AlignRequest& request, RandomStream& random) {
  return request.prior ? to_local(request.prior->target_from_source, request.target, request.source)
                       : uniform_pose(request, std::nullopt, random);
}

/// The walk, one sample at a time.
class Walk {
 public:
  Walk(const PaperRandomWalkOptions& options, const AlignRequest& request, const RunContext& context)
      : options_(options),
        request_(request),
        window_(window_of(request)),
        delta_(request.target, request.source, level_to_walk(request, options.max_side_cells)),
        random_(context.seed, "paper_random_walk"),
        steps_(published_rules(options, request)),
        at_(start_pose(request, random_)),
        here_(delta_(at_).delta(options.c_lock)),
        best_{at_, -here_},
        path_{at_.translation()} {}

  /// Draws t from the adaptive Gaussian about the pose and goes there if it is better, or by a small chance.
  void sample(double worse_chance) {
    const PoseStep step = steps_.draw(random_);
    const Pose2 pose = stepped(at_, step);
    const bool anyway = random_.uniform() < worse_chance;
    if (!inside(pose, window_)) {
      return;
    }
    const double found = delta_(pose).delta(options_.c_lock);
    if (found >= here_ && !anyway) {
      return;
    }
    at_ = pose;
    here_ = found;
    steps_.accepted(step);
    path_.push_back(pose.translation());
    ++accepted_;
    if (-found > best_.score) {
      best_ = {pose, -found};
    }
  }

  [[nodiscard]] IterationRecord report(int block, int blocks) {
    progress_.push_back({.best_delta = -best_.score,
                         .mean_delta = here_,
                         .acceptance_percent = 100.0 * accepted_ / kBlock,
                         .sigma_m = steps_.sigma_m()});
    accepted_ = 0;
    return {.stage = "propose/walk",
            .iteration = block,
            .iterations = blocks,
            .best_score = best_.score,
            .mean_score = -here_,
            .best_target_from_source = from_local(best_.pose, request_.target, request_.source),
            .population = {from_local(at_, request_.target, request_.source)}};
  }

  void show(TraceSink& trace) const {
    show_walks(trace, {path_});
    show_progress(trace, progress_);
  }

  [[nodiscard]] const ScoredPose& best() const { return best_; }

 private:
  const PaperRandomWalkOptions& options_;
  const AlignRequest& request_;
  std::optional<PoseWindow> window_;
  MapDistance delta_;
  RandomStream random_;
  AdaptiveSteps steps_;
  Pose2 at_;
  double here_;
  ScoredPose best_;
  int accepted_ = 0;
  std::vector<Point2> path_;
  std::vector<BlockProgress> progress_;
};

}  // namespace

void PaperRandomWalkOptions::describe(OptionList& list) {
  list.add("samples", samples, 1, 100000000,
           {"poses", "Poses drawn before the walk ends.", "More find more; time grows with it."})
      .add("c_lock", c_lock, 0, 1e6,
           {"", "Weight of disagreeing less agreeing cells against psi, in cells of distance for one cell.",
            "Raise it for maps that overlap little; the walk then finds its way more slowly."})
      .add("first_sigma_cells", first_sigma_cells, 0.01, 10000,
           {"cells", "Standard deviation of a step along x and y until steps have been accepted.", ""})
      .add("first_sigma_deg", first_sigma_deg, 0.01, 180, {"deg", "The same of its turn.", ""})
      .add("floor_percent", floor_percent, 0.01, 100,
           {"%", "No standard deviation falls below this share of the first.", ""})
      .add("memory", memory, 1, 1000,
           {"steps", "Accepted steps from which the mean and the covariance of the next are learnt.", ""})
      .add("worse_percent", worse_percent, 0, 100,
           {"%", "Chance that a worse pose is accepted at the start; it falls to 0 towards the end.", ""})
      .add("max_side_cells", max_side_cells, 10, 100000,
           {"cells", "Maps wider than this are compared in halved resolution.",
            "The paper's maps are smaller; time grows with its square."});
}

PaperRandomWalkMerger::PaperRandomWalkMerger(PaperRandomWalkOptions options) : options_(std::move(options)) {
  require_valid(options_, "random_walk (paper)");
}

MergerTraits PaperRandomWalkMerger::traits() const {
  return {.stochastic = true, .uses_prior = true, .needs_prior = false, .anytime = true, .warm_start = false};
}

Proposal PaperRandomWalkMerger::propose(const AlignRequest& request, const RunContext& context) const {
  announce(context, "propose/walk");
  Walk walk(options_, request, context);
  Proposal proposal;
  const int blocks = (options_.samples + kBlock - 1) / kBlock;
  proposal.stopped = context.stop.stop_requested();
  for (int block = 0; block < std::min(blocks, context.stop.iteration_budget()) && !proposal.stopped; ++block) {
    const int end = std::min((block + 1) * kBlock, options_.samples);
    for (int k = block * kBlock; k < end && !proposal.stopped; ++k) {
      walk.sample(options_.worse_percent / 100 * (1 - static_cast<double>(k) / options_.samples));
      proposal.stopped = context.stop.stop_requested();
    }
    if (!proposal.stopped) {
      ++proposal.iterations;
      const IterationRecord record = walk.report(block, blocks);
      if (context.trace != nullptr) {
        context.trace->on_iteration(record);
      }
    }
  }
  proposal.candidates = candidates_of({walk.best()}, request);
  if (wants_views(context)) {
    walk.show(*context.trace);
  }
  return proposal;
}

}  // namespace gridmerge
