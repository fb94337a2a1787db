#include "scenarios/sqlite.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <stdexcept>

#include "core/error.h"
#include "scenarios/store.h"

namespace tarmac::scenarios {
namespace {

/// How long a writer waits for another's transaction; they take milliseconds.
constexpr int kBusyTimeout_ms = 60'000;
/// How often a running statement asks whether to go on [virtual machine instructions].
constexpr int kInstructionsPerCheck = 20'000;

/// Statements may select, read columns and call functions; nothing else.
int authorise_reading(void*, int action, const char*, const char*, const char*, const char*) {
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
    case SQLITE_FUNCTION:
    case SQLITE_RECURSIVE:
      return SQLITE_OK;
    default:
      return SQLITE_DENY;
  }
}

void roll_back(Database& db) {
  // SQLite has done so already after some errors.
  if (!db.in_transaction()) return;
  try {
    db.run("rollback");
  } catch (const std::exception&) {
    // What is left of it ends with the connection.
  }
}

}  // namespace

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement& Statement::with(std::initializer_list<Bound> values) {
  int position = 0;
  for (const Bound& value : values) bind(++position, value);
  return *this;
}

void Statement::bind(int position, const Bound& value) {
  struct Binder {
    sqlite3_stmt* statement;
    int position;
    int operator()(std::nullptr_t) const { return sqlite3_bind_null(statement, position); }
    int operator()(std::int64_t v) const { return sqlite3_bind_int64(statement, position, v); }
    int operator()(double v) const { return sqlite3_bind_double(statement, position, v); }
    int operator()(std::string_view v) const {
      return sqlite3_bind_text64(statement, position, v.data() ? v.data() : "", v.size(), SQLITE_STATIC, SQLITE_UTF8);
    }
  };
  const int code = std::visit(Binder{statement_.get(), position}, value.value());
  if (code != SQLITE_OK) db_->fail(code);
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) {
    sqlite3_reset(statement_.get());
    return false;
  }
  // The connection's message is that of the failed step until the next call: read it before the reset.
  try {
    db_->fail(code);
  } catch (...) {
    sqlite3_reset(statement_.get());
    throw;
  }
}

void Statement::run() {
  while (step()) {
  }
}

void Statement::reset() {
  sqlite3_reset(statement_.get());
}

int Statement::columns() const {
  return sqlite3_column_count(statement_.get());
}
std::string Statement::name(int column) const {
  return sqlite3_column_name(statement_.get(), column);
}
bool Statement::null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
bool Statement::number(int column) const {
  const int type = sqlite3_column_type(statement_.get(), column);
  return type == SQLITE_INTEGER || type == SQLITE_FLOAT;
}
std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
double Statement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}
std::optional<double> Statement::optional_real(int column) const {
  return null(column) ? std::nullopt : std::optional(real(column));
}
std::string Statement::text(int column) const {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))) : "";
}

std::optional<std::string> Statement::value_text(int column) const {
  switch (sqlite3_column_type(statement_.get(), column)) {
    case SQLITE_NULL:
      return std::nullopt;
    case SQLITE_FLOAT:
      return fmt::format("{}", real(column));  // shortest text that reads back as the same number
    default:
      return text(column);
  }
}

Database::Database(std::filesystem::path file, Mode mode) : file_(std::move(file)) {
  const int flags = (mode == Mode::read_only    ? SQLITE_OPEN_READONLY
                     : mode == Mode::read_write ? SQLITE_OPEN_READWRITE
                                                : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) |
                    SQLITE_OPEN_NOMUTEX;
  const int code = sqlite3_open_v2(file_.c_str(), &db_, flags, nullptr);
  try {
    if (code != SQLITE_OK) fail(code);
    sqlite3_extended_result_codes(db_, 1);
    sqlite3_busy_timeout(db_, kBusyTimeout_ms);
    execute("pragma foreign_keys = off; pragma cache_size = -65536; pragma temp_store = memory");
    // Of a transaction only the write-ahead log is written, and not waited for: ending a process loses nothing that was
    // committed, a power cut loses the last ones, and neither damages the file.
    if (mode != Mode::read_only)
      execute("pragma journal_mode = wal; pragma synchronous = normal; pragma wal_autocheckpoint = 8000");
  } catch (...) {
    sqlite3_close(db_);
    throw;
  }
}

Database::~Database() {
  statements_.clear();
  sqlite3_close(db_);
}

void Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(code);
}

Statement Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  const char* rest = nullptr;
  const int code = sqlite3_prepare_v2(db_, sql.data(), static_cast<int>(sql.size()), &statement, &rest);
  if (code != SQLITE_OK) fail(code);
  Statement prepared(*this, statement);
  if (!users_statement_) return prepared;
  if (!statement) throw core::InputError("query: there is no statement; expected one such as select * from results");
  const std::string_view more(rest, static_cast<std::size_t>(sql.data() + sql.size() - rest));
  if (more.find_first_not_of(" \t\r\n;") != std::string_view::npos)
    throw core::InputError(fmt::format("query: one statement at a time; after the first there is '{}'", more));
  return prepared;
}

Statement& Database::cached(std::string_view sql) {
  std::unique_ptr<Statement>& statement = statements_[std::string(sql)];
  if (!statement) {
    statement = std::make_unique<Statement>(prepare(sql));
  } else {
    statement->reset();
  }
  return *statement;
}

std::int64_t Database::integer(std::string_view sql, std::initializer_list<Bound> values) {
  Statement& statement = cached(sql).with(values);
  if (!statement.step()) return 0;
  const std::int64_t value = statement.integer(0);
  statement.reset();
  return value;
}

std::int64_t Database::last_id() const {
  return sqlite3_last_insert_rowid(db_);
}
std::int64_t Database::changes() const {
  return sqlite3_changes64(db_);
}
bool Database::in_transaction() const {
  return sqlite3_get_autocommit(db_) == 0;
}

void Database::only_read() {
  users_statement_ = true;
  sqlite3_set_authorizer(db_, authorise_reading, nullptr);
}

int Database::progress(void* self) {
  auto& db = *static_cast<Database*>(self);
  try {
    db.check_();
    return 0;
  } catch (...) {
    db.thrown_ = std::current_exception();
    return 1;
  }
}

void Database::check_with(std::function<void()> check) {
  check_ = std::move(check);
  sqlite3_progress_handler(db_, check_ ? kInstructionsPerCheck : 0, check_ ? &Database::progress : nullptr, this);
}

void Database::fail(int code) {
  const std::string words = db_ ? sqlite3_errmsg(db_) : sqlite3_errstr(code);
  if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
  switch (code & 0xff) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
      throw StoreFull(
          fmt::format("{}: cannot be written ({}): the disk is full or fails. Nothing of what was being written is "
                      "in it, finished cells are kept; free some space and try again (a sweep goes on with --resume)",
                      file_.string(), words));
    case SQLITE_NOTADB:
      throw core::InputError(
          fmt::format("{}: this is no SQLite file; expected a store that tarmac sweep or merge wrote", file_.string()));
    case SQLITE_CORRUPT:
      throw core::InputError(
          fmt::format("{}: the file is damaged ({}); it was cut short or written over: take a copy of it, or run the "
                      "sweep again into a new folder",
                      file_.string(), words));
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw core::InputError(fmt::format("{}: another process has held it for {} s; look which one does, and try again",
                                         file_.string(), kBusyTimeout_ms / 1000));
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_READONLY:
      throw core::InputError(
          fmt::format("{}: cannot be opened ({}); check that it is there and may be read and written, with its folder",
                      file_.string(), words));
    default:
      break;
  }
  if (users_statement_) {
    const bool denied = (code & 0xff) == SQLITE_AUTH;
    throw core::InputError(fmt::format("query: {}{}", words, denied ? "; a query may only read: select … from …" : ""));
  }
  throw std::logic_error(fmt::format("{}: {}", file_.string(), words));
}

Transaction::Transaction(Database& db) : db_(db) {
  db_.run("begin immediate");
}

Transaction::~Transaction() {
  roll_back(db_);
}

void Transaction::commit() {
  db_.run("commit");
}

Snapshot::~Snapshot() {
  roll_back(db_);
}

}  // namespace tarmac::scenarios
