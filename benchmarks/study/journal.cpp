#include "study/journal.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <system_error>
#include <type_traits>

#include "gridmerge/base/error.hpp"
#include "gridmerge/judge/evaluator.hpp"
#include "study/row_fields.hpp"

namespace gridmerge::study {
namespace {

constexpr const char* kFormat = "2";

std::string quoted(const std::string& name) { return "\"" + name + "\""; }  // "set" is a word of SQL

template <typename Field>
const char* sql_type() {
  if constexpr (std::is_same_v<Field, std::string>) {
    return "TEXT";
  } else if constexpr (std::is_same_v<Field, double>) {
    return "REAL";
  } else {
    return "INTEGER";
  }
}

void create(Database& database, const StudyRecord& record) {
  std::string columns;
  Row row;
  for_each_field(row, [&]<typename Field>(const std::string& name, const Field&) {
    columns += (columns.empty() ? "" : ", ") + quoted(name) + " " + sql_type<Field>();
    columns += name == "run" ? " PRIMARY KEY" : "";
  });
  for (const auto& [name, value] : Figures{}.named()) {
    columns += ", " + quoted(name) + " REAL";
  }
  database.execute("CREATE TABLE rows (" + columns + ")");
  database.execute(
      "CREATE TABLE curves (run INTEGER, iteration INTEGER, fitness REAL, acceptance_index REAL, error_m REAL, "
      "error_deg REAL, PRIMARY KEY (run, iteration)) WITHOUT ROWID");
  database.execute("CREATE TABLE study (key TEXT PRIMARY KEY, value TEXT)");
  Statement insert = database.prepare("INSERT INTO study VALUES (?, ?)");
  const auto keep = [&](std::string_view key, std::string_view value) {
    insert.bind(1, key);
    insert.bind(2, value);
    insert.run();
  };
  keep("format", kFormat);
  keep("fingerprint", fingerprint_of(record.parts));
  keep("about", record.about);
  keep("text", record.text);
  keep("runs", std::to_string(record.runs));
  keep("runs of shard", std::to_string(record.runs_of_shard));
  keep("shard", std::to_string(record.shard.index) + "/" + std::to_string(record.shard.of));
  for (const auto& [key, value] : record.parts) {
    keep("part " + key, value);
  }
}

StudyRecord read_record(const Database& database) {
  if (!database.has_table("study") || !database.has_table("rows")) {
    throw InputError(database.file().string(), "is not the journal of a study");
  }
  StudyRecord record;
  std::string format;
  Statement select = database.prepare("SELECT key, value FROM study ORDER BY rowid");
  while (select.step()) {
    const std::string key = select.text(0);
    std::string value = select.text(1);
    if (key == "format") {
      format = value;
    } else if (key == "about") {
      record.about = value;
    } else if (key == "text") {
      record.text = value;
    } else if (key == "runs") {
      record.runs = std::stoll(value);
    } else if (key == "runs of shard") {
      record.runs_of_shard = std::stoll(value);
    } else if (key == "shard") {
      record.shard = {std::stoi(value), std::stoi(value.substr(value.find('/') + 1))};
    } else if (key.starts_with("part ")) {
      record.name = key == "part name" ? value : record.name;
      record.parts.emplace_back(key.substr(5), std::move(value));
    }
  }
  if (format != kFormat) {
    throw InputError(database.file().string(),
                     "is a journal of format '" + format + "'; this program knows format " + kFormat);
  }
  return record;
}

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 120;
  return "'" + (text.size() > kLongest ? text.substr(0, kLongest) + "..." : text) + "'";
}

void require_same_study(const Database& database, const StudyRecord& asked) {
  const StudyRecord there = read_record(database);
  std::string differs;
  for (std::size_t i = 0; i < std::max(there.parts.size(), asked.parts.size()); ++i) {
    const auto part = [&](const StudyParts& parts) {
      return i < parts.size() ? parts[i] : std::pair<std::string, std::string>{"", "nothing"};
    };
    const auto [key, old_value] = part(there.parts);
    const auto [new_key, new_value] = part(asked.parts);
    if (key != new_key || old_value != new_value) {
      differs += "\n  " + (new_key.empty() ? key : new_key) + ": " + shortened(old_value) + " there, " +
                 shortened(new_value) + " here";
    }
  }
  if (!(there.shard == asked.shard)) {
    differs += "\n  shard: " + std::to_string(there.shard.index) + "/" + std::to_string(there.shard.of) + " there";
  }
  if (!differs.empty()) {
    throw InputError(
        database.file().string(),
        "holds the rows of another study; write to another folder, or remove this file to begin anew" + differs);
  }
}

void open_or_create(Database& database, const StudyRecord& record) {
  Transaction transaction(database);  // whoever is killed in here leaves an empty database, which is made anew
  if (database.has_table("study")) {
    require_same_study(database, record);
  } else {
    if (database.prepare("SELECT 1 FROM sqlite_master").step()) {
      throw InputError(database.file().string(), "is not the journal of a study");
    }
    create(database, record);
  }
  transaction.commit();
}

Statement insert_into_rows(const Database& database) {
  std::string values;
  const int columns = database.prepare("SELECT * FROM rows").columns();
  for (int column = 0; column < columns; ++column) {
    values += column == 0 ? "?" : ", ?";
  }
  return database.prepare("INSERT INTO rows VALUES (" + values + ")");
}

void insert(Statement& statement, const Row& row) {
  int parameter = 0;
  for_each_field(row, [&]<typename Field>(const char*, const Field& field) {
    if constexpr (std::is_same_v<Field, std::string> || std::is_same_v<Field, double>) {
      statement.bind(++parameter, field);
    } else {
      statement.bind(++parameter, static_cast<std::int64_t>(field));
    }
  });
  for (const auto& [name, value] : row.figures) {
    statement.bind(++parameter, value);
  }
  statement.run();
}

void insert(Statement& statement, const CurvePoint& point) {
  statement.bind(1, point.run);
  statement.bind(2, std::int64_t{point.iteration});
  statement.bind(3, point.fitness);
  statement.bind(4, point.acceptance_index);
  statement.bind(5, point.error_m);
  statement.bind(6, point.error_deg);
  statement.run();
}

Statement insert_into_curves(const Database& database) {
  return database.prepare("INSERT INTO curves VALUES (?, ?, ?, ?, ?, ?)");
}

/// Which column of a table holds what.
class RowReader {
 public:
  explicit RowReader(Statement& select) : select_(select) {
    for (int column = 0; column < select.columns(); ++column) {
      column_of_[select.name(column)] = column;
      figures_.insert({column, select.name(column)});
    }
    Row row;
    for_each_field(row, [&](const char* name, const auto&) {
      if (const auto found = column_of_.find(name); found != column_of_.end()) {
        figures_.erase(found->second);
      }
    });
  }

  [[nodiscard]] Row row() const {
    Row row;
    for_each_field(row, [&]<typename Field>(const char* name, Field& field) {
      const auto found = column_of_.find(name);
      if (found == column_of_.end()) {
        return;
      }
      if constexpr (std::is_same_v<Field, std::string>) {
        field = select_.text(found->second);
      } else if constexpr (std::is_same_v<Field, double>) {
        field = select_.number(found->second);
      } else {
        field = static_cast<Field>(select_.integer(found->second));
      }
    });
    bool any = false;
    for (const auto& [column, name] : figures_) {
      any = any || !select_.is_null(column);
      row.figures.emplace_back(name, select_.number(column));
    }
    if (!any) {
      row.figures.clear();
    }
    return row;
  }

 private:
  Statement& select_;
  std::map<std::string, int> column_of_;
  std::map<int, std::string> figures_;
};

std::vector<Row> read_rows(const Database& database) {
  std::vector<Row> rows;
  Statement select = database.prepare("SELECT * FROM rows ORDER BY run");
  const RowReader reader(select);
  while (select.step()) {
    rows.push_back(reader.row());
  }
  return rows;
}

}  // namespace

StudyRecord record_of(const Study& study, const Shard& shard) {
  return {.name = study.name,
          .about = study.about,
          .text = study.text,
          .parts = parts_of(study),
          .runs = static_cast<std::int64_t>(plan_of(study).size()),
          .shard = shard,
          .runs_of_shard = static_cast<std::int64_t>(order_of(study, shard).size())};
}

Journal::Journal(const std::filesystem::path& file, const StudyRecord& record)
    : lock_(file), database_(file, Database::Mode::kWrite) {
  open_or_create(database_, record);
  insert_row_ = std::make_unique<Statement>(insert_into_rows(database_));
  insert_point_ = std::make_unique<Statement>(insert_into_curves(database_));
}

std::unordered_set<std::int64_t> Journal::runs_done() const {
  std::unordered_set<std::int64_t> runs;
  Statement select = database_.prepare("SELECT run FROM rows");
  while (select.step()) {
    runs.insert(select.integer(0));
  }
  return runs;
}

std::vector<Row> Journal::rows() const { return read_rows(database_); }

void Journal::add(const Row& row, const std::vector<CurvePoint>& curve) {
  Transaction transaction(database_);
  insert(*insert_row_, row);
  for (const CurvePoint& point : curve) {
    insert(*insert_point_, point);
  }
  transaction.commit();
}

std::string journal_name(const Shard& shard) {
  return shard.of == 1 ? "rows.sqlite"
                       : "rows-" + std::to_string(shard.index) + "-of-" + std::to_string(shard.of) + ".sqlite";
}

JournalContent read_journal(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / journal_name({});
  if (!std::filesystem::exists(file)) {
    throw InputError(file.string(), "does not exist: no study was run into this folder, or its shards are not merged");
  }
  return read_journal_file(file);
}

JournalContent read_journal_file(const std::filesystem::path& file) {
  Database database(file, Database::Mode::kRead);
  Transaction snapshot(database, Transaction::Kind::kRead);
  JournalContent content;
  content.study = read_record(database);
  content.rows = read_rows(database);
  Statement select_points = database.prepare("SELECT * FROM curves ORDER BY run, iteration");
  while (select_points.step()) {
    content.curves.push_back({.run = select_points.integer(0),
                              .iteration = static_cast<int>(select_points.integer(1)),
                              .fitness = select_points.number(2),
                              .acceptance_index = select_points.number(3),
                              .error_m = select_points.number(4),
                              .error_deg = select_points.number(5)});
  }
  return content;
}

void write_journal(const std::filesystem::path& file, const JournalContent& content) {
  const FileLock lock(file);
  const std::filesystem::path partial = file.string() + ".part";
  std::error_code error;
  const auto remove = [&](const std::filesystem::path& base) {
    for (const char* of : {"", "-wal", "-shm"}) {
      std::filesystem::remove(base.string() + of, error);
    }
  };
  remove(partial);
  {
    Database database(partial, Database::Mode::kWrite);
    Transaction transaction(database);
    create(database, content.study);
    Statement rows = insert_into_rows(database);
    for (const Row& row : content.rows) {
      insert(rows, row);
    }
    Statement points = insert_into_curves(database);
    for (const CurvePoint& point : content.curves) {
      insert(points, point);
    }
    transaction.commit();
  }
  remove(file);
  std::filesystem::rename(partial, file, error);
  if (error) {
    throw InputError(file.string(), "cannot be written: " + error.message());
  }
}

}  // namespace gridmerge::study
