// The part of ResultsDatabase for comments on attempts.

#include "scenarios/results/database/results_database.h"
#include "sim/core/input_error.h"

namespace insonate {
namespace {

std::vector<Comment> read_comments(sqlite::Statement& row) {
  std::vector<Comment> list;
  while (row.step()) {
    Comment& comment = list.emplace_back();
    comment.number = row.integer(0);
    comment.attempt = row.integer(1);
    comment.author = row.text(2);
    comment.written_ms = row.integer(3);
    comment.text = row.text(4);
  }
  return list;
}

}  // namespace

void ResultsDatabase::add(Comment& comment) {
  check_comment(comment, file().string());
  sqlite::Transaction transaction(connection_);
  if (!sqlite::Statement(connection_, "SELECT 1 FROM attempt WHERE number = ?").bind(1, comment.attempt).step())
    refuse_missing(comment.attempt);
  sqlite::Statement(connection_, "INSERT INTO comment (attempt, author, written_ms, text) VALUES (?, ?, ?, ?)")
      .bind(1, comment.attempt)
      .bind(2, comment.author)
      .bind(3, comment.written_ms)
      .bind(4, comment.text)
      .step();
  const std::int64_t number = connection_.last_row();
  transaction.commit();
  comment.number = number;
}

std::vector<Comment> ResultsDatabase::comments() {
  sqlite::Statement row(connection_, "SELECT number, attempt, author, written_ms, text FROM comment ORDER BY number");
  return read_comments(row);
}

std::vector<Comment> ResultsDatabase::comments(std::int64_t attempt) {
  sqlite::Statement row(
      connection_, "SELECT number, attempt, author, written_ms, text FROM comment WHERE attempt = ? ORDER BY number");
  row.bind(1, attempt);
  return read_comments(row);
}

void ResultsDatabase::remove_comment(std::int64_t number) {
  sqlite::Transaction transaction(connection_);
  sqlite::Statement(connection_, "DELETE FROM comment WHERE number = ?").bind(1, number).step();
  if (connection_.number("SELECT changes()") == 0)
    throw InputError(file().string(), "", "there is no comment " + std::to_string(number),
                     "list them with 'insonate-score attempts'");
  transaction.commit();
}

}  // namespace insonate
