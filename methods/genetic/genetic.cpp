#include "methods/genetic/genetic.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "gridmerge/base/random.hpp"

namespace gridmerge {
namespace {

/// The level of the maps on which poses evolve: fine enough to tell walls apart, coarse enough to be quick.
constexpr int kEvolveLevel = 1;

Pose2 mutated(const Pose2& pose, double sigma_m, double sigma_rad, RandomStream& random) {
  const double dx = sigma_m * random.normal();
  const double dy = sigma_m * random.normal();
  return {pose.x_m + dx, pose.y_m + dy, wrap_angle(pose.theta_rad + sigma_rad * random.normal())};
}

/// Crossover II (Eq. 3.13), along the shorter arc.
Pose2 between(const Pose2& a, const Pose2& b, double share) {
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          wrap_angle(a.theta_rad + share * wrap_angle(b.theta_rad - a.theta_rad))};
}

/// Where poses put the source's centre.
Shape centres(std::string label, const std::vector<ScoredPose>& poses) {
  Shape shape{.kind = Shape::Kind::kPoints, .label = std::move(label), .points = {}};
  for (const ScoredPose& one : poses) {
    shape.points.push_back(one.pose.translation());
  }
  return shape;
}

/// How the fitness grew, generation by generation.
struct Growth {
  Curve best{.label = "fittest", .x = {}, .y = {}};
  Curve mean{.label = "mean of the population", .x = {}, .y = {}};

  void add(const IterationRecord& record) {
    for (auto& [curve, score] : {std::pair{&best, record.best_score}, {&mean, record.mean_score}}) {
      curve->x.push_back(record.iteration);
      curve->y.push_back(score);
    }
  }
};

void show(const std::vector<ScoredPose>& first, const std::vector<ScoredPose>& last, const Growth& growth,
          TraceSink& trace) {
  trace.on_view({"population", "The population of poses; the fittest of the last generation drawn",
                 MapView{.map = MapView::Map::kBoth,
                         .local_target_from_source = last.front().pose,
                         .shapes = {centres("source's centre, last generation, niche by niche", last),
                                    centres("first generation", first)}}});
  trace.on_view(
      {"fitness", "Fitness, generation by generation",
       CurvesView{
           .curves = {growth.best, growth.mean}, .x_label = "generation", .y_label = "fitness [points]", .marks = {}}});
}

double geometric(double first, double last, double share) { return first * std::pow(last / first, share); }

}  // namespace

void GeneticOptions::describe(OptionList& list) {
  list.add("population", population, 4, 100000,
           {"poses", "Size of the first generation; it shrinks as niches are given up.",
            "Raise it for large, self-similar places; time grows with it."})
      .add("generations", generations, 1, 10000,
           {"", "Generations of an epoch.", "Fewer are quicker; the refinement behind makes up for a little."})
      .add("mutations", mutations, 1, 1000, {"", "Children a pose has by mutation in each generation.", ""})
      .add("seeding", seeding, {"sweep", "uniform"},
           {"", "First generation: the peaks of a correlation sweep over all poses, or uniform over the window.",
            "`uniform` is the textbook's; it needs a window or luck."})
      .add("angle_step_deg", angle_step_deg, 0.1, 30,
           {"deg", "Step of the sweep's angles.", "Time grows with its inverse; above 3 deg long walls are missed."})
      .add("first_sigma_m", first_sigma_m, 0.001, 100,
           {"m", "Standard deviation of a mutation's step in the first generation.", ""})
      .add("last_sigma_m", last_sigma_m, 0.001, 100, {"m", "The same in the last generation.", ""})
      .add("first_sigma_deg", first_sigma_deg, 0.01, 180,
           {"deg", "Standard deviation of a mutation's turn in the first generation.", ""})
      .add("last_sigma_deg", last_sigma_deg, 0.01, 180, {"deg", "The same in the last generation.", ""})
      .add("niche_m", niche_m, 0.01, 100,
           {"m", "Poses nearer than this, and than niche_deg, share a niche: only the fittest lives on.", ""})
      .add("niche_deg", niche_deg, 0.1, 180, {"deg", "See niche_m.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Niches proposed at the end.", "More give the Evaluator more to choose from, and cost time."})
      .add("max_points", max_points, 100, 1000000,
           {"points", "Wall points of each map that a pose is tried on while evolving.", ""});
  fit.describe(list);
}

GeneticMerger::GeneticMerger(GeneticOptions options) : options_(std::move(options)) {
  require_valid(options_, "genetic");
}

MergerTraits GeneticMerger::traits() const {
  return {.stochastic = true, .uses_prior = true, .needs_prior = false, .anytime = true, .warm_start = true};
}

Proposal GeneticMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const GeneticOptions& o = options_;
  const std::optional<PoseWindow> window = window_of(request);
  const WallFit fitness(request.target, request.source, kEvolveLevel, o.fit, static_cast<std::size_t>(o.max_points));
  const auto size = static_cast<std::size_t>(o.population);
  const PoseReach niche{o.niche_m, radians(o.niche_deg)};
  Proposal proposal;

  // First generation: what is known, then the sweep's peaks or chance.
  std::vector<ScoredPose> population;
  RandomStream first(context.seed, "genetic/first generation");
  if (request.prior) {
    const Pose2 start = to_local(request.prior->target_from_source, request.target, request.source);
    population.push_back({start, 0});
    for (std::size_t i = 0; i < size / 10; ++i) {
      population.push_back({mutated(start, 5 * o.first_sigma_m, 3 * radians(o.first_sigma_deg), first), 0});
    }
  }
  if (request.carried != nullptr) {
    for (const Pose2& pose : request.carried->target_from_source) {
      population.push_back({to_local(pose, request.target, request.source), 0});
    }
  }
  if (o.seeding == "sweep") {
    announce(context, "propose/sweep");
    const SweepOptions sweep{.lattice = {.angle_step_rad = radians(o.angle_step_deg), .fit = o.fit}};
    const SweepResult found = correlation_sweep(request.target, request.source, window, sweep, context);
    proposal.stopped = found.stopped;
    proposal.surveyed = !found.stopped;
    const std::vector<ScoredPose> heads = distinct_poses(found.peaks, niche, size);
    population.insert(population.end(), heads.begin(), heads.end());
  } else {
    for (std::size_t i = 0; i < size; ++i) {
      population.push_back({uniform_pose(request, window, first), 0});
    }
  }
  std::erase_if(population, [&](const ScoredPose& one) { return !inside(one.pose, window); });
  if (population.empty()) {
    return proposal;
  }
  parallel_for(population.size(), context.num_threads,
               [&](std::size_t i, std::size_t) { population[i].score = fitness(population[i].pose); });

  // Evolution: every pose against its own children; every fourth generation the weaker half of the niches is given up.
  announce(context, "propose/evolve");
  const bool views = wants_views(context);
  const std::vector<ScoredPose> first_generation = views ? population : std::vector<ScoredPose>{};
  Growth growth;
  const int generations = std::min(o.generations, context.stop.iteration_budget());
  for (int generation = 0; generation < generations && !context.stop.stop_requested(); ++generation) {
    const double share = o.generations > 1 ? static_cast<double>(generation) / (o.generations - 1) : 1;
    const double sigma_m = geometric(o.first_sigma_m, o.last_sigma_m, share);
    const double sigma_rad = radians(geometric(o.first_sigma_deg, o.last_sigma_deg, share));
    const std::vector<ScoredPose> parents = population;
    parallel_for(parents.size(), context.num_threads, [&](std::size_t i, std::size_t) {
      RandomStream random(context.seed, "genetic/children",
                          static_cast<std::uint64_t>(generation) * 1000000 + static_cast<std::uint64_t>(i));
      ScoredPose& best = population[i];
      const auto try_child = [&](const Pose2& pose) {
        if (inside(pose, window)) {
          const double f = fitness(pose);
          if (f > best.score) {
            best = {pose, f};
          }
        }
      };
      for (int m = 0; m < o.mutations; ++m) {
        try_child(mutated(best.pose, sigma_m, sigma_rad, random));
      }
      const ScoredPose& mate = parents[random.below(static_cast<std::uint32_t>(parents.size()))];
      const PoseDifference apart = difference_at({}, mate.pose, best.pose);
      if (apart.distance_m < 4 * o.niche_m && apart.angle_rad < 4 * niche.angle_rad) {
        try_child(between(best.pose, mate.pose, random.uniform()));      // Eq. 3.13
        try_child({best.pose.x_m, best.pose.y_m, mate.pose.theta_rad});  // Eq. 3.12
      }
    });
    ++proposal.iterations;
    const bool cull = generation % 4 == 3;
    population =
        distinct_poses(std::move(population), cull ? niche : PoseReach{0.02, radians(0.1)},
                       cull ? std::max<std::size_t>(population.size() / 2, static_cast<std::size_t>(o.candidates))
                            : population.size());
    if (context.trace != nullptr) {
      IterationRecord record{
          .stage = "propose/evolve",
          .iteration = generation,
          .iterations = generations,
          .best_score = population.front().score,
          .mean_score = 0,
          .best_target_from_source = from_local(population.front().pose, request.target, request.source),
          .population = {}};
      for (const ScoredPose& one : population) {
        record.mean_score += one.score / static_cast<double>(population.size());
        record.population.push_back(from_local(one.pose, request.target, request.source));
      }
      context.trace->on_iteration(record);
      growth.add(record);
    }
  }
  proposal.stopped = proposal.stopped || context.stop.stop_requested();

  const auto heads = distinct_poses(std::move(population), niche, static_cast<std::size_t>(o.candidates));
  if (views) {
    show(first_generation, heads, growth, *context.trace);
  }
  proposal.candidates = candidates_of(heads, request);
  for (const Candidate& one : proposal.candidates) {
    proposal.carry.target_from_source.push_back(one.target_from_source);
  }
  return proposal;
}

}  // namespace gridmerge
