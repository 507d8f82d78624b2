#include "methods/hough_spectrum/paper_hough_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/fourier.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/hough_spectrum/hough_views.hpp"
#include "methods/hough_spectrum/spectrum.hpp"

namespace gridmerge {
namespace {

using hough::HoughTransform;
using hough::Peak;

HoughTransform transform_of(const PreparedMap& map, double angle_step_deg) {
  const int angles = std::max(4, static_cast<int>(std::lround(360 / angle_step_deg)));
  return hough::full_transform(map.walls(), angles, map.radius_m(), map.resolution_m());
}

/// Occupied cells by their offset along a direction, in cells; bin size/2 is for offset 0. As long as both maps are
/// wide together, so that no shift wraps round onto another.
std::vector<float> axis_spectrum(const PreparedMap& map, double axis_rad, std::size_t size) {
  std::vector<float> spectrum(size, 0.0F);
  const float per_cell = static_cast<float>(1 / map.resolution_m());
  const float c = static_cast<float>(std::cos(axis_rad)) * per_cell;
  const float s = static_cast<float>(std::sin(axis_rad)) * per_cell;
  const float middle = static_cast<float>(size / 2) + 0.5F;
  for (const WallPoint& wall : map.walls()) {
    spectrum[static_cast<std::size_t>(c * wall.at.x_m + s * wall.at.y_m + middle)] += 1;
  }
  return spectrum;
}

std::size_t axis_size(const AlignRequest& request) {
  const double span_m = 2 * (request.target.radius_m() + request.source.radius_m());
  return static_cast<std::size_t>(fast_size(static_cast<int>(span_m / request.target.resolution_m()) + 8));
}

/// The shift of the source's spectrum, from `low_m` to `high_m`, at which it looks most like the target's.
double best_shift_m(const std::vector<float>& target, const std::vector<float>& source, double cell_m, double low_m,
                    double high_m) {
  const std::vector<float> correlation = circular_correlation(source, target);
  const int n = static_cast<int>(correlation.size());
  const int low = std::max(1 - n / 2, static_cast<int>(std::ceil(low_m / cell_m)));
  const int high = std::min(n / 2, static_cast<int>(std::floor(high_m / cell_m)));
  int best = low;
  for (int shift = low; shift <= high; ++shift) {
    if (correlation[static_cast<std::size_t>((shift + n) % n)] >
        correlation[static_cast<std::size_t>((best + n) % n)]) {
      best = shift;
    }
  }
  return best * cell_m;
}

/// Eq. 2.8, over the cells that both maps know; 0 where there are none.
double acceptance_index(const MapLevel& target, const MapLevel& source, const Pose2& local_target_from_source) {
  const float per_cell = static_cast<float>(1 / target.resolution_m);
  const float c = static_cast<float>(std::cos(local_target_from_source.theta_rad));
  const float s = static_cast<float>(std::sin(local_target_from_source.theta_rad));
  const Point2 corner = local_target_from_source * source.lower_left;
  const float x0 = static_cast<float>(corner.x_m - target.lower_left.x_m) * per_cell;
  const float y0 = static_cast<float>(corner.y_m - target.lower_left.y_m) * per_cell;
  std::int64_t agree = 0;
  std::int64_t differ = 0;
  for (int row = 0; row < source.height; ++row) {
    for (int column = 0; column < source.width; ++column) {
      const CellState state = source.state[source.offset(column, row)];
      if (state == CellState::kUnseen) {
        continue;
      }
      const float x = static_cast<float>(column) + 0.5F;
      const float y = static_cast<float>(row) + 0.5F;
      const int to_column = static_cast<int>(std::floor(c * x - s * y + x0));
      const int to_row = static_cast<int>(std::floor(s * x + c * y + y0));
      if (target.contains(to_column, to_row)) {
        const CellState other = target.state[target.offset(to_column, to_row)];
        agree += other == state ? 1 : 0;
        differ += other != state && other != CellState::kUnseen ? 1 : 0;
      }
    }
  }
  return agree + differ == 0 ? 0 : static_cast<double>(agree) / static_cast<double>(agree + differ);
}

/// One call of propose.
class PaperSearch {
 public:
  PaperSearch(const PaperHoughSpectrumOptions& options, const AlignRequest& request, const RunContext& context)
      : options_(options),
        request_(request),
        context_(context),
        window_(window_of(request)),
        target_(transform_of(request.target, options.angle_step_deg)),
        source_(transform_of(request.source, options.angle_step_deg)),
        target_spectrum_(hough::hough_spectrum(target_)),
        source_spectrum_(hough::hough_spectrum(source_)),
        correlation_(circular_correlation(source_spectrum_, target_spectrum_)),
        // Both maps are turned so that the target's strongest walls lie along an axis.
        axis_rad_(target_.angle_rad(static_cast<int>(
            std::max_element(target_spectrum_.begin(), target_spectrum_.end()) - target_spectrum_.begin()))) {}

  [[nodiscard]] Proposal run() {
    const std::vector<double> turns = rotations();
    const auto count =
        static_cast<std::size_t>(std::min(static_cast<int>(turns.size()), context_.stop.iteration_budget()));
    std::vector<std::optional<ScoredPose>> found(count);
    parallel_for(count, context_.num_threads, [&](std::size_t i, std::size_t) {
      if (!context_.stop.stop_requested()) {
        found[i] = hypothesis(turns[i]);
      }
    });
    Proposal proposal;
    std::vector<ScoredPose> poses;
    for (const std::optional<ScoredPose>& one : found) {
      if (one) {
        poses.push_back(*one);
        record(poses, proposal.iterations++, static_cast<int>(count));
      }
    }
    proposal.stopped = context_.stop.stop_requested() || poses.size() < count;
    std::erase_if(poses, [&](const ScoredPose& one) { return !inside(one.pose, window_); });
    std::stable_sort(poses.begin(), poses.end(),
                     [](const ScoredPose& a, const ScoredPose& b) { return a.score > b.score; });
    proposal.candidates = candidates_of(poses, request_);
    if (wants_views(context_)) {
      show(turns, poses, proposal);
    }
    return proposal;
  }

 private:
  /// The bins of the n highest local maxima of the cross-correlation; with their neighbours in the robust variant.
  [[nodiscard]] std::vector<double> rotations() const {
    std::vector<double> turns;
    int maxima = 0;
    for (const Peak& peak : hough::periodic_peaks(correlation_)) {
      const int bin = static_cast<int>(std::lround(peak.at));
      const int spread = options_.robust ? 1 : 0;
      bool allowed = false;
      for (int k = bin - spread; k <= bin + spread; ++k) {
        const double turn = wrap_angle(target_.angle_rad(k));
        if (!window_ || std::abs(wrap_angle(turn - window_->centre.theta_rad)) <= window_->angle_rad) {
          turns.push_back(turn);
          allowed = true;
        }
      }
      maxima += allowed ? 1 : 0;
      if (maxima == options_.rotations) {
        break;
      }
    }
    return turns;
  }

  /// For one rotation: the best shift along x, the best along y, and the acceptance index there.
  [[nodiscard]] ScoredPose hypothesis(double turn_rad) const {
    const std::size_t size = axis_size(request_);
    const double anywhere_m = request_.target.radius_m() + request_.source.radius_m();
    const Point2 centre =
        window_ ? Pose2{0, 0, -axis_rad_} * window_->centre.translation() : Point2{};  // along the axes
    const double reach_m = window_ ? window_->radius_m : anywhere_m;
    const auto shift_m = [&](double axis_rad, double about_m) {
      return best_shift_m(axis_spectrum(request_.target, axis_rad, size),
                          axis_spectrum(request_.source, axis_rad - turn_rad, size), request_.target.resolution_m(),
                          about_m - reach_m, about_m + reach_m);
    };
    const Point2 shift{shift_m(axis_rad_, centre.x_m), shift_m(axis_rad_ + kPi / 2, centre.y_m)};
    const Point2 translation = Pose2{0, 0, axis_rad_} * shift;
    const Pose2 pose{translation.x_m, translation.y_m, turn_rad};
    return {pose, acceptance_index(request_.target.level(0), request_.source.level(0), pose)};
  }

  /// `poses` are those found so far.
  void record(const std::vector<ScoredPose>& poses, int iteration, int iterations) const {
    if (context_.trace == nullptr) {
      return;
    }
    const ScoredPose& best = *std::max_element(
        poses.begin(), poses.end(), [](const ScoredPose& a, const ScoredPose& b) { return a.score < b.score; });
    context_.trace->on_iteration({.stage = "propose/translations",
                                  .iteration = iteration,
                                  .iterations = iterations,
                                  .best_score = best.score,
                                  .mean_score = poses.back().score,
                                  .best_target_from_source = from_local(best.pose, request_.target, request_.source),
                                  .population = {from_local(poses.back().pose, request_.target, request_.source)}});
  }

  void show(const std::vector<double>& turns, const std::vector<ScoredPose>& poses, const Proposal& proposal) const {
    TraceSink& trace = *context_.trace;
    trace.on_view(hough::transform_view("hough_transform_target", "target", target_));
    trace.on_view(hough::transform_view("hough_transform_source", "source", source_));
    for (const View& view : hough::spectrum_views(target_spectrum_, source_spectrum_, correlation_, turns)) {
      trace.on_view(view);
    }
    if (poses.empty()) {
      return;
    }
    const Pose2& best = poses.front().pose;
    const Point2 along = Pose2{0, 0, -axis_rad_} * best.translation();
    const std::size_t size = axis_size(request_);
    for (const auto& [name, axis_rad, chosen_m] :
         {std::tuple{"x", axis_rad_, along.x_m}, {"y", axis_rad_ + kPi / 2, along.y_m}}) {
      for (const View& view : hough::axis_views(name, axis_spectrum(request_.target, axis_rad, size),
                                                axis_spectrum(request_.source, axis_rad - best.theta_rad, size),
                                                request_.target.resolution_m(), chosen_m)) {
        trace.on_view(view);
      }
    }
    trace.on_view(hough::hypotheses_view(proposal.candidates, request_));
  }

  const PaperHoughSpectrumOptions& options_;
  const AlignRequest& request_;
  const RunContext& context_;
  std::optional<PoseWindow> window_;
  HoughTransform target_;
  HoughTransform source_;
  std::vector<float> target_spectrum_;
  std::vector<float> source_spectrum_;
  std::vector<float> correlation_;  ///< by rotation of the source
  double axis_rad_ = 0;             ///< of x, in the target's local frame
};

}  // namespace

void PaperHoughSpectrumOptions::describe(OptionList& list) {
  list.add("angle_step_deg", angle_step_deg, 0.1, 10,
           {"deg", "Bin of the Hough transform's angle (360 / theta_S).",
            "Finer places rotations better; time grows with its inverse."})
      .add("rotations", rotations, 1, 1000,
           {"", "How many maxima of the cross-correlation are tried (n).",
            "A place with walls at right angles has four; raise it where there are more directions."})
      .add("robust", robust,
           {"", "Tries the bins beside each maximum as well.", "Takes three times as long; better where walls bend."});
}

PaperHoughSpectrumMerger::PaperHoughSpectrumMerger(PaperHoughSpectrumOptions options) : options_(options) {
  require_valid(options_, "hough_spectrum (paper)");
}

MergerTraits PaperHoughSpectrumMerger::traits() const {
  return {.stochastic = false, .uses_prior = true, .needs_prior = false, .anytime = false, .warm_start = false};
}

Proposal PaperHoughSpectrumMerger::propose(const AlignRequest& request, const RunContext& context) const {
  announce(context, "propose/spectra");
  return PaperSearch(options_, request, context).run();
}

}  // namespace gridmerge
