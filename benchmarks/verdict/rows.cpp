#include "verdict/rows.hpp"

#include <mutex>
#include <sstream>
#include <stdexcept>

#include "gridmerge/base/error.hpp"
#include "gridmerge/base/number_text.hpp"
#include "gridmerge/base/parallel.hpp"
#include "manifest/csv_table.hpp"
#include "verdict/derived.hpp"

namespace gridmerge::verdict_study {
namespace {

Row row_of(const PairPlan& plan, const StudyPair& pair, const Merger& method, const PipelineOptions& options) {
  const Alignment alignment = align({.target = pair.target, .source = pair.source, .prior = {}, .carried = nullptr},
                                    method, options, RunContext{});
  Row row = {.kind = plan.kind,
             .set = plan.set,
             .places = plan.places,
             .a = plan.target_name,
             .b = plan.source_name,
             .truth = pair.truth,
             .overlap = pair.overlap,
             .outcome = to_string(alignment.outcome),
             .confidence = alignment.confidence,
             .error = {},
             .lead = alignment.verdict.lead,
             .lead_m = alignment.verdict.lead_m,
             .deviations = alignment.verdict.deviations,
             .figures = Figures{}.named()};
  if (!alignment.hypotheses.empty()) {
    const Hypothesis& best = alignment.hypotheses.front();
    row.figures = best.figures.named();
    if (pair.pose) {
      row.error =
          difference_at(known_cells(pair.source).centre, best.target_from_source.pose, pair.pose->target_from_source);
      row.right = pair.truth == "same" && row.error->distance_m <= pair.pose->tolerance_m &&
                  row.error->angle_rad <= pair.pose->tolerance_rad;
    }
  }
  return row;
}

}  // namespace

double Row::figure(const std::string& name) const {
  for (const auto& [key, value] : figures) {
    if (key == name) {
      return value;
    }
  }
  throw std::out_of_range("no figure is called " + name);
}

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
  text << "kind,set,places,a,b,truth,overlap,right,outcome,confidence,error_m,error_deg,lead,lead_m,deviations";
  for (const auto& [name, value] : Figures{}.named()) {
    text << ',' << name;
  }
  text << '\n';
  for (const Row& row : rows) {
    text << row.kind << ',' << row.set << ',' << row.places << ',' << row.a << ',' << row.b << ',' << row.truth << ','
         << exact(row.overlap) << ',' << (row.right ? 1 : 0) << ',' << row.outcome << ',' << exact(row.confidence)
         << ',' << (row.error ? exact(row.error->distance_m) : "") << ','
         << (row.error ? exact(degrees(row.error->angle_rad)) : "");
    for (const double number : {row.lead, row.lead_m, row.deviations}) {
      text << ',' << exact(number);
    }
    for (const auto& [name, value] : row.figures) {
      text << ',' << exact(value);
    }
    text << '\n';
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
               .error = {},
               .lead = line.number("lead"),
               .lead_m = line.number("lead_m"),
               .deviations = line.number("deviations"),
               .figures = Figures{}.named()};
    if (!line.text("error_m").empty()) {
      row.error = {line.number("error_m"), radians(line.number("error_deg"))};
    }
    for (auto& [name, value] : row.figures) {
      value = line.number(name);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace gridmerge::verdict_study
