#pragma once
/// Rows as they are made, in an SQLite file: whatever happens to the process, a row is there whole or not at all.
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "study/file_lock.hpp"
#include "study/plan.hpp"
#include "study/row.hpp"
#include "study/sqlite.hpp"

namespace gridmerge::study {

/// What a journal says of the study that it is of.
struct StudyRecord {
  std::string name;
  std::string about;
  std::string text;       ///< the YAML
  StudyParts parts;       ///< what makes it this study and no other
  std::int64_t runs = 0;  ///< of the whole study, all shards together
  Shard shard;
  std::int64_t runs_of_shard = 0;
};

[[nodiscard]] StudyRecord record_of(const Study& study, const Shard& shard);

/// All that a journal holds.
struct JournalContent {
  StudyRecord study;
  std::vector<Row> rows;           ///< by run
  std::vector<CurvePoint> curves;  ///< by run and iteration
};

/// The one writer of a journal. For one thread at a time.
class Journal {
 public:
  /// Makes the file, or goes on with one of the same study and shard.
  /// @throws InputError naming the file, if it is being written by another process, is no journal, or is one of another
  /// study: then what differs, and what to do
  Journal(const std::filesystem::path& file, const StudyRecord& record);

  [[nodiscard]] std::unordered_set<std::int64_t> runs_done() const;
  [[nodiscard]] std::vector<Row> rows() const;  ///< by run
  /// One transaction: the row with its curve.
  void add(const Row& row, const std::vector<CurvePoint>& curve);

 private:
  FileLock lock_;
  Database database_;
  std::unique_ptr<Statement> insert_row_;
  std::unique_ptr<Statement> insert_point_;
};

/// "rows.sqlite", or "rows-2-of-4.sqlite" for a shard.
[[nodiscard]] std::string journal_name(const Shard& shard);

/// Reads folder/rows.sqlite, also while it is being written.
/// @throws InputError naming the file, if there is none or it is no journal
[[nodiscard]] JournalContent read_journal(const std::filesystem::path& folder);
[[nodiscard]] JournalContent read_journal_file(const std::filesystem::path& file);

/// Writes a whole journal at once, or nothing. One that is there is replaced.
/// @throws InputError naming the file, if it cannot be written, or another process writes it
void write_journal(const std::filesystem::path& file, const JournalContent& content);

}  // namespace gridmerge::study
