#include "study/one_run.hpp"

#include <algorithm>
#include <chrono>
#include <limits>

#include "cli/serial_merge.hpp"
#include "cli/text.hpp"
#include "study/curve.hpp"
#include "study/machine.hpp"
#include "study/method_reader.hpp"
#include "study/window.hpp"

namespace gridmerge::study {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

const worlds::SceneOptions* scene_of(const PairChoice& choice) {
  if (const auto* scene = std::get_if<SceneMaps>(&choice.maps)) {
    return &scene->scene;
  }
  const auto* swarm = std::get_if<SwarmMaps>(&choice.maps);
  return swarm == nullptr ? nullptr : &swarm->scene;
}

std::string result_of(const std::string& truth, bool merged, bool right) {
  if (truth == "unknown") {
    return "unknown";
  }
  if (truth == "different") {
    return merged ? "false" : "refused";
  }
  return merged ? (right ? "right" : "wrong") : "missed";
}

bool within(const Row& row, const PoseDifference& error) {
  return error.distance_m <= row.tolerance_m && degrees(error.angle_rad) <= row.tolerance_deg;
}

void fill_seconds(const StepSeconds& seconds, Row& row) {
  row.prepare_s = seconds.prepare;
  row.choose_s = seconds.choose;
  row.propose_s = seconds.propose;
  row.refine_s = seconds.refine;
  row.judge_s = seconds.judge;
  row.align_s = seconds.align;
}

void fill_answer(const Alignment& alignment, const DrawnPair& pair, Row& row) {
  row.status = cli::status_of(alignment.outcome);
  row.confidence = alignment.confidence;
  row.reason = cli::reasons_of(alignment).front();
  row.iterations = alignment.iterations;
  for (const Attempt& attempt : alignment.attempts) {
    row.tried += (row.tried.empty() ? "" : " ") + attempt.method;
  }
  if (!alignment.hypotheses.empty()) {
    const Hypothesis& best = alignment.hypotheses.front();
    const Pose2& pose = best.target_from_source.pose;
    row.x_m = pose.x_m;
    row.y_m = pose.y_m;
    row.theta_rad = pose.theta_rad;
    row.figures = best.figures.named();
    if (pair.truth == "same") {
      const PoseDifference error = difference_at(pair.centre_in_map[1], pose, pair.first_from_map[1]);
      row.error_m = error.distance_m;
      row.error_deg = degrees(error.angle_rad);
      row.pose_right = within(row, error);
    }
  }
  const bool merged = alignment.outcome == Outcome::kMerged;
  row.result = result_of(row.truth, merged, row.pose_right);
  row.robots_right = row.result == "right" ? 2 : 0;
  row.robots_wrong = row.result == "wrong" || row.result == "false" ? 1 : 0;
}

/// The last that was tried with a map that had to be left out; none: it was only ever the one to start from.
const Alignment* last_try(const cli::SerialMerge& merge, std::size_t map) {
  const auto found = std::find_if(merge.attempts.rbegin(), merge.attempts.rend(),
                                  [&](const cli::MergeAttempt& attempt) { return attempt.source == map; });
  return found == merge.attempts.rend() ? nullptr : &found->alignment;
}

/// Where the maps were placed, in the frame of the first one that was.
void judge_places(const cli::SerialMerge& merge, const DrawnPair& pair, Row& row) {
  if (merge.merged.empty()) {
    return;
  }
  row.error_m = row.error_deg = 0;
  const Pose2 start_from_first = inverse(pair.first_from_map[merge.merged.front().map]);
  for (const cli::MergedMap& one : merge.merged) {
    const Pose2 truth = start_from_first * pair.first_from_map[one.map];
    const PoseDifference error = difference_at(pair.centre_in_map[one.map], one.merged_from_map.pose, truth);
    row.error_m = std::max(row.error_m, error.distance_m);
    row.error_deg = std::max(row.error_deg, degrees(error.angle_rad));
    ++(within(row, error) ? row.robots_right : row.robots_wrong);
  }
  row.pose_right = row.robots_wrong == 0;
}

StepSeconds sum_of_steps(const cli::SerialMerge& merge) {
  StepSeconds sum;
  for (const cli::MergeAttempt& attempt : merge.attempts) {
    sum.prepare += attempt.alignment.seconds.prepare;
    sum.propose += attempt.alignment.seconds.propose;
    sum.refine += attempt.alignment.seconds.refine;
    sum.judge += attempt.alignment.seconds.judge;
  }
  return sum;
}

void fill_answer(const cli::SerialMerge& merge, const DrawnPair& pair, Row& row) {
  const bool all_placed = merge.left_out.empty();
  row.status = "merged";
  row.confidence = all_placed ? 1 : 0;
  for (const cli::MergeAttempt& attempt : merge.attempts) {
    row.iterations += attempt.alignment.iterations;
    if (all_placed && attempt.alignment.outcome == Outcome::kMerged) {
      row.confidence = std::min(row.confidence, attempt.alignment.confidence);
    }
  }
  if (!all_placed) {
    const cli::LeftOutMap& left_out = merge.left_out.front();
    const Alignment* alignment = last_try(merge, left_out.map);
    row.status = cli::status_of(alignment == nullptr ? Outcome::kNoOverlap : alignment->outcome);
    row.confidence = alignment == nullptr ? 0 : alignment->confidence;
    row.reason = "map " + std::to_string(left_out.map + 1) + ": " + left_out.reason;
  } else {
    row.reason = "all " + std::to_string(row.robots) + " maps are merged";
  }
  judge_places(merge, pair, row);
  row.result = row.robots_wrong > 0 ? "wrong" : (all_placed ? "right" : "missed");
}

}  // namespace

Laboratory::Laboratory(const Study& study)
    : study_(study), version_(version()), commit_(commit()), compiler_(compiler()), cpu_(cpu()) {
  const MethodRegistry registry = methods_of(study.plugins);
  for (const MethodChoice& choice : study.methods) {
    configurations_.push_back(std::make_unique<const cli::Configuration>(registry, configuration_choice(choice)));
  }
}

RunResult Laboratory::perform(const PlannedRun& run, const DrawnPair& pair) const {
  RunResult result;
  result.row = asked(run, pair);
  if (study_.pairs[run.pair].is_swarm()) {
    merge_many(run, pair, result);
  } else {
    merge_two(run, pair, result);
  }
  result.row.date = utc_now();
  return result;
}

std::string Laboratory::name_of(const PlannedRun& run) const {
  const PairChoice& pair = study_.pairs[run.pair];
  const MethodChoice& method = study_.methods[run.method];
  std::string name = method.method + " " + method.profile;
  for (const std::string& setting : method.set) {
    name += " " + setting;
  }
  name += " on " + pair.set + "/" + pair.name;
  if (run.window != PlannedRun::kNoWindow) {
    name += ", window " + study_.windows[run.window].name;
  }
  return name + ", seed " + std::to_string(run.seed);
}

Row Laboratory::asked(const PlannedRun& run, const DrawnPair& pair) const {
  const PairChoice& choice = study_.pairs[run.pair];
  const MethodChoice& method = study_.methods[run.method];
  const worlds::SceneOptions* scene = scene_of(choice);
  Row row;
  row.run = run.run;
  row.set = choice.set;
  row.pair = choice.name;
  row.pair_spec = spec_of(choice);
  row.robots = static_cast<int>(pair.maps.size());
  row.truth = pair.truth;
  row.overlap = pair.overlap;
  row.drift = scene == nullptr ? kNotKnown : scene->drift_m;
  row.noise_m = scene == nullptr ? kNotKnown : scene->range_noise_m;
  row.window = run.window == PlannedRun::kNoWindow ? "none" : study_.windows[run.window].name;
  row.window_m = row.window_deg = kNotKnown;
  row.method = method.method;
  row.profile = method.profile;
  for (const std::string& setting : method.set) {
    row.options += (row.options.empty() ? "" : " ") + setting;
  }
  row.seed = run.seed;
  row.x_m = row.y_m = row.theta_rad = row.error_m = row.error_deg = kNotKnown;
  row.truth_x_m = row.truth_y_m = row.truth_theta_rad = kNotKnown;
  if (pair.truth == "same" && !choice.is_swarm()) {
    const Pose2& truth = pair.first_from_map[1];
    row.truth_x_m = truth.x_m;
    row.truth_y_m = truth.y_m;
    row.truth_theta_rad = truth.theta_rad;
  }
  row.tolerance_m = choice.tolerance_m;
  row.tolerance_deg = choice.tolerance_deg;
  row.target_walls = pair.walls.front();
  for (std::size_t map = 1; map < pair.walls.size(); ++map) {
    row.source_walls += pair.walls[map];
  }
  if (!choice.is_swarm()) {
    row.target = pair.features[0];
    row.source = pair.features[1];
  }
  row.prior_x_m = row.prior_y_m = row.prior_theta_rad = kNotKnown;
  row.yardstick_s = kNotKnown;
  row.version = version_;
  row.commit = commit_;
  row.compiler = compiler_;
  row.cpu = cpu_;
  row.threads = study_.threads;
  return row;
}

void Laboratory::merge_two(const PlannedRun& run, const DrawnPair& pair, RunResult& result) const {
  const cli::Configuration& configuration = *configurations_[run.method];
  const std::optional<PosePrior> prior = prior_of(study_.windows[run.window], study_.pairs[run.pair], pair, run.seed);
  if (prior) {
    result.row.window_m = *prior->radius_m;
    result.row.window_deg = degrees(*prior->angle_rad);
    result.row.prior_x_m = prior->target_from_source.x_m;
    result.row.prior_y_m = prior->target_from_source.y_m;
    result.row.prior_theta_rad = prior->target_from_source.theta_rad;
  }
  CurveRecorder recorder;
  const RunContext context{
      .seed = run.seed, .num_threads = study_.threads, .stop = {}, .trace = study_.curves ? &recorder : nullptr};
  const ProcessorShare processor;
  const Alignment alignment = align({.target = pair.maps[0], .source = pair.maps[1], .prior = prior},
                                    configuration.methods(), configuration.pipeline(), context);
  result.processor_share = study_.threads == 1 ? processor.share() : 1;
  fill_answer(alignment, pair, result.row);
  fill_seconds(alignment.seconds, result.row);
  if (study_.curves) {
    result.curve = recorder.curve(run.run, pair);
  }
}

void Laboratory::merge_many(const PlannedRun& run, const DrawnPair& pair, RunResult& result) const {
  const cli::Configuration& configuration = *configurations_[run.method];
  const RunContext context{.seed = run.seed, .num_threads = study_.threads, .stop = {}};
  const ProcessorShare processor;
  const auto start = std::chrono::steady_clock::now();
  const cli::SerialMerge merge = cli::merge_serially({.maps = pair.maps,
                                                      .prior = {},
                                                      .methods = configuration.methods(),
                                                      .options = configuration.pipeline(),
                                                      .fuse = configuration.fuse()},
                                                     context);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  result.processor_share = study_.threads == 1 ? processor.share() : 1;
  fill_answer(merge, pair, result.row);
  fill_seconds(sum_of_steps(merge), result.row);
  result.row.align_s = took.count();
}

}  // namespace gridmerge::study
