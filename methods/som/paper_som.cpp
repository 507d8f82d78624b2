#include "methods/som/paper_som.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/parallel.hpp"
#include "methods/som/orientation.hpp"
#include "methods/som/translation.hpp"
#include "methods/som/views.hpp"

namespace gridmerge {
namespace {

using som::ClusterMatch;
using som::ClusterMatcher;
using som::Rotation;

/// How near two results are that count as one.
constexpr PoseReach kDistinct{0.3, radians(2)};
/// The level on which the acceptance index is counted.
constexpr int kAcceptanceLevel = 1;

/// A group of walls that lie close together.
struct Segment {
  std::vector<std::uint32_t> samples;
  std::vector<Point2f> points;
  float wall_m = 0;
};

/// The segmentation: walls that share a square.
std::vector<Segment> segments_of(const std::vector<WallSample>& samples, double side_m) {
  std::map<std::pair<int, int>, Segment> by_square;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto cell = [&](float v) { return static_cast<int>(std::floor(static_cast<double>(v) / side_m)); };
    Segment& segment = by_square[{cell(samples[i].at.y_m), cell(samples[i].at.x_m)}];
    segment.samples.push_back(static_cast<std::uint32_t>(i));
    segment.points.push_back(samples[i].at);
    segment.wall_m += samples[i].weight;
  }
  std::vector<Segment> segments;
  for (auto& entry : by_square) {
    segments.push_back(std::move(entry.second));
  }
  return segments;
}

/// Map learning: a self-organising map for each segment; each neuron stands for the walls it wins.
ClusterPoints learnt(const PreparedMap& map, const PaperSomOptions& o, std::string_view name,
                     const RunContext& context) {
  const std::vector<WallSample> samples = wall_samples(map);
  const std::vector<Segment> segments = segments_of(samples, o.segment_m);
  std::vector<std::uint32_t> owner(samples.size(), 0);
  std::vector<std::uint32_t> first{0};
  for (const Segment& one : segments) {
    const auto neurons = std::max(1L, std::lround(static_cast<double>(one.wall_m) / o.wall_per_neuron_m));
    first.push_back(first.back() + static_cast<std::uint32_t>(neurons));
  }
  parallel_for(segments.size(), context.num_threads, [&](std::size_t s, std::size_t) {
    som::KohonenOptions learning = o.learning;
    if (context.stop.stop_requested()) {
      learning.epochs = 0;
    }
    RandomStream random(context.seed, name, s);
    const std::vector<Point2f> chain =
        som::trained_chain(segments[s].points, first[s + 1] - first[s], learning, random);
    for (const std::uint32_t i : segments[s].samples) {
      owner[i] = first[s] + static_cast<std::uint32_t>(som::best_matching_unit(chain, samples[i].at));
    }
  });
  return summarised(samples, owner, first.back());
}

/// Eq. 2.14: agreement over agreement and disagreement of the cells that both maps know.
double acceptance_index(const PreparedMap& target, const PreparedMap& source, const Pose2& pose) {
  const MapLevel& to = target.level(kAcceptanceLevel);
  const MapLevel& from = source.level(kAcceptanceLevel);
  double agree = 0;
  double disagree = 0;
  for (int row = 0; row < from.height; ++row) {
    for (int column = 0; column < from.width; ++column) {
      const CellState state = from.state[from.offset(column, row)];
      if (state == CellState::kUnseen) {
        continue;
      }
      const Point2 at =
          pose * (from.lower_left + Point2{(column + 0.5) * from.resolution_m, (row + 0.5) * from.resolution_m});
      const Point2 cell = (1 / to.resolution_m) * (at - to.lower_left);
      if (cell.x_m < 0 || cell.y_m < 0 || cell.x_m >= to.width || cell.y_m >= to.height) {
        continue;
      }
      const CellState other = to.state[to.offset(static_cast<int>(cell.x_m), static_cast<int>(cell.y_m))];
      if (other != CellState::kUnseen) {
        (other == state ? agree : disagree) += 1;
      }
    }
  }
  return agree + disagree > 0 ? agree / (agree + disagree) : 0;
}

/// A translation under trial.
struct Trial {
  Pose2 pose;
  double j_m = 0;  ///< Eq. 2.13 for a cluster in the mean; one without a partner counts the whole reach
};

class Search {
 public:
  Search(const PaperSomOptions& options, const AlignRequest& request, const RunContext& context)
      : o_(options),
        request_(request),
        context_(context),
        window_(window_of(request)),
        target_(learnt(request.target, options, "som/target", context).points),
        source_(learnt(request.source, options, "som/source", context).points),
        matcher_(target_, options.match_reach_m, radians(options.facing_deg), 1) {}

  /// Relative orientation: normals' histograms, tuned by the Radon transform.
  void turn() {
    spectrum_ = som::rotation_spectrum(target_, source_, o_.blur_deg, 2 * request_.target.resolution_m());
    turns_ = som::rotations(
        spectrum_, {.tuning_rad = radians(o_.tuning_deg), .at_most = static_cast<std::size_t>(o_.turns)}, window_);
  }

  /// Relative translation: every trial puts one cluster on another whose normal is equal.
  void try_matches() {
    std::vector<std::vector<Trial>> of_turn(turns_.size());
    parallel_for(turns_.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      RandomStream random(context_.seed, "som/trials", i);
      of_turn[i] = trials_at(turns_[i].angle_rad, random);
    });
    for (const std::vector<Trial>& some : of_turn) {
      trials_.insert(trials_.end(), some.begin(), some.end());
    }
    keep_best(static_cast<std::size_t>(o_.kept));
  }

  /// Iterative closest points, the turn held.
  /// @return how many steps there were
  int converge() {
    const int steps = trials_.empty() ? 0 : std::min(o_.icp_steps, context_.stop.iteration_budget());
    int done = 0;
    for (; done < steps && !context_.stop.stop_requested(); ++done) {
      parallel_for(trials_.size(), context_.num_threads, [&](std::size_t i, std::size_t) { pull(trials_[i]); });
      keep_best(trials_.size());
      record(done, steps);
    }
    return done;
  }

  /// What is left, verified as a whole.
  [[nodiscard]] std::vector<ScoredPose> verified() const {
    std::vector<ScoredPose> poses;
    for (const Trial& one : trials_) {
      poses.push_back({one.pose, -one.j_m});
    }
    poses = distinct_poses(std::move(poses), kDistinct, poses.size());
    parallel_for(poses.size(), context_.num_threads, [&](std::size_t i, std::size_t) {
      poses[i].score = acceptance_index(request_.target, request_.source, poses[i].pose);
    });
    return distinct_poses(std::move(poses), {0, 0}, poses.size());
  }

  void show(const std::vector<ScoredPose>& poses) const {
    if (context_.trace == nullptr || !context_.trace->wants_views()) {
      return;
    }
    context_.trace->on_view(som::neurons_view(MapView::Map::kTarget, target_));
    context_.trace->on_view(som::neurons_view(MapView::Map::kSource, source_));
    context_.trace->on_view(som::normals_view(target_, source_, o_.blur_deg));
    context_.trace->on_view(som::turns_view(spectrum_, turns_));
    if (!poses.empty()) {
      context_.trace->on_view(
          som::matches_view(target_, source_, matcher_(source_, poses.front().pose), poses.front().pose));
    }
  }

 private:
  [[nodiscard]] Trial judged(const Pose2& pose) const {
    const ClusterMatch match = matcher_(source_, pose);
    const double without = static_cast<double>(source_.size() - match.pairs.size());
    return {pose, (match.distance_sum_m + without * o_.match_reach_m) / static_cast<double>(source_.size())};
  }

  [[nodiscard]] std::vector<Trial> trials_at(double angle_rad, RandomStream& random) const {
    const Pose2 turn{0, 0, angle_rad};
    const auto direction = [](Point2f v) { return Point2{static_cast<double>(v.x_m), static_cast<double>(v.y_m)}; };
    const double least_cosine = std::cos(radians(o_.facing_deg));
    std::vector<Pose2> poses;
    for (const ClusterPoint& other : source_) {
      const Point2 normal = turn * direction(other.normal);
      const Point2 at = turn * direction(other.at);
      for (const ClusterPoint& one : target_) {
        const Point2 n = direction(one.normal);
        const Point2 to = direction(one.at) - at;
        const Pose2 pose{to.x_m, to.y_m, angle_rad};
        if (n.x_m * normal.x_m + n.y_m * normal.y_m >= least_cosine && inside(pose, window_)) {
          poses.push_back(pose);
        }
      }
    }
    std::vector<Trial> trials;
    for (int k = 0; k < o_.trials && !poses.empty() && !(k % 16 == 15 && context_.stop.stop_requested()); ++k) {
      trials.push_back(judged(poses[random.below(static_cast<std::uint32_t>(poses.size()))]));
    }
    return trials;
  }

  void pull(Trial& trial) const {
    const ClusterMatch match = matcher_(source_, trial.pose);
    if (match.pairs.empty()) {
      return;
    }
    Point2 sum;
    for (const auto& [k, i] : match.pairs) {
      const Point2 at =
          trial.pose * Point2{static_cast<double>(source_[i].at.x_m), static_cast<double>(source_[i].at.y_m)};
      sum = sum + Point2{static_cast<double>(target_[k].at.x_m), static_cast<double>(target_[k].at.y_m)} - at;
    }
    const Point2 move = (1 / static_cast<double>(match.pairs.size())) * sum;
    const Trial moved = judged({trial.pose.x_m + move.x_m, trial.pose.y_m + move.y_m, trial.pose.theta_rad});
    if (moved.j_m < trial.j_m && inside(moved.pose, window_)) {
      trial = moved;
    }
  }

  void keep_best(std::size_t count) {
    std::stable_sort(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) { return a.j_m < b.j_m; });
    trials_.resize(std::min(trials_.size(), count));
  }

  void record(int step, int steps) const {
    if (context_.trace == nullptr) {
      return;
    }
    IterationRecord record{
        .stage = "propose/converge",
        .iteration = step,
        .iterations = steps,
        .best_score = -trials_.front().j_m,
        .mean_score = 0,
        .best_target_from_source = from_local(trials_.front().pose, request_.target, request_.source),
        .population = {}};
    for (const Trial& one : trials_) {
      record.mean_score -= one.j_m / static_cast<double>(trials_.size());
      record.population.push_back(from_local(one.pose, request_.target, request_.source));
    }
    context_.trace->on_iteration(record);
  }

  const PaperSomOptions& o_;
  const AlignRequest& request_;
  const RunContext& context_;
  std::optional<PoseWindow> window_;
  std::vector<ClusterPoint> target_;
  std::vector<ClusterPoint> source_;
  ClusterMatcher matcher_;
  som::RotationSpectrum spectrum_;
  std::vector<Rotation> turns_;
  std::vector<Trial> trials_;  ///< best first
};

}  // namespace

void PaperSomOptions::describe(OptionList& list) {
  list.add("segment_m", segment_m, 0.1, 1000,
           {"m", "Side of the squares that the walls are divided by; each is learnt by itself.",
            "Larger takes longer: every wall is held against every neuron of its square."})
      .add("wall_per_neuron_m", wall_per_neuron_m, 0.05, 100,
           {"m", "Metres of wall for each neuron.", "Less is more exact; trials take longer."})
      .add("epochs", learning.epochs, 1, 10000, {"", "How often each wall is presented, in the mean.", ""})
      .add("first_rate", learning.first_rate, 0.001, 1, {"", "Learning rate at first; it falls geometrically.", ""})
      .add("last_rate", learning.last_rate, 0.0001, 1, {"", "Learning rate at last.", ""})
      .add("first_radius", learning.first_radius, 0.01, 1000,
           {"neurons", "Radius of the neighbourhood along the chain at first; it falls geometrically.", ""})
      .add("last_radius", learning.last_radius, 0.01, 1000, {"neurons", "Radius of the neighbourhood at last.", ""})
      .add("blur_deg", blur_deg, 0.1, 30, {"deg", "Standard deviation of the blur of the normals' histogram.", ""})
      .add("tuning_deg", tuning_deg, 0, 30,
           {"deg", "How far the Radon transform may move a turn that the histogram suggests.", "0 turns it off."})
      .add("turns", turns, 1, 360, {"turns", "How many turns are tried at the most.", ""})
      .add("facing_deg", facing_deg, 1, 90, {"deg", "Normals that differ by less are equal.", ""})
      .add("trials", trials, 1, 10000000,
           {"poses", "Pairs of clusters with equal normals that are put on each other, for each turn.",
            "Time grows with it."})
      .add("kept", kept, 1, 100000, {"poses", "How many of the trials are then led on.", ""})
      .add("icp_steps", icp_steps, 0, 10000, {"", "Steps of iterative closest points.", ""})
      .add("match_reach_m", match_reach_m, 0.02, 100, {"m", "Clusters farther apart than this do not match.", ""});
}

PaperSomMerger::PaperSomMerger(PaperSomOptions options) : options_(std::move(options)) {
  require_valid(options_, "som (paper)");
}

MergerTraits PaperSomMerger::traits() const { return {.stochastic = true, .uses_prior = true, .anytime = true}; }

Proposal PaperSomMerger::propose(const AlignRequest& request, const RunContext& context) const {
  Proposal proposal;
  announce(context, "propose/learn");
  Search search(options_, request, context);
  announce(context, "propose/turn");
  search.turn();
  announce(context, "propose/match");
  search.try_matches();
  announce(context, "propose/converge");
  proposal.iterations = search.converge();
  const std::vector<ScoredPose> poses = search.verified();
  proposal.stopped = context.stop.stop_requested();
  proposal.candidates = candidates_of(poses, request);
  search.show(poses);
  return proposal;
}

}  // namespace gridmerge
