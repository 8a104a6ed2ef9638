#include "scenarios/results/database/sqlite.h"

#include <sqlite3.h>

#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "sim/core/input_error.h"
#include "sim/files/held_files.h"

namespace insonate::sqlite {

void Connection::Close::operator()(sqlite3* handle) const {
  sqlite3_close_v2(handle);
}

void Statement::Finalize::operator()(sqlite3_stmt* handle) const {
  sqlite3_finalize(handle);
}

Connection::Connection(std::filesystem::path file, bool create) : file_(std::move(file)) {
  // SQLite treats a file smaller than its smallest page as an empty database, and would overwrite it.
  constexpr std::uintmax_t kSmallestPage = 512;
  std::error_code missing;
  const std::uintmax_t size = std::filesystem::file_size(file_, missing);
  if (!missing && size > 0 && size < kSmallestPage) fail(SQLITE_NOTADB);
  sqlite3* opened = nullptr;
  const int code =
      sqlite3_open_v2(file_.c_str(), &opened, SQLITE_OPEN_READWRITE | (create ? SQLITE_OPEN_CREATE : 0), nullptr);
  handle_.reset(opened);
  if (code != SQLITE_OK) fail(code);
  held_ = hold_file(file_);
  if (sqlite3_db_readonly(opened, "main") == 1) fail(SQLITE_READONLY);
  sqlite3_busy_timeout(opened, kPatience_ms);
  // The file may come from an untrusted source: nothing in it may run or change how SQLite reads it.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
}

void Connection::run(const std::string& sql) {
  if (const int code = sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr); code != SQLITE_OK) fail(code);
}

std::int64_t Connection::number(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::string Connection::text(const std::string& sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.text(0) : "";
}

std::int64_t Connection::last_row() const {
  return sqlite3_last_insert_rowid(handle());
}

void Connection::fail(int code) const {
  const std::string message = handle() ? sqlite3_errmsg(handle()) : sqlite3_errstr(code);
  const auto throw_with = [&](const std::string& problem, const char* remedy) {
    throw InputError(file_.string(), "", problem, remedy);
  };
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw_with("another program has kept it locked for " + std::to_string(kPatience_ms / 1000) + " s",
                 "let that program finish, then try again");
      break;
    case SQLITE_NOTADB:
      throw_with("this is not a database of results", "name one that the trainer has written");
      break;
    case SQLITE_FULL:
      throw_with("the disk is full", "make room on it and try again");
      break;
    case SQLITE_READONLY:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      throw_with("the database cannot be opened for writing (" + message + ")",
                 "check the permissions of the file and of its folder, where two more files lie beside it");
      break;
    case SQLITE_IOERR:
      // The shared memory file beside the database cannot grow.
      if (handle() && sqlite3_extended_errcode(handle()) == SQLITE_IOERR_SHMSIZE)
        throw_with("the disk is full", "make room on it and try again");
      throw_with("the disk does not read or write it (" + message + ")", "check the disk, or copy the file to another");
      break;
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    default:
      throw_with("the database is damaged (" + message + ")", "go back to a copy of it from before");
  }
  throw std::logic_error("unreachable");
}

Statement::Statement(Connection& connection, const std::string& sql) : connection_(&connection) {
  sqlite3_stmt* prepared = nullptr;
  const int code = sqlite3_prepare_v2(connection.handle(), sql.c_str(), int(sql.size()), &prepared, nullptr);
  handle_.reset(prepared);
  check(code);
}

void Statement::check(int code) {
  if (code != SQLITE_OK) connection_->fail(code);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(handle_.get(), parameter, text.data() ? text.data() : "", text.size(), SQLITE_TRANSIENT,
                            SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind_bytes(int parameter, std::string_view bytes) {
  check(
      sqlite3_bind_blob64(handle_.get(), parameter, bytes.data() ? bytes.data() : "", bytes.size(), SQLITE_TRANSIENT));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) connection_->fail(code);
  return code == SQLITE_ROW;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

double Statement::real(int column) const {
  return sqlite3_column_double(handle_.get(), column);
}

std::string Statement::text(int column) const {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  return text ? std::string(text, std::size_t(sqlite3_column_bytes(handle_.get(), column))) : std::string();
}

std::string Statement::bytes(int column) const {
  const auto* blob = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column));
  return blob ? std::string(blob, std::size_t(sqlite3_column_bytes(handle_.get(), column))) : std::string();
}

Transaction::Transaction(Connection& connection) : connection_(&connection) {
  connection.run("BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // If this fails, SQLite has already rolled back, or rolls back when the file is next opened.
  if (open_) sqlite3_exec(connection_->handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

void Transaction::commit() {
  connection_->run("COMMIT");
  open_ = false;
}

}  // namespace insonate::sqlite
