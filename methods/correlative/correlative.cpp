#include "methods/correlative/correlative.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>

#include "gridmerge/align/lattice_scores.hpp"
#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"

namespace gridmerge {
namespace {

/// The level of the maps on which the lattice's poses climb on, between the lattice's points.
constexpr int kClimbLevel = 1;
constexpr int kPeaksPerAngle = 16;
constexpr std::size_t kClimbPoints = 3000;

/// What the best pose of all is known to score at the least. More than nothing, at any rate: a pose that scores less is
/// no answer.
class AtLeast {
 public:
  void raise(double score) {
    double known = score_.load();
    while (known < score && !score_.compare_exchange_weak(known, score)) {
    }
  }
  [[nodiscard]] double score() const { return score_.load(); }

 private:
  std::atomic<double> score_ = 1;
};

/// The poses of one angle that could be the best of all, as far as the rounding can tell.
std::vector<LatticePeak> contenders_of(const ScoreSurface& surface, const PoseLattice& lattice, AtLeast& at_least) {
  const auto visit = [&](float above, auto&& take) {
    for (int row = 0; row < surface.size; ++row) {
      const float* line = &surface.score[surface.offset(0, row)];
      for (int column = 0; column < surface.size; ++column) {
        if (line[column] >= above && lattice.holds(surface.at(column, row))) {
          above = take(column, row, line[column]);
        }
      }
    }
  };
  const auto could_be = [&] { return static_cast<float>(at_least.score() - surface.rounding); };
  visit(could_be(), [&](int, int, float score) {
    at_least.raise(static_cast<double>(score) - surface.rounding);
    return could_be();
  });
  std::vector<LatticePeak> found;
  visit(could_be(), [&](int column, int row, float score) {
    found.push_back({surface.at(column, row), score});
    return could_be();
  });
  return found;
}

/// Adds up, in whole numbers, every pose that could be the best of all.
void prove(const PoseLattice& lattice, const std::vector<std::vector<LatticePeak>>& contenders, double at_least,
           const RunContext& context, LatticeProof& proof) {
  struct Best {
    LatticePose at;
    std::int64_t score = 0;
    int added_up = 0;
  };
  std::vector<Best> best_of(contenders.size());
  parallel_for(contenders.size(), context.num_threads, [&](std::size_t angle, std::size_t) {
    std::optional<TurnedMap> moving;
    for (const LatticePeak& one : contenders[angle]) {
      if (static_cast<double>(one.score) + proof.rounding < at_least) {
        continue;  // taken while less was known of the others
      }
      if (!moving) {
        moving = lattice.turned(one.at.angle / lattice.turns());
      }
      const std::int64_t score = lattice.score(one.at, *moving);
      Best& best = best_of[angle];
      if (best.added_up == 0 || score > best.score || (score == best.score && one.at < best.at)) {
        best = {one.at, score, best.added_up};
      }
      ++best.added_up;
    }
  });
  for (const Best& one : best_of) {
    if (one.score > proof.best_score) {
      proof.best = one.at;
      proof.best_score = one.score;
    }
    proof.added_up += one.added_up;
  }
}

std::string text(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

/// What has been shown, in one sentence.
std::string remark_on(const PoseLattice& lattice, const LatticeProof& proof, double beside_m, double beside_deg,
                      std::optional<double> next) {
  return "the lattice of " + std::to_string(lattice.angles()) + " angles, " +
         text("%.2f deg apart, and cells of ", degrees(lattice.angle_step_rad())) +
         text("%.2f m holds ", lattice.resolution_m()) + text("%.1f million poses", proof.poses * 1e-6) +
         "; none scores above " + text("%.2f", PoseLattice::fitness(static_cast<double>(proof.best_score))) +
         (next ? "; of its other peaks, " + text("%.1f m or ", beside_m) +
                     text("%.0f deg away, none scores above ", beside_deg) + text("%.2f", *next)
               : "") +
         " (by Fourier transforms, whose rounding is below " + text("%.3f", PoseLattice::fitness(proof.rounding)) +
         "; what they cannot tell apart is added up in whole numbers)";
}

/// The highest score of any angle at each translation, and of any translation at each angle.
class Panorama {
 public:
  Panorama(const PoseLattice& lattice, bool wanted)
      : wanted_(wanted),
        width_(lattice.fixed_level().width + 2 * lattice.reach()),
        height_(lattice.fixed_level().height + 2 * lattice.reach()) {
    if (wanted_) {
      of_angle_.resize(static_cast<std::size_t>(lattice.angles()));
    }
  }

  /// Thread safe for different angles.
  void add(const ScoreSurface& surface) {
    if (!wanted_) {
      return;
    }
    std::vector<float>& plane = of_angle_[static_cast<std::size_t>(surface.angle)];
    plane.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int row = 0; row < height_; ++row) {
      for (int column = 0; column < width_; ++column) {
        const int from_column = (column - surface.reach + surface.size) % surface.size;
        const int from_row = (row - surface.reach + surface.size) % surface.size;
        plane[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)] =
            surface.score[surface.offset(from_column, from_row)];
      }
    }
  }

  /// @param moving  "source", or "target" where that is the one that was turned
  void show(const PoseLattice& lattice, const LatticeProof& proof, const std::vector<ScoredPose>& best,
            const std::string& moving, TraceSink& trace) const {
    const MapLevel& level = lattice.fixed_level();
    const double r = level.resolution_m;
    SurfaceView surface{.width = width_,
                        .height = height_,
                        .values = {},
                        .x_low = level.lower_left.x_m - lattice.reach() * r,
                        .x_high = level.lower_left.x_m + (width_ - lattice.reach()) * r,
                        .y_low = level.lower_left.y_m - lattice.reach() * r,
                        .y_high = level.lower_left.y_m + (height_ - lattice.reach()) * r,
                        .x_label = "x of the " + moving + "'s centre [m]",
                        .y_label = "y of the " + moving + "'s centre [m]",
                        .value_label = "fitness [points]",
                        .marks = {}};
    surface.values.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1e30F);
    Curve by_angle{.label = "best translation", .x = {}, .y = {}};
    for (int angle = 0; angle < lattice.angles(); ++angle) {
      const std::vector<float>& plane = of_angle_[static_cast<std::size_t>(angle)];
      if (plane.empty()) {
        continue;  // stopped before its turn
      }
      for (std::size_t i = 0; i < plane.size(); ++i) {
        const auto fitness = static_cast<float>(PoseLattice::fitness(static_cast<double>(plane[i])));
        surface.values[i] = std::max(surface.values[i], fitness);
      }
      by_angle.x.push_back(degrees(lattice.angle_rad(angle)));
      by_angle.y.push_back(PoseLattice::fitness(static_cast<double>(*std::max_element(plane.begin(), plane.end()))));
    }
    sort_by_x(by_angle);
    SurfaceView at_best = surface;
    const std::vector<float>& best_plane = of_angle_[static_cast<std::size_t>(proof.best.angle)];
    for (std::size_t i = 0; i < best_plane.size(); ++i) {
      at_best.values[i] = static_cast<float>(PoseLattice::fitness(static_cast<double>(best_plane[i])));
    }
    at_best.marks = {lattice.pose(proof.best).translation()};
    CurvesView curves{.curves = {by_angle},
                      .x_label = "angle of the " + moving + " [deg]",
                      .y_label = "fitness [points]",
                      .marks = {degrees(lattice.angle_rad(proof.best.angle))}};
    for (const ScoredPose& one : best) {
      surface.marks.push_back(one.pose.translation());
    }
    trace.on_view({"best_angle", "Fitness of every translation at the best angle", at_best});
    trace.on_view({"any_angle", "Fitness of every translation at its own best angle", surface});
    trace.on_view({"angles", "Fitness of the best translation at every angle", curves});
  }

 private:
  static void sort_by_x(Curve& curve) {
    std::map<double, double> sorted;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      sorted[curve.x[i]] = curve.y[i];
    }
    curve.x.clear();
    curve.y.clear();
    for (const auto& [x, y] : sorted) {
      curve.x.push_back(x);
      curve.y.push_back(y);
    }
  }

  bool wanted_;
  int width_;
  int height_;
  std::vector<std::vector<float>> of_angle_;
};

/// Where the best poses put the source's centre; the best of them drawn.
View places_view(const std::vector<ScoredPose>& best) {
  Shape centres{.kind = Shape::Kind::kPoints, .label = "source's centre in the best distinct poses", .points = {}};
  for (const ScoredPose& one : best) {
    centres.points.push_back(one.pose.translation());
  }
  return {"poses", "The best distinct poses; the best one drawn",
          MapView{.map = MapView::Map::kBoth, .local_target_from_source = best.front().pose, .shapes = {centres}}};
}

LatticeProof search(const PoseLattice& lattice, int peaks_per_angle, const RunContext& context, Panorama& panorama) {
  const auto angles = static_cast<std::size_t>(lattice.angles());
  std::vector<std::vector<LatticePeak>> contenders(angles);
  AtLeast at_least;
  std::vector<std::vector<LatticePeak>> peaks_of(angles);
  const LatticeScores scores = score_lattice(lattice, context, [&](const ScoreSurface& surface, std::size_t) {
    const auto angle = static_cast<std::size_t>(surface.angle);
    contenders[angle] = contenders_of(surface, lattice, at_least);
    peaks_of[angle] = surface_peaks(surface, peaks_per_angle, [&](const LatticePose& at) { return lattice.holds(at); });
    panorama.add(surface);
  });
  LatticeProof proof;
  proof.poses = scores.poses;
  proof.rounding = scores.rounding;
  proof.stopped = scores.stopped;
  for (std::vector<LatticePeak>& peaks : peaks_of) {
    if (peaks.size() == static_cast<std::size_t>(peaks_per_angle)) {
      const auto lowest = std::min_element(
          peaks.begin(), peaks.end(), [](const LatticePeak& a, const LatticePeak& b) { return a.score < b.score; });
      proof.left_out_below = std::max(proof.left_out_below, static_cast<double>(lowest->score) + scores.rounding);
    }
    std::sort(peaks.begin(), peaks.end(), [](const LatticePeak& a, const LatticePeak& b) { return a.at < b.at; });
    proof.peaks.insert(proof.peaks.end(), peaks.begin(), peaks.end());
  }
  prove(lattice, contenders, at_least.score(), context, proof);
  return proof;
}

}  // namespace

LatticeProof search_lattice(const PoseLattice& lattice, int peaks_per_angle, const RunContext& context) {
  Panorama nothing(lattice, false);
  return search(lattice, peaks_per_angle, context, nothing);
}

void CorrelativeOptions::describe(OptionList& list) {
  list.add("angle_step_deg", angle_step_deg, 0.1, 30,
           {"deg", "Step of the lattice's angles at the most.",
            "Time grows with its inverse; above 3 deg long walls are missed."})
      .add("finest_level", finest_level, 0, 4,
           {"",
            "The lattice's cells are those of the map halved in resolution so many times: 2 is 0.2 m for cells of "
            "0.05 m.",
            "Each level finer takes four times as long."})
      .add("max_cells", max_cells, 64, 8192,
           {"cells", "Both maps side by side: where they are wider, the lattice takes coarser cells.",
            "Raise it for large maps whose walls are all alike; time grows with its square."})
      .add("both_ways", both_ways,
           {"", "Read the target's walls in the source as well.", "One way, a large map swallows a small one."})
      .add("climb", climb, {"", "Let the best poses climb on between the lattice's points.", ""})
      .add("candidates", candidates, 1, 1000,
           {"poses", "Distinct poses proposed.", "More give the Evaluator more to choose from, and cost time."})
      .add("distinct_m", distinct_m, 0.01, 100,
           {"m", "Poses nearer than this, and than distinct_deg, count as one.", ""})
      .add("distinct_deg", distinct_deg, 0.1, 180, {"deg", "See distinct_m.", ""});
  fit.describe(list);
}

CorrelativeMerger::CorrelativeMerger(CorrelativeOptions options) : options_(options) {
  require_valid(options_, "correlative");
}

MergerTraits CorrelativeMerger::traits() const {
  return {.stochastic = false, .uses_prior = true, .needs_prior = false, .anytime = true, .warm_start = false};
}

Proposal CorrelativeMerger::propose(const AlignRequest& request, const RunContext& context) const {
  const CorrelativeOptions& o = options_;
  const std::optional<PoseWindow> window = window_of(request);
  // The smaller map is the one to turn: the transforms are then smaller. A window lies in the target's frame, and one
  // way is the source's.
  const bool swap = !window && o.both_ways && request.source.radius_m() > request.target.radius_m();
  const PreparedMap& fixed = swap ? request.source : request.target;
  const PreparedMap& moving = swap ? request.target : request.source;
  const PoseLattice lattice(fixed, moving, window,
                            {.angle_step_rad = radians(o.angle_step_deg),
                             .finest_level = o.finest_level,
                             .max_cells = o.max_cells,
                             .both_ways = o.both_ways,
                             .fit = o.fit});
  announce(context, "propose/lattice");
  Panorama panorama(lattice, wants_views(context));
  const LatticeProof proof = search(lattice, kPeaksPerAngle, context, panorama);

  Proposal proposal;
  proposal.stopped = proof.stopped;
  proposal.surveyed = !proof.stopped;
  std::vector<ScoredPose> poses;
  if (proof.best_score > 0) {
    poses.push_back({lattice.pose(proof.best), static_cast<double>(proof.best_score)});
  }
  for (const LatticePeak& peak : proof.peaks) {
    poses.push_back({lattice.pose(peak.at), static_cast<double>(peak.score)});
  }
  const PoseReach reach{o.distinct_m, radians(o.distinct_deg)};
  std::vector<ScoredPose> best = distinct_poses(std::move(poses), reach, static_cast<std::size_t>(o.candidates));
  const bool views = wants_views(context) && proof.best_score > 0;
  if (views) {
    panorama.show(lattice, proof, best, swap ? "target" : "source", *context.trace);
  }
  if (!proof.stopped && proof.best_score > 0) {
    const std::optional<double> next =
        best.size() > 1
            ? std::optional(PoseLattice::fitness(std::max(best[1].score + proof.rounding, proof.left_out_below)))
            : std::nullopt;
    proposal.remarks.push_back(remark_on(lattice, proof, o.distinct_m, o.distinct_deg, next));
  }
  for (ScoredPose& one : best) {
    one.pose = swap ? inverse(one.pose) : one.pose;
    one.score = PoseLattice::fitness(one.score);
  }
  if (o.climb && !best.empty()) {
    announce(context, "propose/climb");
    const WallFit fitness(request.target, request.source, kClimbLevel, o.fit, kClimbPoints);
    const PoseReach first{lattice.resolution_m() / 2, lattice.angle_step_rad() / 2};
    const PoseReach last{0.02, radians(0.1)};
    parallel_for(best.size(), context.num_threads,
                 [&](std::size_t i, std::size_t) { best[i] = climb(fitness, best[i].pose, first, last, window); });
    best = distinct_poses(std::move(best), reach, best.size());
  }
  if (views) {
    context.trace->on_view(places_view(best));
  }
  proposal.candidates = candidates_of(best, request);
  return proposal;
}

}  // namespace gridmerge
