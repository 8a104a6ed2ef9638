#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/results/attempt.h"
#include "scenarios/results/sitting.h"
#include "scenarios/results/sqlite.h"

namespace insonate {

/// An attempt in a list.
struct AttemptSummary {
  std::int64_t number = 0;
  std::string learner;
  std::optional<AttemptMode> mode;  ///< empty when it was kept by a version that did not say
  std::int64_t finished_ms = 0;
  std::string title;  ///< of the scenario
  std::string scenario_digest;
  bool complete = false;
  double percent = 0;
  bool passed = false;
};

struct LearnerSummary {
  std::string id;
  int attempts = 0;
  int exams = 0;                       ///< of these that counted, or may have (is_of)
  int passed = 0;                      ///< of the exams
  std::optional<double> best_percent;  ///< of the exams
  std::int64_t last_ms = 0;            ///< when the last attempt finished
};

/// The results of a lab, in one SQLite file. An attempt is in it whole, or not at all, whenever a program or the power
/// ends: add() returns when the attempt is on the disk. Several programs of one computer may have it open at once; one
/// waits for the other to write, up to sqlite::Connection::kPatience_ms.
///
/// Whatever is wrong with the file throws an InputError: it is missing, damaged, of another program or of a newer
/// version, locked for too long, or cannot be written. Opening one of an older version brings its tables up to date.
class ResultsDatabase {
public:
  /// Opens a database that is there.
  static ResultsDatabase open(const std::filesystem::path& file);
  /// Opens one, or makes it, and the folders it is to lie in.
  static ResultsDatabase open_or_make(const std::filesystem::path& file);

  /// Keeps an attempt and sets its number and uuid. Throws InputError when the learner's id is none, or the score does
  /// not read back, and ExamTaken when there is no such sitting any more.
  /// @param sitting  of which it is what was handed in, and which it takes the place of; 0 for none
  void add(Attempt& attempt, std::int64_t sitting = 0);

  /// Throws InputError when there is no attempt of that number, or when it is damaged.
  Attempt read(std::int64_t number);

  /// In the order in which they were added.
  std::vector<AttemptSummary> attempts();
  /// In the order of their ids.
  std::vector<LearnerSummary> learners();

  /// Throws ExamTaken when this learner has taken this very exam so that it counted, or has a sitting. An attempt that
  /// does not say its mode may have counted, and is taken to have.
  void check_not_taken(const std::string& learner, const std::string& scenario_digest);
  /// Keeps that an exam begins now, with the first part of its log, and sets its number, digest and times. Throws what
  /// check_not_taken() throws, and InputError when the learner's id is none.
  void begin(Sitting& sitting, std::string_view log);
  /// Keeps what has come of it since the part before: a sequence file without pictures. Throws ExamTaken when there is
  /// no such sitting any more.
  void add_part(std::int64_t sitting, std::string_view log);
  /// The exams that were begun and not handed in, in the order in which they began.
  std::vector<Sitting> sittings();
  /// What there is of one, in order.
  std::vector<std::string> parts(std::int64_t sitting);
  /// Removes one as if it had not begun, with its learner if nothing else is of him.
  void remove(std::int64_t sitting);

  const std::filesystem::path& file() const { return connection_.file(); }

  /// 32 hexadecimal digits that no other database has.
  std::string identity();

  /// Reads all of the file and throws InputError when any of it is damaged.
  void check();

private:
  ResultsDatabase(const std::filesystem::path& file, bool make);
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;
  std::int64_t insert_part(std::int64_t sitting, std::string_view log);
  void take_out(std::int64_t sitting);

  sqlite::Connection connection_;
};

}  // namespace insonate
