#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

// SQLite as far as results need it. Whatever goes wrong with the file is an InputError that names it: it is a file that
// a person handed over.

namespace insonate::sqlite {

/// An open database file. Other processes may have it open too: one that finds it locked waits up to kPatience_ms.
class Connection {
public:
  static constexpr int kPatience_ms = 10'000;

  /// @param create  makes an empty file where there is none
  Connection(std::filesystem::path file, bool create);

  /// One or more statements that need no values and give none.
  void run(const std::string& sql);
  /// The first column of the first row; 0 when there is none.
  std::int64_t number(const std::string& sql);
  std::string text(const std::string& sql);
  /// Of the row inserted last.
  std::int64_t last_row() const;

  /// Throws the InputError for a result code of SQLite.
  [[noreturn]] void fail(int code) const;

  const std::filesystem::path& file() const { return file_; }
  sqlite3* handle() const { return handle_.get(); }

private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::filesystem::path file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// One prepared statement. Parameters and columns count from 1 and 0, as SQLite has it.
class Statement {
public:
  Statement(Connection& connection, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind_bytes(int parameter, std::string_view bytes);

  /// Whether there is a (next) row.
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

/// All or nothing: what is not committed is undone. Holds the only right to write from its beginning, so that what it
/// reads cannot change before it writes.
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
