#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

// The part of SQLite that the results need. Errors of the file throw InputError naming it, because a person chose the
// file.

namespace insonate::sqlite {

/// An open database file. Other processes may have it open too. A process that finds it locked waits up to
/// kPatience_ms.
class Connection {
public:
  static constexpr int kPatience_ms = 10'000;

  /// Opens the file. Throws InputError if this fails.
  /// @param create  creates an empty file if there is none
  Connection(std::filesystem::path file, bool create);

  /// Runs one or more statements without parameters and results.
  void run(const std::string& sql);
  /// Returns the first column of the first row; 0 or "" if there is no row.
  std::int64_t number(const std::string& sql);
  std::string text(const std::string& sql);
  /// Returns the id of the row inserted last.
  std::int64_t last_row() const;

  /// Throws the InputError for an SQLite result code, or std::bad_alloc if memory ran out.
  [[noreturn]] void fail(int code) const;

  const std::filesystem::path& file() const { return file_; }
  sqlite3* handle() const { return handle_.get(); }

private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path file_;
  std::shared_ptr<const void> held_;  ///< hold_file(), for as long as the handle is open
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A prepared statement. Parameters count from 1 and columns from 0, as in SQLite.
class Statement {
public:
  Statement(Connection& connection, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind_bytes(int parameter, std::string_view bytes);

  /// Advances to the next row. Returns false after the last row.
  bool step();

  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  std::string bytes(int column) const;

private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  void check(int code);

  Connection* connection_;
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
};

/// A transaction; the destructor undoes everything that is not committed. It holds the exclusive right to write from
/// its start, so that what it reads cannot change before it writes.
class Transaction {
public:
  explicit Transaction(Connection& connection);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

private:
  Connection* connection_;
  bool open_ = true;
};

}  // namespace insonate::sqlite
