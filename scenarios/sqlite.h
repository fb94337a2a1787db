/// The little of SQLite that the store needs: a connection, prepared statements, transactions, and its errors as ours.
/// Private to scenarios/; sqlite3.h is named in the .cpp alone.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>

struct sqlite3;
struct sqlite3_stmt;

namespace tarmac::scenarios {

/// What a parameter of a statement is given. Text must outlive the statement's next run.
class Bound {
 public:
  Bound(std::nullptr_t) {}
  Bound(int v) : value_(std::int64_t{v}) {}
  Bound(std::int64_t v) : value_(v) {}
  Bound(std::size_t v) : value_(static_cast<std::int64_t>(v)) {}
  Bound(double v) : value_(v) {}
  Bound(const std::optional<double>& v) {
    if (v) value_ = *v;
  }
  Bound(const char* v) : value_(std::string_view(v)) {}
  Bound(const std::string& v) : value_(std::string_view(v)) {}
  Bound(std::string_view v) : value_(v) {}

  const auto& value() const { return value_; }

 private:
  std::variant<std::nullptr_t, std::int64_t, double, std::string_view> value_ = nullptr;
};

class Database;

class Statement {
 public:
  /// Ready to be run (again) with these values.
  Statement& with(std::initializer_list<Bound> values);
  void bind(int position, const Bound& value);  ///< positions begin at 1
  bool step();                                  ///< true: there is a row
  void run();                                   ///< to its end
  void reset();

  int columns() const;
  std::string name(int column) const;
  bool null(int column) const;
  bool number(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  std::optional<double> optional_real(int column) const;
  std::string text(int column) const;
  /// As text; numbers with 17 significant digits where they need them.
  std::optional<std::string> value_text(int column) const;

 private:
  friend class Database;
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  Statement(Database& db, sqlite3_stmt* statement) : db_(&db), statement_(statement) {}
  Database* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// One connection; not to be used by two threads at once.
class Database {
 public:
  enum class Mode { read_only, read_write, create };
  Database(std::filesystem::path file, Mode mode);
  ~Database();
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  const std::filesystem::path& file() const { return file_; }
  void execute(const std::string& sql);  ///< one or several statements, no results
  Statement prepare(std::string_view sql);
  /// Kept prepared; reset. `sql` is the key.
  Statement& cached(std::string_view sql);
  void run(std::string_view sql, std::initializer_list<Bound> values = {}) { cached(sql).with(values).run(); }
  /// First column of the first row; 0 without one.
  std::int64_t integer(std::string_view sql, std::initializer_list<Bound> values = {});
  std::int64_t last_id() const;
  std::int64_t changes() const;  ///< rows of the last insert, update or delete
  bool in_transaction() const;

  /// From here on statements may only read: the authoriser refuses all else.
  void only_read();
  /// Called now and then while a statement runs; what it throws ends the statement and is thrown by it.
  void check_with(std::function<void()> check);

  /// Throws what an SQLite error code means: StoreFull, InputError, or (our own mistakes) std::logic_error.
  [[noreturn]] void fail(int code);

 private:
  friend class Statement;
  static int progress(void* self);
  std::filesystem::path file_;
  sqlite3* db_ = nullptr;
  std::unordered_map<std::string, std::unique_ptr<Statement>> statements_;
  std::function<void()> check_;
  std::exception_ptr thrown_;
  bool users_statement_ = false;  ///< after only_read(): errors are the statement's author's, in SQLite's words
};

/// BEGIN IMMEDIATE, so that no write can find itself behind another process's; rolled back unless committed.
class Transaction {
 public:
  explicit Transaction(Database& db);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& db_;
};

/// Reads that belong together see one state of the store, whatever is committed meanwhile.
class Snapshot {
 public:
  explicit Snapshot(Database& db) : db_(db) { db_.run("begin"); }
  ~Snapshot();
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

 private:
  Database& db_;
};

}  // namespace tarmac::scenarios
