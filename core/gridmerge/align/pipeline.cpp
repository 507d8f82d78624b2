#include "gridmerge/align/pipeline.hpp"

#include <algorithm>
#include <chrono>

#include "gridmerge/align/correlation_sweep.hpp"
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

/// The poses of a coarse sweep that stand out: what a method that climbs one hill has not looked at.
std::vector<Candidate> rivals(const AlignRequest& request, const RunContext& context) {
  constexpr std::size_t kRivals = 24;
  const SweepOptions sweep{.lattice = {.angle_step_rad = radians(3), .coarsest_level = 3, .max_cells = 200},
                           .peaks_per_angle = 6};
  const SweepResult found = correlation_sweep(request.target, request.source, window_of(request), sweep, context);
  std::vector<Candidate> candidates;
  for (const ScoredPose& peak : found.peaks) {
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

}  // namespace

void PipelineOptions::describe(OptionList& list) {
  list.add("refine", refine, {"", "Refine the proposed poses to a fraction of a cell.", "`false` shows a method bare."})
      .add("refined_candidates", refined_candidates, 1, 1000,
           {"poses", "How many of the proposed poses are refined.", "Time grows with it."})
      .add("hypotheses", hypotheses, 1, 100, {"poses", "How many distinct poses the answer lists at the most.", ""});
}

Alignment align(const AlignInput& input, const Merger& method, const PipelineOptions& options,
                const RunContext& context) {
  Stopwatch total;
  check_grid(input.target);
  check_grid(input.source);
  announce(context, "prepare");
  const double resolution_m = common_resolution_m(input.target, input.source, options.prepare);
  const PreparedMap target(input.target, resolution_m, options.prepare, context.num_threads);
  const PreparedMap source(input.source, resolution_m, options.prepare, context.num_threads);
  const double prepared = total.lap();
  Alignment alignment = align_prepared({target, source, input.prior, input.carried}, method, options, context);
  alignment.seconds.prepare = prepared;
  alignment.seconds.align = prepared + total.lap();
  return alignment;
}

Alignment align_prepared(const AlignRequest& request, const Merger& method, const PipelineOptions& options,
                         const RunContext& context) {
  require_valid(options, "pipeline");
  require_valid(options.refinement, "refine");
  require_valid(options.verdict, "verdict");
  const PreparedMap& target = request.target;
  const PreparedMap& source = request.source;
  for (const std::optional<std::string>& why : {unusable(target, "target"), unusable(source, "source")}) {
    if (why) {
      return declined(*why);
    }
  }
  if (const std::optional<std::string> objection = method.objection(request)) {
    return declined(*objection);
  }

  Stopwatch watch;
  Alignment alignment;
  Proposal proposal = method.propose(request, context);
  alignment.carry = std::move(proposal.carry);
  alignment.remarks = std::move(proposal.remarks);
  alignment.iterations = proposal.iterations;
  alignment.stopped = proposal.stopped;
  std::vector<Candidate> candidates = std::move(proposal.candidates);
  const std::size_t proposed = candidates.size();
  if (!proposal.surveyed && proposed > 0 && !context.stop.stop_requested()) {
    const std::vector<Candidate> others = rivals(request, context);
    candidates.insert(candidates.end(), others.begin(), others.end());
    proposal.surveyed = !context.stop.stop_requested();
    alignment.stopped = alignment.stopped || !proposal.surveyed;
  }
  alignment.seconds.propose = watch.lap();

  const Evaluator evaluator(target, source, options.evaluator);
  std::vector<Hypothesis> hypotheses(candidates.size());
  parallel_for(hypotheses.size(), context.num_threads, [&](std::size_t i, std::size_t) {
    const Candidate& candidate = candidates[i];
    hypotheses[i] = {.target_from_source = {candidate.target_from_source, std::nullopt},
                     .figures = evaluator.wall_figures(candidate.target_from_source),
                     .method_score = candidate.method_score,
                     .proposed = i < proposed};
  });
  rank(hypotheses);
  alignment.seconds.judge = watch.lap();

  if (options.refine || proposed < hypotheses.size()) {
    const std::optional<PoseWindow> window = window_of(request);
    const Refiner refiner(target, source, options.refinement);
    announce(context, "refine");
    // A rival that the pipeline found comes on top: the method's own best must not fall out of the refinement for it.
    const auto own = static_cast<std::size_t>(options.refined_candidates);
    const std::size_t count = std::min(hypotheses.size(), proposed < hypotheses.size() ? 2 * own : own);
    parallel_for(count, context.num_threads, [&](std::size_t i, std::size_t) {
      Hypothesis& one = hypotheses[i];
      if (one.proposed && !options.refine) {
        return;
      }
      const PoseEstimate refined = refiner(one.target_from_source.pose);
      const Figures figures = evaluator.wall_figures(refined.pose);
      one.target_from_source.covariance = refined.covariance;
      if (!inside(to_local(refined.pose, target, source), window)) {
        return;
      }
      // Within its tolerance the evidence says little: there the refinement knows better. Where they clearly disagree,
      // little agrees at all, and the evidence is what is judged by.
      if (figures.evidence_m >= kEvidenceKept * one.figures.evidence_m) {
        one.target_from_source.pose = refined.pose;
        one.figures = figures;
      }
    });
    rank(hypotheses);
    alignment.seconds.refine = watch.lap();
  }

  announce(context, "judge");
  alignment.hypotheses = distinct(hypotheses, source.centre_in_map(), options.verdict,
                                  static_cast<std::size_t>(std::max(2, options.hypotheses)));
  if (!alignment.hypotheses.empty()) {
    // All figures of the best, of its strongest rival, and of those without conflict: they enter the verdict.
    const std::size_t rival = strongest_rival(alignment.hypotheses);
    parallel_for(alignment.hypotheses.size(), context.num_threads, [&](std::size_t i, std::size_t) {
      Hypothesis& one = alignment.hypotheses[i];
      if (i == 0 || i == rival || is_spotless(one, options.verdict)) {
        one.figures = evaluator.figures(one.target_from_source.pose);
      }
    });
    alignment.random_level = evaluator.random_level(context.seed);
  }
  alignment.verdict = judge(alignment.hypotheses, alignment.random_level, options.verdict, proposal.surveyed);
  alignment.outcome = alignment.hypotheses.empty() && alignment.stopped ? Outcome::kStopped : alignment.verdict.outcome;
  alignment.confidence = alignment.verdict.confidence;
  alignment.reasons = alignment.verdict.reasons;
  if (alignment.stopped) {
    alignment.reasons.push_back("stopped early: the best so far");
  }
  alignment.hypotheses.resize(std::min(alignment.hypotheses.size(), static_cast<std::size_t>(options.hypotheses)));
  alignment.seconds.judge += watch.lap();
  alignment.seconds.align = alignment.seconds.propose + alignment.seconds.refine + alignment.seconds.judge;
  return alignment;
}

}  // namespace gridmerge
