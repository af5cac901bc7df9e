#include "db/sqlite.hpp"

#include <utility>

#include <sqlite3.h>

#include "db/store.hpp"

namespace repose::db {

namespace {

/// What to do about an error, in words; empty where SQLite's text says enough.
std::string advice(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return "; the disk is full: make room and try again, nothing was half-written";
    case SQLITE_IOERR:
      return "; the disk failed to read or write: check it and try again";
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return "; check that the folder exists and that you may write there";
    case SQLITE_BUSY:
      return "; another program holds it: wait or end that program";
    case SQLITE_NOTADB:
      return "; choose another file, or move this one away";
    case SQLITE_CORRUPT:
      return "; the file is damaged: restore a copy";
    default:
      return {};
  }
}

}  // namespace

Connection::Connection(const std::filesystem::path& file, Mode mode) : file_(file) {
  const int flags =
      mode == Mode::write ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READONLY;
  const int code = sqlite3_open_v2(file.c_str(), &handle_, flags | SQLITE_OPEN_EXRESCODE, nullptr);
  if (code != SQLITE_OK) {
    const std::string text =
        "cannot open database " + file.string() + ": " + sqlite3_errstr(code) + advice(code);
    sqlite3_close_v2(handle_);
    throw Error(code, text);
  }
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_busy_timeout(handle_, 5000);
  // Only the writer moves pages from the log to the file.
  if (mode == Mode::read) {
    sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    sqlite3_wal_autocheckpoint(handle_, 0);
  }
}

Connection::~Connection() { sqlite3_close_v2(handle_); }

void Connection::fail(std::string_view doing) const {
  const int code = sqlite3_extended_errcode(handle_);
  throw Error(code,
              "database " + file_.string() + ": " + std::string(doing) + ": " +
                  sqlite3_errmsg(handle_) + advice(code));
}

void Connection::run(const std::string& sql) {
  if (sqlite3_exec(handle_, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
    fail("cannot carry out a statement");
  }
}

Statement Connection::prepare(std::string_view sql) { return {*this, sql}; }
std::int64_t Connection::last_id() const { return sqlite3_last_insert_rowid(handle_); }
std::int64_t Connection::changes() const { return sqlite3_changes64(handle_); }
bool Connection::in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }

void Connection::copy_to(Connection& other) {
  sqlite3_backup* copy = sqlite3_backup_init(other.handle_, "main", handle_, "main");
  if (copy == nullptr) other.fail("cannot begin a copy");
  sqlite3_backup_step(copy, -1);
  // The code of a step that failed comes again from here.
  if (sqlite3_backup_finish(copy) != SQLITE_OK) other.fail("cannot copy into it");
}

Statement::Statement(Connection& connection, std::string_view sql) : connection_(connection) {
  if (sqlite3_prepare_v2(
          connection.handle_, sql.data(), static_cast<int>(sql.size()), &handle_, nullptr) !=
      SQLITE_OK) {
    connection.fail("cannot prepare a statement");
  }
}

Statement::~Statement() { sqlite3_finalize(handle_); }

Statement::Statement(Statement&& other) noexcept
    : connection_(other.connection_),
      handle_(std::exchange(other.handle_, nullptr)),
      next_(other.next_) {}

void Statement::check(int code) {
  if (code != SQLITE_OK) connection_.fail("cannot bind a value");
}

Statement& Statement::bind(std::int64_t value) {
  check(sqlite3_bind_int64(handle_, next_++, value));
  return *this;
}

Statement& Statement::bind(double value) {
  check(sqlite3_bind_double(handle_, next_++, value));
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  check(sqlite3_bind_text64(
      handle_, next_++, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_null() {
  check(sqlite3_bind_null(handle_, next_++));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_);
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  connection_.fail("cannot carry out a statement");
}

void Statement::run() {
  while (step()) {
  }
  sqlite3_reset(handle_);
  next_ = 1;
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(handle_, column); }
double Statement::real(int column) const { return sqlite3_column_double(handle_, column); }

std::string Statement::text(int column) const {
  const auto* start = reinterpret_cast<const char*>(sqlite3_column_text(handle_, column));
  if (start == nullptr) return {};
  return {start, static_cast<std::size_t>(sqlite3_column_bytes(handle_, column))};
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(handle_, column) == SQLITE_NULL;
}

std::optional<std::int64_t> Statement::integer_or_null(int column) const {
  return is_null(column) ? std::nullopt : std::optional(integer(column));
}

std::optional<double> Statement::real_or_null(int column) const {
  return is_null(column) ? std::nullopt : std::optional(real(column));
}

std::optional<std::string> Statement::text_or_null(int column) const {
  return is_null(column) ? std::nullopt : std::optional(text(column));
}

Transaction::Transaction(Connection& connection)
    : connection_(connection), within_(connection.in_transaction()) {
  connection_.run(within_ ? "SAVEPOINT part" : "BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // A failed statement may have rolled back by itself.
  if (!open_ || !connection_.in_transaction()) return;
  try {
    connection_.run(within_ ? "ROLLBACK TO part; RELEASE part" : "ROLLBACK");
  } catch (const Error&) {
    // The connection is beyond use; its next statement will say so.
    return;
  }
}

void Transaction::commit() {
  connection_.run(within_ ? "RELEASE part" : "COMMIT");
  open_ = false;
}

}  // namespace repose::db
