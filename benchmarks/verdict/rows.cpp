#include "verdict/rows.hpp"

#include <mutex>
#include <sstream>

#include "gridmerge/align/scored_pose.hpp"
#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/csv_table.hpp"
#include "verdict/derived.hpp"

namespace gridmerge::verdict_study {
namespace {

/// Where walls lie best near a pose that trajectories tell: bent maps have no exact one.
Pose2 best_fit_near(const PreparedMap& target, const PreparedMap& source, const Pose2& truth) {
  constexpr int kLevel = 1;
  constexpr std::size_t kPoints = 4000;
  const WallFit fit(target, source, kLevel, {}, kPoints);
  const ScoredPose best = climb(fit, to_local(truth, target, source), {0.4, radians(2)}, {0.025, radians(0.1)}, {});
  const Pose2 pose = refine(target, source, from_local(best.pose, target, source), {}).pose;
  const PoseDifference moved = difference_at(source.centre_in_map(), pose, truth);
  return moved.distance_m < 1 && moved.angle_rad < radians(4) ? pose : truth;
}

bool within(const PoseDifference& error, const KnownPose& known) {
  return error.distance_m <= known.tolerance_m && error.angle_rad <= known.tolerance_rad;
}

Row row_of(const PairPlan& plan, const StudyPair& pair, const Merger& method, const PipelineOptions& options) {
  const double resolution_m = common_resolution_m(pair.target, pair.source, options.prepare);
  const PreparedMap target(pair.target, resolution_m, options.prepare);
  const PreparedMap source(pair.source, resolution_m, options.prepare);
  const Alignment alignment = align_prepared({.target = target, .source = source, .prior = {}}, method, options, {});
  Row row = {.kind = plan.kind,
             .set = plan.set,
             .places = plan.places,
             .a = plan.target_name,
             .b = plan.source_name,
             .truth = pair.truth,
             .overlap = pair.overlap,
             .outcome = to_string(alignment.outcome),
             .confidence = alignment.confidence,
             .vetoed = alignment.verdict.vetoed,
             .error = {},
             .seconds = alignment.seconds.align,
             .judge_s = alignment.seconds.judge,
             .figures = alignment.verdict.figures,
             .rivals = alignment.verdict.rivals};
  if (!alignment.hypotheses.empty()) {
    const Hypothesis& best = alignment.hypotheses.front();
    const Pose2& pose = best.target_from_source.pose;
    row.evidence_m = best.figures.evidence_m;
    row.conflict_share = best.figures.conflict_share;
    if (pair.pose) {
      const Point2 centre = known_cells(pair.source).centre;
      row.error = difference_at(centre, pose, pair.pose->target_from_source);
      row.right = within(*row.error, *pair.pose);
      if (!row.right && plan.target_yaml.empty()) {
        const Pose2 near = best_fit_near(target, source, pair.pose->target_from_source);
        row.right = within(difference_at(centre, pose, near), *pair.pose);
      }
      row.right = row.right && pair.truth == "same";
    }
  }
  return row;
}

constexpr const char* kColumns =
    "kind,set,places,a,b,truth,overlap,right,outcome,confidence,vetoed,error_m,error_deg,seconds,judge_s,evidence_m,"
    "conflict_share";

/// Rivals as words, their figures parted by colons.
std::string in_words(const std::vector<RivalFigures>& rivals) {
  std::string text;
  for (const RivalFigures& rival : rivals) {
    text += text.empty() ? "" : " ";
    for (const RivalTerm& term : rival_terms()) {
      text += (&term == rival_terms().data() ? "" : ":") + exact(rival.*term.figure);
    }
  }
  return text;
}

/// @throws InputError naming file, line and word
std::vector<RivalFigures> rivals_in(const CsvRow& line) {
  std::vector<RivalFigures> rivals;
  std::istringstream words(line.text("rivals"));
  for (std::string word; words >> word;) {
    std::istringstream numbers(word);
    RivalFigures rival;
    for (const RivalTerm& term : rival_terms()) {
      if (&term != rival_terms().data() && numbers.get() != ':') {
        numbers.setstate(std::ios::failbit);
      }
      numbers >> rival.*term.figure;
    }
    if (!numbers || numbers.peek() != std::istringstream::traits_type::eof()) {
      throw InputError(line.where() + ": rivals", "wanted are " + std::to_string(rival_terms().size()) +
                                                      " numbers a rival, parted by colons, not '" + word + "'");
    }
    rivals.push_back(rival);
  }
  return rivals;
}

}  // namespace

std::vector<Row> make_rows(const std::vector<PairPlan>& plans, const Merger& method, const PipelineOptions& options,
                           int threads, const Watcher& watcher) {
  std::vector<std::optional<Row>> made(plans.size());
  std::mutex mutex;
  std::size_t done = 0;
  parallel_for(plans.size(), threads, [&](std::size_t i, std::size_t) {
    if (const std::optional<StudyPair> pair = build_pair(plans[i])) {
      made[i] = row_of(plans[i], *pair, method, options);
    }
    const std::scoped_lock lock(mutex);
    ++done;
    if (watcher) {
      watcher(done, plans.size());
    }
  });
  std::vector<Row> rows;
  for (std::optional<Row>& row : made) {
    if (row) {
      rows.push_back(*std::move(row));
    }
  }
  return rows;
}

std::string to_csv(const std::vector<Row>& rows) {
  std::ostringstream text;
  text << kColumns;
  for (const ConfidenceTerm& term : confidence_terms()) {
    text << ',' << term.name;
  }
  text << ",rivals\n";
  for (const Row& row : rows) {
    text << row.kind << ',' << row.set << ',' << row.places << ',' << row.a << ',' << row.b << ',' << row.truth << ','
         << exact(row.overlap) << ',' << (row.right ? 1 : 0) << ',' << row.outcome << ',' << exact(row.confidence)
         << ',' << (row.vetoed ? 1 : 0) << ',' << (row.error ? exact(row.error->distance_m) : "") << ','
         << (row.error ? exact(degrees(row.error->angle_rad)) : "");
    for (const double number : {row.seconds, row.judge_s, row.evidence_m, row.conflict_share}) {
      text << ',' << exact(number);
    }
    for (const ConfidenceTerm& term : confidence_terms()) {
      text << ',' << exact(row.figures.*term.figure);
    }
    text << ',' << in_words(row.rivals) << '\n';
  }
  return text.str();
}

std::vector<Row> read_rows(const std::filesystem::path& csv) {
  std::vector<Row> rows;
  for (const CsvRow& line : read_csv(csv)) {
    Row row = {.kind = line.text("kind"),
               .set = line.text("set"),
               .places = line.text("places"),
               .a = line.text("a"),
               .b = line.text("b"),
               .truth = line.text("truth"),
               .overlap = line.number("overlap"),
               .right = line.number("right") != 0,
               .outcome = line.text("outcome"),
               .confidence = line.number("confidence"),
               .vetoed = line.number("vetoed") != 0,
               .error = {},
               .seconds = line.number("seconds"),
               .judge_s = line.number("judge_s"),
               .evidence_m = line.number("evidence_m"),
               .conflict_share = line.number("conflict_share"),
               .figures = {},
               .rivals = rivals_in(line)};
    if (!line.text("error_m").empty()) {
      row.error = {line.number("error_m"), radians(line.number("error_deg"))};
    }
    for (const ConfidenceTerm& term : confidence_terms()) {
      row.figures.*term.figure = line.number(term.name);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace gridmerge::verdict_study
