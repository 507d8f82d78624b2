#include "study_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "gridmerge/base/error.hpp"
#include "gridmerge/judge/evaluator.hpp"
#include "study/journal.hpp"
#include "study/row_fields.hpp"
#include "study/rows_csv.hpp"
#include "study/shards.hpp"
#include "study_folder.hpp"

namespace gridmerge::study {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Study study_of(const std::string& more = "") {
  return parse_study(more + "methods: som\ndata: [{scenes: {kind: flat, seed: 1..4}}]\n", "s.yaml", {});
}

template <typename Call>
std::string problem_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StudyJournal, GivesBackWhatItWasGivenAfterItWasClosed) {
  const std::filesystem::path file = fresh_folder() / "rows.sqlite";
  const Row full = row_of_everything(3);
  Row bare = row_of_everything(1);
  bare.error_m = std::numeric_limits<double>::quiet_NaN();
  bare.figures.clear();
  const std::vector<CurvePoint> curve = {{3, 0, 1.5, 0.25, 2, std::numeric_limits<double>::quiet_NaN()},
                                         {3, 1, 2.5, 0.5, 1, 3}};
  {
    Journal journal(file, record_of(study_of(), {}));
    journal.add(full, curve);
    journal.add(bare, {});
  }
  EXPECT_FALSE(std::filesystem::exists(file.string() + "-wal")) << "one file that can be copied";
  const JournalContent content = read_journal(file.parent_path());
  ASSERT_EQ(content.rows.size(), 2U);
  EXPECT_EQ(in_words(content.rows[0]), in_words(bare));
  EXPECT_EQ(in_words(content.rows[1]), in_words(full));
  ASSERT_EQ(content.curves.size(), 2U);
  EXPECT_EQ(content.curves[1].fitness, 2.5);
  EXPECT_TRUE(std::isnan(content.curves[0].error_deg));
  EXPECT_EQ(content.study.name, "s");
  EXPECT_EQ(content.study.text, study_of().text);
  EXPECT_EQ(content.study.runs, 4);
}

TEST(StudyJournal, GoesOnWhereItEnded) {
  const std::filesystem::path file = fresh_folder() / "rows.sqlite";
  { Journal(file, record_of(study_of(), {})).add(row_of_everything(2), {}); }
  Journal journal(file, record_of(study_of("about: other words\n"), {}));
  EXPECT_THAT(journal.runs_done(), testing::UnorderedElementsAre(2));
  EXPECT_EQ(read_journal(file.parent_path()).rows.size(), 1U) << "may be read while it is open";
}

TEST(StudyJournal, RefusesAnotherStudyAndSaysWhatDiffers) {
  const std::filesystem::path file = fresh_folder() / "rows.sqlite";
  { const Journal journal(file, record_of(study_of(), {})); }
  EXPECT_THAT(problem_of([&] { Journal(file, record_of(study_of("seeds: 1..2\n"), {})); }),
              AllOf(HasSubstr("rows.sqlite: holds the rows of another study"), HasSubstr("remove this file"),
                    HasSubstr("seeds: '1' there, '1, 2' here"), testing::Not(HasSubstr("methods"))));
}

TEST(StudyJournal, HasOneWriterAtATime) {
  const std::filesystem::path file = fresh_folder() / "rows.sqlite";
  const Journal first(file, record_of(study_of(), {}));
  EXPECT_THAT(problem_of([&] { Journal(file, record_of(study_of(), {})); }),
              HasSubstr("another run of the study writes it just now (process "));
}

TEST(StudyJournal, RefusesWhatIsNoJournal) {
  const std::filesystem::path file = fresh_folder() / "rows.sqlite";
  EXPECT_THAT(problem_of([&] { (void)read_journal(file.parent_path()); }), HasSubstr("does not exist"));
  std::ofstream(file) << "not a database, but long enough to look like one: " << std::string(5000, '-');
  EXPECT_THAT(problem_of([&] { (void)read_journal(file.parent_path()); }), HasSubstr("not a database"));
  EXPECT_THAT(problem_of([&] { Journal(file, record_of(study_of(), {})); }), HasSubstr("not a database"));
}

TEST(StudyCsv, ReadsBackWhatItWrote) {
  Row odd = row_of_everything(5);
  odd.reason = "a \"quote\", a comma,\nand a line";
  odd.overlap = 0.1;  // no finite binary fraction
  odd.drift = std::numeric_limits<double>::quiet_NaN();
  Row bare;
  const std::string text = to_csv({odd, bare});
  EXPECT_THAT(text, testing::StartsWith("run,set,pair,"));
  EXPECT_THAT(text, HasSubstr(",0.1,"));
  const std::vector<Row> rows = parse_rows_csv(text, "rows.csv");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(in_words(rows[0]), in_words(odd));
  EXPECT_EQ(in_words(rows[1]), in_words(bare));
}

TEST(StudyCsv, NamesFileLineAndColumnOfAProblem) {
  const auto read = [](const std::string& text) { return problem_of([&] { (void)parse_rows_csv(text, "rows.csv"); }); };
  EXPECT_THAT(read("run,set\n1,\"a\nb\"\nx,c\n"), HasSubstr("rows.csv:4: run: 'x' is not a number"));
  EXPECT_THAT(read("run,set\n1\n"), HasSubstr("rows.csv:2: has 1 cells; the heading has 2"));
  EXPECT_THAT(read(""), HasSubstr("rows.csv: is empty"));
}

/// The shards of the study, each with a row for all of its runs.
void write_shards(const std::filesystem::path& folder, const Study& study, int shards) {
  for (int index = 1; index <= shards; ++index) {
    Journal journal(folder / journal_name({index, shards}), record_of(study, {index, shards}));
    for (const PlannedRun& run : order_of(study, {index, shards})) {
      journal.add(row_of_everything(run.run), {{run.run, 0, 1, 1, 1, 1}});
    }
  }
}

TEST(StudyShards, AreJoinedIntoOneJournalAndOneTable) {
  const std::filesystem::path folder = fresh_folder();
  write_shards(folder, study_of(), 3);
  merge_shards(folder);
  const JournalContent whole = read_journal(folder);
  ASSERT_EQ(whole.rows.size(), 4U);
  EXPECT_EQ(whole.curves.size(), 4U);
  EXPECT_EQ(whole.study.shard, Shard{});
  EXPECT_EQ(read_rows_csv(folder / "rows.csv").size(), 4U);
  EXPECT_EQ(Journal(folder / "rows.sqlite", record_of(study_of(), {})).runs_done().size(), 4U);
  merge_shards(folder);  // again: the same
  EXPECT_EQ(read_journal(folder).rows.size(), 4U);
}

TEST(StudyShards, ThatDoNotFitTogetherAreNamed) {
  const auto merge = [](const std::filesystem::path& folder) { return problem_of([&] { merge_shards(folder); }); };
  const std::filesystem::path folder = fresh_folder();
  EXPECT_THAT(merge(folder), HasSubstr("holds no shard"));
  write_shards(folder, study_of(), 3);
  std::filesystem::remove(folder / "rows-2-of-3.sqlite");
  EXPECT_THAT(merge(folder), HasSubstr("rows-2-of-3.sqlite: is missing; run shard 2 of 3"));
  { const Journal empty(folder / "rows-2-of-3.sqlite", record_of(study_of(), {2, 3})); }
  EXPECT_THAT(merge(folder), HasSubstr("rows-2-of-3.sqlite: 1 of 1 runs are left; run shard 2 of 3 once more"));
  std::filesystem::remove(folder / "rows-2-of-3.sqlite");
  { const Journal other(folder / "rows-2-of-3.sqlite", record_of(study_of("seeds: 9\n"), {2, 3})); }
  EXPECT_THAT(merge(folder), HasSubstr("rows-2-of-3.sqlite: is of another study"));
  write_shards(folder, study_of(), 2);
  EXPECT_THAT(merge(folder), HasSubstr("cut in 2 and of one cut in 3"));
  EXPECT_FALSE(std::filesystem::exists(folder / "rows.sqlite"));
}

}  // namespace
}  // namespace gridmerge::study
