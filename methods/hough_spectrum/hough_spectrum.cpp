#include "methods/hough_spectrum/hough_spectrum.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/fourier.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/hough_spectrum/axis_spectra.hpp"
#include "methods/hough_spectrum/hough_views.hpp"
#include "methods/hough_spectrum/spectrum.hpp"

namespace gridmerge {
namespace {

using hough::Agreement;
using hough::AxisMatcher;
using hough::AxisOptions;
using hough::Peak;
using hough::Translation;

constexpr int kWallLevel = 1;   ///< where walls vote: one point for each cell of it
constexpr int kClimbLevel = 2;  ///< where poses are scored and climb

/// Rotations nearer than this are tried as one.
constexpr double kSameRotationRad = radians(2);

/// A translation of the spectra may be half a step off, its rotation by a degree: it is scored with more tolerance than
/// it then climbs with, on fewer points; with more still where rotations are only a step near.
constexpr double kScoringToleranceM = 0.2;
constexpr double kAllRoundToleranceM = 0.3;
constexpr std::size_t kScoringPoints = 600;

/// How many times wider bins and stretches are where rotations all round are tried.
constexpr double kAllRoundCoarser = 2;

constexpr PoseReach kFirstStep{0.2, radians(1)};
constexpr PoseReach kLastStep{0.05, radians(0.25)};

/// One map as the method sees it.
struct SeenMap {
  std::vector<hough::OrientedWall> walls;
  hough::HoughTransform transform;
  std::vector<float> spectrum;

  SeenMap(const PreparedMap& map, int angles, double spread_rad)
      : walls(hough::oriented_walls(map, map.level(kWallLevel))),
        transform(
            hough::oriented_transform(walls, angles, map.radius_m(), map.level(kWallLevel).resolution_m, spread_rad)),
        spectrum(hough::hough_spectrum(transform)) {}
};

struct Rotation {
  double turn_rad = 0;
  bool all_round = false;  ///< no maximum of the spectra: looked at with wider bins
};

/// A multiple of four, so that a quarter of a turn is a whole number of bins.
int angle_count(double step_deg) { return 4 * std::max(1, static_cast<int>(std::lround(90 / step_deg))); }

/// The direction across the strongest walls that both maps have when the source is turned, in the target's frame;
/// directions a quarter of a turn apart count as one.
double common_axis(std::span<const float> target, std::span<const float> source, double turn_rad) {
  const int n = static_cast<int>(target.size());
  const int turn = static_cast<int>(std::lround(turn_rad / (2 * kPi) * n));
  const int quarter = n / 4;
  std::vector<float> strength(static_cast<std::size_t>(quarter), 0.0F);
  for (int k = 0; k < n; ++k) {
    const int from = ((k - turn) % n + n) % n;
    strength[static_cast<std::size_t>(k % quarter)] +=
        target[static_cast<std::size_t>(k)] * source[static_cast<std::size_t>(from)];
  }
  const std::vector<Peak> peaks = hough::periodic_peaks(strength);
  return peaks.empty() ? 0 : peaks.front().at * 2 * kPi / n;
}

/// @param coarser  how many times wider than need be
AxisOptions axis_options(const HoughSpectrumOptions& o, const AlignRequest& request, double coarser) {
  constexpr double kMostOffsets = 1600;  // of a spectrum: vast maps get wider bins
  constexpr double kMostStretches = 40;
  const double span_m = 2 * (request.target.radius_m() + request.source.radius_m());
  const double offset_step_m = coarser * std::max(request.target.level(kWallLevel).resolution_m, span_m / kMostOffsets);
  return {.offset_step_m = offset_step_m,
          .stretch_m = coarser * std::max(o.stretch_m, span_m / 2 / kMostStretches),
          .blur_m = std::max(o.blur_m, offset_step_m),
          .background_m = std::max(o.background_m, 5 * offset_step_m)};
}

WallFitOptions with_tolerance(WallFitOptions options, double at_least_m) {
  options.tolerance_m = std::max(options.tolerance_m, at_least_m);
  return options;
}

/// One call of propose.
class Search {
 public:
  Search(const HoughSpectrumOptions& options, const AlignRequest& request, const RunContext& context)
      : options_(options),
        request_(request),
        context_(context),
        window_(window_of(request)),
        target_(request.target, angle_count(options.angle_step_deg), radians(options.normal_spread_deg)),
        source_(request.source, angle_count(options.angle_step_deg), radians(options.normal_spread_deg)),
        correlation_(circular_correlation(source_.spectrum, target_.spectrum)),
        rotations_(rotations()),
        matcher_(request.target.radius_m(), request.source.radius_m(), axis_options(options, request, 1)),
        wide_matcher_(request.target.radius_m(), request.source.radius_m(),
                      axis_options(options, request, kAllRoundCoarser)),
        distinct_{options.distinct_m, radians(options.distinct_deg)} {}

  [[nodiscard]] Proposal run() {
    announce(context_, "propose/translations");
    std::vector<ScoredPose> poses = translated();
    announce(context_, "propose/climb");
    poses = climbed(std::move(poses));
    proposal_.candidates = candidates_of(
        distinct_poses(std::move(poses), distinct_, static_cast<std::size_t>(options_.candidates)), request_);
    proposal_.stopped = stopped_ || context_.stop.stop_requested();
    // Not `surveyed`: at rotations that are no maximum of the spectra there may be rivals.
    if (wants_views(context_)) {
      show();
    }
    return std::move(proposal_);
  }

 private:
  [[nodiscard]] bool poll_stop() {
    if (context_.stop.stop_requested()) {
      stopped_ = true;
    }
    return stopped_;
  }

  [[nodiscard]] double bin_rad() const { return 2 * kPi / static_cast<double>(correlation_.size()); }

  /// Step 1: the local maxima of the spectra's cross-correlation, each with its opposite; rotations all round
  /// besides, where a map has no direction that stands out.
  [[nodiscard]] std::vector<Rotation> rotations() const {
    std::vector<Rotation> chosen;
    const auto add = [&](double turn_rad, bool all_round) {
      const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](const Rotation& other) {
        return std::abs(wrap_angle(other.turn_rad - turn_rad)) < kSameRotationRad;
      });
      const bool allowed = !window_ || std::abs(wrap_angle(turn_rad - window_->centre.theta_rad)) <= window_->angle_rad;
      if (!taken && allowed) {
        chosen.push_back({wrap_angle(turn_rad), all_round});
      }
    };
    if (request_.prior) {
      add(to_local(request_.prior->target_from_source, request_.target, request_.source).theta_rad, false);
    }
    const auto [low, high] = std::minmax_element(correlation_.begin(), correlation_.end());
    const double bar = *low + options_.rotation_percent / 100 * static_cast<double>(*high - *low);
    for (const Peak& peak : hough::periodic_peaks(correlation_)) {
      if (peak.value < bar || static_cast<int>(chosen.size()) >= options_.rotations) {
        break;
      }
      add(peak.at * bin_rad(), false);
      add(peak.at * bin_rad() + kPi, false);  // a wall seen from its other side
    }
    if (std::min(hough::contrast(target_.spectrum), hough::contrast(source_.spectrum)) < options_.flat_contrast) {
      const int steps = static_cast<int>(std::ceil(360 / options_.flat_step_deg));
      for (int i = 0; i < steps; ++i) {
        add(2 * kPi * i / steps, true);
      }
    }
    return chosen;
  }

  /// Step 2: for each rotation the translations at which the X- and Y-spectra agree, scored on the maps.
  [[nodiscard]] std::vector<ScoredPose> translated() {
    const bool all_round = !rotations_.empty() && rotations_.back().all_round;
    const WallFit fit(request_.target, request_.source, kClimbLevel,
                      with_tolerance(options_.fit, all_round ? kAllRoundToleranceM : kScoringToleranceM),
                      kScoringPoints);
    const auto count =
        static_cast<std::size_t>(std::min(static_cast<int>(rotations_.size()), context_.stop.iteration_budget()));
    std::vector<std::optional<std::vector<ScoredPose>>> found(count);
    parallel_for(count, context_.num_threads, [&](std::size_t i, std::size_t) {
      if (!poll_stop()) {
        found[i] = poses_at(rotations_[i], fit);
      }
    });

    std::vector<ScoredPose> all;
    if (request_.prior) {
      const Pose2 start = to_local(request_.prior->target_from_source, request_.target, request_.source);
      all.push_back({start, fit(start)});
    }
    for (const std::optional<std::vector<ScoredPose>>& poses : found) {
      if (poses) {
        all.insert(all.end(), poses->begin(), poses->end());
        record(*poses);
      }
    }
    return all;
  }

  [[nodiscard]] Agreement agreement_at(const Rotation& rotation) const {
    const AxisMatcher& matcher = rotation.all_round ? wide_matcher_ : matcher_;
    const double axis_rad = common_axis(target_.spectrum, source_.spectrum, rotation.turn_rad);
    return matcher.agreement(matcher.spectra(target_.walls, axis_rad),
                             matcher.spectra(source_.walls, axis_rad - rotation.turn_rad), axis_rad);
  }

  [[nodiscard]] std::vector<Translation> translations_of(const Agreement& agreement) const {
    return hough::best_translations(agreement, static_cast<std::size_t>(options_.translations), window_);
  }

  [[nodiscard]] std::vector<ScoredPose> poses_at(const Rotation& rotation, const WallFit& fit) const {
    std::vector<ScoredPose> poses;
    const auto add = [&](Point2 at) {
      const Pose2 pose{at.x_m, at.y_m, rotation.turn_rad};
      poses.push_back({pose, fit(pose)});
    };
    for (const Translation& translation : translations_of(agreement_at(rotation))) {
      add(translation.at);
    }
    if (window_) {
      add(window_->centre.translation());  // a narrow window may lie between the maxima
    }
    return poses;
  }

  /// One rotation done: `poses` are what it gave.
  void record(const std::vector<ScoredPose>& poses) {
    double mean = 0;
    IterationRecord record{.stage = "propose/translations",
                           .iteration = proposal_.iterations,
                           .iterations = static_cast<int>(rotations_.size()),
                           .best_score = 0,
                           .mean_score = 0,
                           .best_target_from_source = {},
                           .population = {}};
    for (const ScoredPose& one : poses) {
      mean += one.score / static_cast<double>(poses.size());
      record.population.push_back(from_local(one.pose, request_.target, request_.source));
      if (one.score > best_.score) {
        best_ = one;
      }
    }
    ++proposal_.iterations;
    if (best_.score > std::numeric_limits<double>::lowest()) {
      record.best_score = best_.score;
      record.mean_score = poses.empty() ? best_.score : mean;
      record.best_target_from_source = from_local(best_.pose, request_.target, request_.source);
    }
    if (context_.trace != nullptr) {
      context_.trace->on_iteration(record);
    }
  }

  /// Step 3: the best of them, each led uphill.
  [[nodiscard]] std::vector<ScoredPose> climbed(std::vector<ScoredPose> poses) {
    const WallFit fit(request_.target, request_.source, kClimbLevel, options_.fit,
                      static_cast<std::size_t>(options_.max_points));
    poses = distinct_poses(std::move(poses), distinct_, static_cast<std::size_t>(options_.climbed));
    parallel_for(poses.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      ScoredPose& one = poses[i];
      one = poll_stop() ? ScoredPose{one.pose, fit(one.pose)} : climb(fit, one.pose, kFirstStep, kLastStep, window_);
    });
    return poses;
  }

  void show() const {
    TraceSink& trace = *context_.trace;
    trace.on_view(hough::transform_view("hough_transform_target", "target", target_.transform));
    trace.on_view(hough::transform_view("hough_transform_source", "source", source_.transform));
    std::vector<double> maxima_rad;
    for (const Rotation& rotation : rotations_) {
      if (!rotation.all_round) {
        maxima_rad.push_back(rotation.turn_rad);
      }
    }
    for (const View& view : hough::spectrum_views(target_.spectrum, source_.spectrum, correlation_, maxima_rad)) {
      trace.on_view(view);
    }
    if (proposal_.candidates.empty()) {
      return;
    }
    const Pose2 best = to_local(proposal_.candidates.front().target_from_source, request_.target, request_.source);
    const Agreement agreement = agreement_at({best.theta_rad, false});
    const Point2 along = Pose2{0, 0, -agreement.axis_rad} * best.translation();
    for (const auto& [name, axis_rad, chosen_m] :
         {std::tuple{"x", agreement.axis_rad, along.x_m}, {"y", agreement.axis_rad + kPi / 2, along.y_m}}) {
      for (const View& view : hough::axis_views(name, matcher_.axis_spectrum(target_.walls, axis_rad),
                                                matcher_.axis_spectrum(source_.walls, axis_rad - best.theta_rad),
                                                matcher_.options().offset_step_m, chosen_m)) {
        trace.on_view(view);
      }
    }
    trace.on_view(hough::agreement_view(agreement, translations_of(agreement)));
    trace.on_view(hough::hypotheses_view(proposal_.candidates, request_));
  }

  const HoughSpectrumOptions& options_;
  const AlignRequest& request_;
  const RunContext& context_;
  std::optional<PoseWindow> window_;
  SeenMap target_;
  SeenMap source_;
  std::vector<float> correlation_;  ///< by rotation of the source
  std::vector<Rotation> rotations_;
  AxisMatcher matcher_;
  AxisMatcher wide_matcher_;
  PoseReach distinct_;
  ScoredPose best_{{}, std::numeric_limits<double>::lowest()};  ///< of all rotations recorded so far
  Proposal proposal_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace

void HoughSpectrumOptions::describe(OptionList& list) {
  list.add("angle_step_deg", angle_step_deg, 0.1, 10,
           {"deg", "Bin of the Hough transform's angle; peaks are placed between bins.",
            "Finer tells long straight walls apart; time grows with its inverse."})
      .add("normal_spread_deg", normal_spread_deg, 1, 90,
           {"deg", "How far from its own normal a wall votes for lines, either way.",
            "Wider for rough walls, whose normals are noisy; walls then vote for more lines that are none."})
      .add("rotations", rotations, 1, 1000,
           {"", "Maxima are taken until so many rotations are tried; each brings its opposite along.",
            "Raise it for places with many wall directions; time grows with it."})
      .add("rotation_percent", rotation_percent, 0, 100,
           {"%", "How high a maximum of the spectra's correlation must be, between its lowest and its highest value.",
            "Lower it where maps share little: other walls may then make the highest maxima."})
      .add(
          "flat_contrast", flat_contrast, 1, 1000,
          {"", "A spectrum whose highest value is below so many times its mean is flat: rotations all round are tried.",
           "1 never does that: quicker, and of no use in a forest."})
      .add("flat_step_deg", flat_step_deg, 0.5, 30,
           {"deg", "Step of the rotations all round.", "Time grows with its inverse; above 4 deg some are missed."})
      .add("stretch_m", stretch_m, 0.1, 1000,
           {"m", "Length of the stretches along the walls that X- and Y-spectra are kept apart by.",
            "As long as the maps are wide, the spectra are the published ones."})
      .add("blur_m", blur_m, 0.01, 5,
           {"m", "Standard deviation by which the offsets of a wall in two maps may differ.",
            "Raise it for maps bent by drift."})
      .add("background_m", background_m, 0.01, 100,
           {"m", "Width over which the mean of a spectrum is taken off: walls beside walls then count against.", ""})
      .add("translations", translations, 1, 10000,
           {"", "How many translations are tried at each rotation.",
            "Raise it for self-similar places; time grows with it."})
      .add("climbed", climbed, 1, 10000,
           {"poses", "How many of all poses are led uphill.", "Time grows with it; half of all goes here."})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses nearer than this, and than distinct_deg, are one answer.", ""})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "See distinct_m.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Poses proposed at the end.", "More give the Evaluator more to choose from, and cost time."})
      .add("max_points", max_points, 100, 1000000,
           {"points", "Wall points of each map that a pose is tried on while it climbs.", ""});
  fit.describe(list);
}

HoughSpectrumMerger::HoughSpectrumMerger(HoughSpectrumOptions options) : options_(std::move(options)) {
  require_valid(options_, "hough_spectrum");
}

MergerTraits HoughSpectrumMerger::traits() const {
  return {.stochastic = false, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal HoughSpectrumMerger::propose(const AlignRequest& request, const RunContext& context) const {
  announce(context, "propose/spectra");
  return Search(options_, request, context).run();
}

}  // namespace gridmerge
