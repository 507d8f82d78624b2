#include "gridmerge/align/pipeline.hpp"

#include <algorithm>
#include <chrono>

#include "gridmerge/align/correlation_sweep.hpp"
#include "gridmerge/align/decoy.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

class Stopwatch {
 public:
  /// Seconds since construction or the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Alignment declined(const std::string& reason) {
  Alignment alignment;
  alignment.outcome = Outcome::kDeclined;
  alignment.reasons = {reason};
  return alignment;
}

/// Why a map cannot be aligned with anything; none: it can.
std::optional<std::string> unusable(const PreparedMap& map, const std::string& which) {
  if (map.known_cells() == 0) {
    return "the " + which + " map is empty or all unknown";
  }
  if (map.walls().empty()) {
    return "the " + which + " map has no occupied cell";
  }
  return std::nullopt;
}

/// Share of a pose's evidence that its refinement must keep.
constexpr double kEvidenceKept = 0.97;

/// The first of every group of poses that are one answer; ranked stays ranked.
/// The method's best stays first: a rival that fits better only takes its lead.
std::vector<Hypothesis> distinct(std::vector<Hypothesis> ranked, Point2 source_centre, const VerdictOptions& o,
                                 std::size_t at_most) {
  const auto best = std::find_if(ranked.begin(), ranked.end(), [](const Hypothesis& one) { return one.proposed; });
  if (best != ranked.end()) {
    std::rotate(ranked.begin(), best, best + 1);
  }
  std::vector<Hypothesis> kept;
  for (const Hypothesis& one : ranked) {
    const bool same_answer = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& other) {
      const PoseDifference apart =
          difference_at(source_centre, other.target_from_source.pose, one.target_from_source.pose);
      return apart.distance_m < o.distinct_m && apart.angle_rad < radians(o.distinct_deg);
    });
    if (!same_answer) {
      kept.push_back(one);
      if (kept.size() == at_most) {
        break;
      }
    }
  }
  return kept;
}

/// The poses of the coarse sweep that stand out: what a method that climbs one hill has not looked at.
std::vector<Candidate> rivals(const AlignRequest& request, const SweepResult& survey) {
  constexpr std::size_t kRivals = 24;
  std::vector<Candidate> candidates;
  for (const ScoredPose& peak : survey.peaks) {
    const Pose2 pose = from_local(peak.pose, request.target, request.source);
    const bool taken = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& other) {
      const PoseDifference apart = difference_at(request.source.centre_in_map(), other.target_from_source, pose);
      return apart.distance_m < 1 && apart.angle_rad < radians(6);
    });
    if (!taken) {
      candidates.push_back({pose, peak.score});
      if (candidates.size() == kRivals) {
        break;
      }
    }
  }
  return candidates;
}

void rank(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.figures.support_m > b.figures.support_m; });
}

/// The poses of one alignment, of one method or several, and what is said of them.
class Search {
 public:
  Search(const AlignRequest& request, const PipelineOptions& options, const RunContext& context)
      : request_(request),
        options_(options),
        context_(context),
        evaluator_(request.target, request.source, options.evaluator, context.num_threads) {
    alignment_.seconds.judge += watch_.lap();
  }

  /// Adds what a method proposes; judges all that there is by then.
  void add(const Merger& method, const std::string& name) {
    std::vector<Candidate> candidates = proposed_by(method, name);
    const std::size_t proposed = candidates.size();
    alignment_.seconds.propose += watch_.lap();
    if (proposed > 0 && !background_.surveyed && !context_.stop.stop_requested()) {
      const std::vector<Candidate> others = survey();
      candidates.insert(candidates.end(), others.begin(), others.end());
    }
    if (proposed > 0) {
      compare_with_decoy(candidates);
    }
    std::vector<Hypothesis> added = evaluated(candidates, proposed);
    alignment_.seconds.judge += watch_.lap();
    refine(added, proposed);
    alignment_.seconds.refine += watch_.lap();
    hypotheses_.insert(hypotheses_.end(), std::make_move_iterator(added.begin()), std::make_move_iterator(added.end()));
    rank(hypotheses_);
    judge_all();
    alignment_.seconds.judge += watch_.lap();
  }

  [[nodiscard]] const Alignment& judged() const { return alignment_; }

 private:
  std::vector<Candidate> proposed_by(const Merger& method, const std::string& name) {
    Proposal proposal = method.propose(request_, context_);
    if (!proposal.carry.target_from_source.empty()) {
      alignment_.carry = std::move(proposal.carry);
    }
    for (const std::string& remark : proposal.remarks) {
      alignment_.remarks.push_back((name.empty() ? "" : name + ": ") + remark);
    }
    alignment_.iterations += proposal.iterations;
    alignment_.stopped = proposal.stopped;
    background_.surveyed = background_.surveyed || proposal.surveyed;
    return std::move(proposal.candidates);
  }

  /// Looks at all poses. @return the rivals that the methods may have overlooked
  std::vector<Candidate> survey() {
    // Cells of 0.2 m, of 0.4 m for larger maps.
    const SweepOptions coarse{.lattice = {.angle_step_rad = radians(3), .coarsest_level = 3, .max_cells = 200},
                              .peaks_per_angle = 6};
    const SweepResult sweep =
        correlation_sweep(request_.target, request_.source, window_of(request_), coarse, context_);
    alignment_.stopped = alignment_.stopped || sweep.stopped;
    background_.surveyed = !sweep.stopped;
    return rivals(request_, sweep);
  }

  /// Keeps the best fit of all that was ever put forward, beside that of the source in a mirror.
  void compare_with_decoy(const std::vector<Candidate>& candidates) {
    if (!decoy_ && !context_.stop.stop_requested()) {
      decoy_.emplace(request_, context_);
      alignment_.stopped = alignment_.stopped || decoy_->stopped();
    }
    if (decoy_ && !decoy_->stopped()) {
      const double before = background_.decoy ? background_.decoy->own : 0;
      background_.decoy = {.own = std::max(before, decoy_->fit_of(candidates, context_.num_threads)),
                           .decoy = decoy_->best()};
    }
  }

  [[nodiscard]] std::vector<Hypothesis> evaluated(const std::vector<Candidate>& candidates,
                                                  std::size_t proposed) const {
    std::vector<Hypothesis> hypotheses(candidates.size());
    parallel_for(hypotheses.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      const Candidate& candidate = candidates[i];
      hypotheses[i] = {.target_from_source = {candidate.target_from_source, std::nullopt},
                       .figures = evaluator_.wall_figures(candidate.target_from_source),
                       .method_score = candidate.method_score,
                       .proposed = i < proposed};
    });
    rank(hypotheses);
    return hypotheses;
  }

  void refine(std::vector<Hypothesis>& hypotheses, std::size_t proposed) {
    announce(context_, "refine");
    if (!refiner_) {
      refiner_.emplace(request_.target, request_.source, options_.refinement);
    }
    // A rival that the pipeline found comes on top: the method's own best must not fall out of the refinement for it.
    const auto own = static_cast<std::size_t>(options_.refined_candidates);
    const std::size_t count = std::min(hypotheses.size(), proposed < hypotheses.size() ? 2 * own : own);
    parallel_for(count, context_.num_threads, [&](std::size_t i, std::size_t) { refine(hypotheses[i]); });
  }

  void refine(Hypothesis& one) const {
    const PoseEstimate refined = (*refiner_)(one.target_from_source.pose);
    one.target_from_source.covariance = refined.covariance;
    if (one.proposed && !options_.refine) {
      return;  // stays where the method put it; how well the walls fix it is asked all the same
    }
    if (!inside(to_local(refined.pose, request_.target, request_.source), window_of(request_))) {
      return;
    }
    const Figures figures = evaluator_.wall_figures(refined.pose);
    // Within its tolerance the evidence says little: there the refinement knows better. Where they clearly disagree,
    // little agrees at all, and the evidence is what is judged by.
    if (figures.evidence_m >= kEvidenceKept * one.figures.evidence_m) {
      one.target_from_source.pose = refined.pose;
      one.figures = figures;
    }
  }

  void evaluate_fully(Hypothesis& one) const {
    one.figures = evaluator_.figures(one.target_from_source.pose, context_.num_threads);
  }

  void judge_all() {
    announce(context_, "judge");
    std::vector<Hypothesis>& listed = alignment_.hypotheses;
    listed = distinct(hypotheses_, request_.source.centre_in_map(), options_.verdict,
                      std::max(kCompared, static_cast<std::size_t>(options_.hypotheses)));
    if (!listed.empty()) {
      evaluate_fully(listed.front());
      parallel_for(std::min(listed.size(), kCompared) - 1, context_.num_threads, [&](std::size_t i, std::size_t) {
        Hypothesis& rival = listed[i + 1];
        rival.figures = evaluator_.rival_figures(rival.target_from_source.pose);
      });
      if (const auto better = static_cast<std::ptrdiff_t>(far_more_plausible(listed, options_.verdict)); better > 0) {
        std::rotate(listed.begin(), listed.begin() + better, listed.begin() + better + 1);
        if (!listed.front().target_from_source.covariance) {
          refine(listed.front());
        }
        evaluate_fully(listed.front());
      }
      if (background_.random.poses == 0) {
        background_.random = evaluator_.random_level(context_.seed, context_.num_threads);
      }
    }
    alignment_.random_level = background_.random;
    Background background = background_;
    background.surveyed = background.surveyed && background.decoy;
    background.source_centre = request_.source.centre_in_map();
    alignment_.verdict = judge(listed, background, options_.verdict);
    alignment_.outcome = listed.empty() && alignment_.stopped ? Outcome::kStopped : alignment_.verdict.outcome;
    alignment_.confidence = alignment_.verdict.confidence;
    alignment_.reasons = alignment_.verdict.reasons;
    if (alignment_.stopped) {
      alignment_.reasons.push_back("stopped early: the best so far");
    }
    listed.resize(std::min(listed.size(), static_cast<std::size_t>(options_.hypotheses)));
  }

  const AlignRequest& request_;
  const PipelineOptions& options_;
  const RunContext& context_;
  Stopwatch watch_;
  Evaluator evaluator_;
  std::optional<Refiner> refiner_;
  std::optional<Decoy> decoy_;
  Background background_{.random = {}, .decoy = {}, .surveyed = false};
  std::vector<Hypothesis> hypotheses_;  ///< of all methods, most support first
  Alignment alignment_;
};

}  // namespace

void PipelineOptions::describe(OptionList& list) {
  list.add("refine", refine,
           {"", "Refine the proposed poses to a fraction of a cell.",
            "`false` shows a method bare; how well the walls fix its pose is computed all the same."})
      .add("refined_candidates", refined_candidates, 1, 1000,
           {"poses", "How many of the proposed poses are refined.", "Time grows with it."})
      .add("hypotheses", hypotheses, 1, 100, {"poses", "How many distinct poses the answer lists at the most.", ""});
}

Alignment align(const AlignInput& input, const Merger& method, const PipelineOptions& options,
                const RunContext& context) {
  return align(input, OneMethod(method, ""), options, context);
}

Alignment align(const AlignInput& input, const Chooser& methods, const PipelineOptions& options,
                const RunContext& context) {
  Stopwatch total;
  check_grid(input.target);
  check_grid(input.source);
  announce(context, "prepare");
  const double resolution_m = common_resolution_m(input.target, input.source, options.prepare);
  const PreparedMap target(input.target, resolution_m, options.prepare, context.num_threads);
  const PreparedMap source(input.source, resolution_m, options.prepare, context.num_threads);
  const double prepared = total.lap();
  Alignment alignment = align_prepared({target, source, input.prior, input.carried}, methods, options, context);
  alignment.seconds.prepare = prepared;
  alignment.seconds.align = prepared + total.lap();
  return alignment;
}

Alignment align_prepared(const AlignRequest& request, const Merger& method, const PipelineOptions& options,
                         const RunContext& context) {
  return align_prepared(request, OneMethod(method, ""), options, context);
}

Alignment align_prepared(const AlignRequest& request, const Chooser& methods, const PipelineOptions& options,
                         const RunContext& context) {
  require_valid(options, "pipeline");
  require_valid(options.refinement, "refine");
  require_valid(options.verdict, "verdict");
  for (const std::optional<std::string>& why :
       {unusable(request.target, "target"), unusable(request.source, "source")}) {
    if (why) {
      return declined(*why);
    }
  }
  Stopwatch total;
  const std::unique_ptr<Choice> choice = methods.begin(request, context);
  const double choosing_s = total.lap();
  std::optional<Search> search;
  std::vector<Attempt> tried;
  std::string objection = "no method takes these maps";
  while (const std::optional<MethodPick> pick = choice->next(tried)) {
    if (const std::optional<std::string> objects = pick->method->objection(request)) {
      objection = *objects;
      tried.push_back({.method = pick->name, .why = pick->why, .outcome = Outcome::kDeclined});
      continue;
    }
    if (!search) {
      search.emplace(request, options, context);
    }
    Stopwatch attempt;
    search->add(*pick->method, pick->name);
    const Alignment& so_far = search->judged();
    tried.push_back({pick->name, pick->why, so_far.outcome, so_far.confidence, attempt.lap()});
    if (so_far.outcome == Outcome::kMerged || context.stop.stop_requested()) {
      break;
    }
  }
  Alignment alignment = search ? search->judged() : declined(objection);
  alignment.attempts = std::move(tried);
  alignment.story = choice->story();
  alignment.seconds.choose = alignment.story.empty() ? 0 : choosing_s;
  alignment.seconds.align = choosing_s + alignment.seconds.propose + alignment.seconds.refine + alignment.seconds.judge;
  return alignment;
}

}  // namespace gridmerge
