#pragma once
/// SQLite's C interface with values, destructors and exceptions.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace gridmerge::study {

class Database;

/// One prepared statement. It must not outlive its database. Parameters count from 1, columns from 0.
class Statement {
 public:
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);  ///< NaN becomes NULL
  void bind(int parameter, std::string_view text);

  /// Goes to the next row; false: there is none. @throws InputError naming the file
  bool step();
  /// Runs a statement that gives no row, and makes it ready for the next values.
  void run();

  [[nodiscard]] int columns() const;
  [[nodiscard]] std::string name(int column) const;
  [[nodiscard]] bool is_null(int column) const;
  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double number(int column) const;  ///< NULL becomes NaN
  [[nodiscard]] std::string text(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(const Database& database, const std::string& sql);
  const Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// One connection; for one thread at a time.
class Database {
 public:
  enum class Mode { kRead, kWrite };  ///< kWrite makes the file where there is none

  /// @throws InputError naming the file
  Database(std::filesystem::path file, Mode mode);

  /// @throws InputError naming the file, with what SQLite says
  void execute(const std::string& sql);
  [[nodiscard]] Statement prepare(const std::string& sql) const { return {*this, sql}; }
  [[nodiscard]] bool has_table(const std::string& name) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* database) const;
  };
  [[noreturn]] void fail() const;
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> database_;
};

/// All or nothing: undone unless committed. Whoever reads in one sees one moment, though others write.
class Transaction {
 public:
  enum class Kind { kRead, kWrite };
  explicit Transaction(Database& database, Kind kind = Kind::kWrite) : database_(database) {
    database_.execute(kind == Kind::kWrite ? "BEGIN IMMEDIATE" : "BEGIN");
  }
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  ~Transaction();
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace gridmerge::study
