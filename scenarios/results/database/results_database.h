#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/results/attempt.h"
#include "scenarios/results/database/comment.h"
#include "scenarios/results/database/sitting.h"
#include "scenarios/results/database/sqlite.h"

namespace insonate {

/// Summary of an attempt for a list.
struct AttemptSummary {
  std::int64_t number = 0;
  std::string learner;
  std::optional<AttemptMode> mode;  ///< empty if a version stored it that did not record the mode
  std::int64_t finished_ms = 0;
  std::string title;  ///< of the scenario
  std::string scenario_digest;
  bool complete = false;
  double percent = 0;
  bool passed = false;
};

/// Summary of a learner for a list.
struct LearnerSummary {
  std::string id;
  int attempts = 0;
  int exams = 0;                       ///< attempts that are or may be graded exams (is_of)
  int passed = 0;                      ///< of the exams
  std::optional<double> best_percent;  ///< of the exams
  std::int64_t last_ms = 0;            ///< end of the last attempt
};

/// Returns the learners of these attempts in the order of their ids.
std::vector<LearnerSummary> learners_of(const std::vector<AttemptSummary>& attempts);

/// The results of a lab, in one SQLite file. An attempt is stored completely or not at all, even if a program or the
/// power fails. add() returns after the attempt is on the disk. Several programs on one computer may have it open at
/// once. A writer waits for another one up to sqlite::Connection::kPatience_ms.
///
/// All functions throw InputError if the file is missing, damaged, from another program or from a newer version, if it
/// stays locked for too long, or if it cannot be written. Opening a file of an older version upgrades its tables.
class ResultsDatabase {
public:
  /// Opens an existing database.
  static ResultsDatabase open(const std::filesystem::path& file);
  /// Opens a database, or creates it with its folders.
  static ResultsDatabase open_or_make(const std::filesystem::path& file);

  /// Stores an attempt and sets its number, database and uuid. Throws InputError if the learner's id is not valid or
  /// the score cannot be parsed. Throws ExamTaken if the sitting no longer exists.
  /// @param sitting  the sitting that this attempt completes and replaces; 0 for none
  void add(Attempt& attempt, std::int64_t sitting = 0);

  /// Returns an attempt. Throws InputError if there is no attempt of that number, or if it is damaged.
  Attempt read(std::int64_t number);
  /// Returns an attempt without its log, trace, pictures and comments, which takes a small part of the time. Throws
  /// InputError if there is no attempt of that number, or if its scenario is damaged.
  Attempt read_score(std::int64_t number);

  /// Returns all attempts in the order in which they were added.
  std::vector<AttemptSummary> attempts();
  /// Returns all learners in the order of their ids.
  std::vector<LearnerSummary> learners();

  /// Stores a comment on an attempt and sets its number. Throws InputError if the comment is not valid
  /// (check_comment), or if there is no such attempt.
  void add(Comment& comment);
  /// Returns all comments, or those on one attempt, in the order in which they were added.
  std::vector<Comment> comments();
  std::vector<Comment> comments(std::int64_t attempt);
  /// Removes a comment. Throws InputError if there is no comment of that number.
  void remove_comment(std::int64_t number);

  /// Throws ExamTaken if this learner has a graded attempt at this exam, or a sitting. An attempt without a recorded
  /// mode may have been graded and is treated as such.
  void check_not_taken(const std::string& learner, const std::string& scenario_digest);
  /// Records the start of an exam with the first part of its log, and sets the sitting's number, digest and times.
  /// Throws as check_not_taken() does, and InputError if the learner's id is not valid.
  void begin(Sitting& sitting, std::string_view log);
  /// Stores the next part of a sitting's log: a sequence file without pictures. Throws ExamTaken if the sitting no
  /// longer exists.
  void add_part(std::int64_t sitting, std::string_view log);
  /// Returns the exams that were begun but not handed in, in the order in which they began.
  std::vector<Sitting> sittings();
  /// Returns the stored log parts of a sitting, in order.
  std::vector<std::string> parts(std::int64_t sitting);
  /// Removes a sitting as if it had not begun. Also removes its learner if nothing else refers to them.
  void remove(std::int64_t sitting);

  const std::filesystem::path& file() const { return connection_.file(); }

  /// Returns 32 hexadecimal digits that are unique to this database.
  std::string identity();

  /// Reads the whole file. Throws InputError if any part is damaged.
  void check();

private:
  ResultsDatabase(const std::filesystem::path& file, bool make);
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;
  [[noreturn]] void refuse_missing(std::int64_t attempt) const;
  Attempt read_score(sqlite::Statement& row, std::int64_t number);
  std::int64_t insert_part(std::int64_t sitting, std::string_view log);
  void take_out(std::int64_t sitting);

  sqlite::Connection connection_;
};

}  // namespace insonate
