#include "methods/genetic/paper_genetic.hpp"

#include <algorithm>
#include <atomic>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "gridmerge/align/correlation_sweep.hpp"
#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"
#include "methods/genetic/hit_fitness.hpp"
#include "methods/genetic/paper_operations.hpp"

namespace gridmerge {
namespace {

using paper::Individual;

constexpr std::size_t kCandidates = 10;

Pose2 pose_of(const PaperGeneticOptions::KnownPose& known) { return {known.x_m, known.y_m, radians(known.theta_deg)}; }

/// Start p_i and the error range round it.
paper::Window window_of(const PaperGeneticOptions& o, const AlignRequest& request) {
  const MapLevel& known = request.target.level(0);
  const double half_side_m = 0.5 * std::max(known.width, known.height) * known.resolution_m;
  paper::Window window{.start = {},  // a map frame's origin is its robot's start: both starts on one spot
                       .pivot = {},
                       .radius_m = o.window_m > 0 ? o.window_m : o.window_percent / 100 * half_side_m,
                       .angle_rad = radians(o.window_deg)};
  if (o.start == "global_poses") {
    window.start = paper::initial_pose(pose_of(o.target_local), pose_of(o.target_global), pose_of(o.source_local),
                                       pose_of(o.source_global));
  } else if (o.start == "prior" && request.prior) {
    const PosePrior& prior = *request.prior;
    window.start = prior.target_from_source;
    window.angle_rad = std::min(prior.angle_rad.value_or(window.angle_rad), kPi);
    if (prior.radius_m) {
      window.pivot = request.source.centre_in_map();  // a prior's radius is meant there
      window.radius_m = *prior.radius_m;
    }
  }
  return window;
}

/// A population of poses and what it takes to lead it from one generation to the next.
class Evolution {
 public:
  Evolution(const PaperGeneticOptions& options, const AlignRequest& request, const RunContext& context)
      : options_(options),
        request_(request),
        context_(context),
        fitness_(request.target, request.source),
        size_(static_cast<std::size_t>(options.population)),
        spread_{options.mutation_cells * request.target.resolution_m(), radians(options.mutation_deg)},
        window_(window_of(options, request)),
        fence_(gridmerge::window_of(request)),
        centre_(request.source.centre_in_map()) {
    std::vector<Pose2> first;
    if (request.carried != nullptr) {
      first = request.carried->target_from_source;  // best first
    }
    if (options_.epoch_policy == "restart" && !first.empty()) {
      window_.start = first.front();
      first.resize(1);
    }
    initialise(first);
  }

  [[nodiscard]] bool stopped() const { return stopped_; }

  /// A new epoch. `continue` [li2013] takes the population as it is; `restart` (the thesis) draws it anew round the
  /// last estimate, which stays in it.
  void next_epoch() {
    if (options_.epoch_policy == "restart") {
      window_.start = population_.front().target_from_source;
      initialise({window_.start});
    }
  }

  /// One generation to the next. Leaves the population alone when it is stopped on the way.
  void iterate() {
    std::vector<Individual> next = population_;
    const std::size_t superior = paper::superior_count(population_);
    const std::int64_t worst_superior = population_[superior - 1].fitness;
    const std::int64_t best = population_.front().fitness;

    // Step 3: the superior are mutated; a mutant takes the place of its parent if it is better.
    for_each_individual("paper_genetic/mutate", 0, superior, [&](std::size_t k, RandomStream& stream) {
      int attempts = k == 0 ? options_.best_mutations : 1;
      if (options_.mutate_by_fitness && k != 0) {
        attempts = paper::mutation_attempts(next[k].fitness, worst_superior, best, options_.best_mutations);
      }
      for (int attempt = 0; attempt < attempts && !poll_stop(); ++attempt) {
        const Individual mutant = evaluated(paper::mutation(next[k].target_from_source, spread_, stream));
        if (mutant.fitness > next[k].fitness) {
          next[k] = mutant;
        }
      }
    });

    // Step 4: the inferior are replaced by offspring of the superior.
    const std::span<const Individual> parents(next.data(), superior);
    for_each_individual("paper_genetic/replace", superior, size_,
                        [&](std::size_t k, RandomStream& stream) { next[k] = evaluated(offspring(parents, stream)); });

    if (!stopped_) {
      population_ = std::move(next);
      sort_best_first();
      ++iteration_;
    }
  }

  [[nodiscard]] IterationRecord record(int iterations) const {
    IterationRecord record{.stage = "propose/evolve",
                           .iteration = iteration_ - 1,
                           .iterations = iterations,
                           .best_score = score(population_.front()),
                           .mean_score = 0,
                           .best_target_from_source = population_.front().target_from_source,
                           .population = poses()};
    for (const Individual& individual : population_) {
      record.mean_score += score(individual) / static_cast<double>(size_);  // Eq. 3.9
    }
    return record;
  }

  /// The best individuals that lie more than one mutation apart, and the population for the next epoch.
  [[nodiscard]] Proposal proposal() const {
    Proposal proposal{.candidates = {}, .carry = {poses()}, .iterations = iteration_, .stopped = stopped_};
    for (const Individual& individual : population_) {
      const bool distinct =
          std::none_of(proposal.candidates.begin(), proposal.candidates.end(), [&](const Candidate& taken) {
            const PoseDifference apart =
                difference_at(centre_, taken.target_from_source, individual.target_from_source);
            return apart.distance_m <= spread_.position_m && apart.angle_rad <= spread_.angle_rad;
          });
      if (individual.fitness > 0 && distinct && proposal.candidates.size() < kCandidates) {
        proposal.candidates.push_back({individual.target_from_source, score(individual)});
      }
    }
    return proposal;
  }

 private:
  [[nodiscard]] static double score(const Individual& individual) {
    return static_cast<double>(individual.fitness) / kOccupied;
  }

  [[nodiscard]] std::vector<Pose2> poses() const {
    std::vector<Pose2> poses;
    for (const Individual& individual : population_) {
      poses.push_back(individual.target_from_source);
    }
    return poses;
  }

  /// Step 1, done as soon as an individual comes to be.
  /// Mutations stray beyond the window, as published; but what strays beyond a prior's fence is not viable.
  [[nodiscard]] Individual evaluated(const Pose2& pose) const {
    const bool viable = inside(to_local(pose, request_.target, request_.source), fence_);
    return {pose, viable ? fitness_(pose) : -1};
  }

  bool poll_stop() {
    if (context_.stop.stop_requested()) {
      stopped_ = true;
    }
    return stopped_;
  }

  /// Calls `body(k, stream)` for the individuals first..last-1, each with a random stream of its own.
  template <typename Body>
  void for_each_individual(std::string_view name, std::size_t first, std::size_t last, Body&& body) {
    parallel_for(last - first, context_.num_threads, [&](std::size_t index, std::size_t) {
      if (!poll_stop()) {
        const std::size_t k = first + index;
        RandomStream stream(context_.seed, name, static_cast<std::uint64_t>(iteration_) * size_ + k);
        body(k, stream);
      }
    });
  }

  void sort_best_first() {
    std::stable_sort(population_.begin(), population_.end(),
                     [](const Individual& a, const Individual& b) { return a.fitness > b.fitness; });
  }

  /// A population of the given poses, filled up from the window.
  void initialise(const std::vector<Pose2>& given) {
    std::vector<Individual> drawn(size_, {window_.start, 0});
    for_each_individual("paper_genetic/initialise", 0, size_, [&](std::size_t k, RandomStream& stream) {
      drawn[k] = evaluated(k < given.size() ? given[k] : paper::random_pose(window_, stream));
    });
    if (population_.empty() || !stopped_) {
      population_ = std::move(drawn);
      sort_best_first();
    }
  }

  /// One of the operations, each as likely, on randomly chosen parents.
  [[nodiscard]] Pose2 offspring(std::span<const Individual> parents, RandomStream& stream) const {
    const auto parent = [&] {
      return parents[stream.below(static_cast<std::uint32_t>(parents.size()))].target_from_source;
    };
    const std::uint32_t operation = stream.below(4);
    const Pose2 first = parent();
    const Pose2 second = parent();
    switch (operation) {
      case 0:
        return paper::mutation(first, spread_, stream);
      case 1:
        return paper::crossover_1(first, second);
      case 2:
        return paper::crossover_2(first, second, stream.uniform());
      default:
        return paper::random_pose(window_, stream);
    }
  }

  const PaperGeneticOptions& options_;
  const AlignRequest& request_;
  const RunContext& context_;
  HitFitness fitness_;
  std::size_t size_;
  paper::MutationSpread spread_;
  paper::Window window_;
  std::optional<PoseWindow> fence_;
  Point2 centre_;
  std::vector<Individual> population_;  ///< best first
  int iteration_ = 0;                   ///< done so far
  std::atomic<bool> stopped_ = false;
};

}  // namespace

void PaperGeneticOptions::describe(OptionList& list) {
  list.add("population", population, 2, 100000,
           {"poses", "Size of the population.", "Raise it for a wide window; time grows with it."})
      .add("start", start, {"prior", "same_spot", "global_poses"},
           {"",
            "Initial pose p_i: the request's prior (same_spot where there is none), both map origins on one spot, or "
            "Eq. 3.7 from target_local .. source_global.",
            "same_spot is right where robots start together and map from there, as HectorSLAM does."})
      .add("window_m", window_m, 0, 100000,
           {"m",
            "Radius of the disc round p_i from which positions are drawn; 0: as window_percent says. A prior's "
            "radius and angle take the window's place.",
            "As small as the truth allows: the window decides the success."})
      .add("window_percent", window_percent, 0, 1000,
           {"%", "The same as a share of half the longest side of the target's known area; used where window_m is 0.",
            "100 is the thesis's default."})
      .add("window_deg", window_deg, 0, 180, {"deg", "How far headings are drawn to either side of p_i's.", ""})
      .add("iterations_per_epoch", iterations_per_epoch, 1, 1000000,
           {"", "Generations in an epoch.", "More find more and take longer."})
      .add("epochs", epochs, 1, 1000000, {"", "Epochs in one call.", "One, where the maps grow between epochs."})
      .add("epoch_policy", epoch_policy, {"continue", "restart"},
           {"", "The next epoch carries the population on [li2013], or draws it anew round the last estimate (thesis).",
            "`restart` finds its way out of a wrong answer only within the window."})
      .add("best_mutations", best_mutations, 1, 100000,
           {"", "How often the best individual is mutated in an iteration.", ""})
      .add("mutate_by_fitness", mutate_by_fitness,
           {"", "The other superior individuals are mutated up to best_mutations times too, by fitness (Eq. 3.14).",
            "The thesis gave it up: the closer to the end, the slower."})
      .add("mutation_cells", mutation_cells, 0, 10000,
           {"cells", "Standard deviation of a mutation in x and in y.", "Lower it for a more exact end."})
      .add("mutation_deg", mutation_deg, 0, 180, {"deg", "Standard deviation of a mutation's turn.", ""});
  const auto add_pose = [&](const std::string& name, KnownPose& pose, const std::string& meaning) {
    list.add(name + "_x_m", pose.x_m, -1e6, 1e6, {"m", meaning + "; for start: global_poses.", ""})
        .add(name + "_y_m", pose.y_m, -1e6, 1e6, {"m", "See " + name + "_x_m.", ""})
        .add(name + "_deg", pose.theta_deg, -360, 360, {"deg", "See " + name + "_x_m.", ""});
  };
  add_pose("target_local", target_local, "Pose of the target's robot in its own map");
  add_pose("target_global", target_global, "Pose of the target's robot in a frame both know");
  add_pose("source_local", source_local, "Pose of the source's robot in its own map");
  add_pose("source_global", source_global, "Pose of the source's robot in the frame both know");
}

PaperGeneticMerger::PaperGeneticMerger(PaperGeneticOptions options) : options_(std::move(options)) {
  require_valid(options_, "genetic (paper)");
}

MergerTraits PaperGeneticMerger::traits() const {
  return {.stochastic = true,
          .uses_prior = options_.start == "prior",
          .needs_prior = false,
          .anytime = true,
          .warm_start = true};
}

Proposal PaperGeneticMerger::propose(const AlignRequest& request, const RunContext& context) const {
  announce(context, "propose/evolve");
  Evolution evolution(options_, request, context);
  const int planned = static_cast<int>(std::min<std::int64_t>(
      std::int64_t{options_.epochs} * options_.iterations_per_epoch, context.stop.iteration_budget()));
  for (int iteration = 0; iteration < planned && !evolution.stopped(); ++iteration) {
    if (iteration > 0 && iteration % options_.iterations_per_epoch == 0) {
      evolution.next_epoch();
    }
    evolution.iterate();
    if (context.trace != nullptr && !evolution.stopped()) {
      context.trace->on_iteration(evolution.record(planned));
    }
  }
  return evolution.proposal();
}

}  // namespace gridmerge
