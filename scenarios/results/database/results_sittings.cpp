// The part of ResultsDatabase for exams that are not handed in yet.

#include <optional>
#include <utility>

#include "scenarios/results/database/compression.h"
#include "scenarios/results/database/packed_column.h"
#include "scenarios/results/database/results_database.h"
#include "scenarios/results/learner_id.h"
#include "sim/core/input_error.h"
#include "sim/core/text.h"
#include "sim/files/digest.h"

namespace insonate {
namespace {

[[noreturn]] void refuse_gone(const std::filesystem::path& file, std::int64_t sitting) {
  throw ExamTaken(file.string(), "sitting " + std::to_string(sitting), "it has been handed in meanwhile, or removed",
                  "look at the attempts with 'insonate-score attempts'");
}

}  // namespace

void ResultsDatabase::check_not_taken(const std::string& learner, const std::string& scenario_digest) {
  const auto found = [&](const char* sql) {
    sqlite::Statement row(connection_, sql);
    row.bind(1, learner).bind(2, scenario_digest);
    return row.step() ? std::optional(std::pair(row.integer(0), row.integer(1))) : std::nullopt;
  };
  const std::string who = "learner '" + learner + "'";
  if (const auto taken =
          found("SELECT number, 0 FROM attempt WHERE learner = ? AND scenario_digest = ? AND mode IN ('exam', '')"))
    throw ExamTaken(who, "", "the exam has been taken already, as attempt " + std::to_string(taken->first),
                    "start another exam, or practise");
  if (const auto begun = found("SELECT number, began_ms FROM sitting WHERE learner = ? AND scenario_digest = ?"))
    throw ExamTaken(who, "", "the exam was begun at " + utc_time(begun->second) + " and is not handed in",
                    "end it where it is being taken, or run insonate-score hand-in " + shell_word(file().string()) +
                        " to have what there is of it scored");
}

void ResultsDatabase::begin(Sitting& sitting, std::string_view log) {
  check_learner_id(sitting.learner, file().string(), "learner");
  const std::string digest = digest_of(sitting.scenario_text);
  sqlite::Transaction transaction(connection_);
  check_not_taken(sitting.learner, digest);
  sqlite::Statement(connection_, "INSERT INTO learner VALUES (?) ON CONFLICT DO NOTHING")
      .bind(1, sitting.learner)
      .step();
  const std::int64_t now_ms = now_since_1970_ms();
  sqlite::Statement insert(connection_,
                           "INSERT INTO sitting (learner, began_ms, title, scenario_digest, scenario_file, scenario, "
                           "patient, seed) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, sitting.learner).bind(2, now_ms).bind(3, sitting.title).bind(4, digest);
  insert.bind(5, sitting.scenario_file).bind(6, sitting.scenario_text).bind(7, sitting.patient);
  insert.bind(8, std::int64_t(sitting.seed));
  insert.step();
  const std::int64_t number = connection_.last_row();
  const std::int64_t kept_ms = insert_part(number, log);
  transaction.commit();
  sitting.number = number;
  sitting.scenario_digest = digest;
  sitting.began_ms = now_ms;
  sitting.kept_ms = kept_ms;
}

void ResultsDatabase::add_part(std::int64_t sitting, std::string_view log) {
  sqlite::Transaction transaction(connection_);
  if (!sqlite::Statement(connection_, "SELECT 1 FROM sitting WHERE number = ?").bind(1, sitting).step())
    refuse_gone(file(), sitting);
  insert_part(sitting, log);
  transaction.commit();
}

std::int64_t ResultsDatabase::insert_part(std::int64_t sitting, std::string_view log) {
  // Not earlier: a process that waited for another writer must not look abandoned.
  const std::int64_t now_ms = now_since_1970_ms();
  sqlite::Statement insert(connection_,
                           "INSERT INTO sitting_part SELECT ?1, coalesce(max(part), 0) + 1, ?2, ?3, ?4 "
                           "FROM sitting_part WHERE sitting = ?1");
  insert.bind(1, sitting).bind(2, now_ms).bind(3, std::int64_t(log.size())).bind_bytes(4, compressed(log));
  insert.step();
  return now_ms;
}

std::vector<Sitting> ResultsDatabase::sittings() {
  std::vector<Sitting> list;
  // Finds the newest part by its number, because a clock that was set back gives it an earlier time than the others.
  // With max(), SQLite returns the other columns from the row of the maximum.
  sqlite::Statement row(connection_,
                        "SELECT number, learner, began_ms, kept_ms, title, scenario, scenario_digest, "
                        "scenario_file, patient, seed, max(part) FROM sitting JOIN sitting_part ON sitting = number "
                        "GROUP BY number ORDER BY number");
  while (row.step())
    list.push_back({row.integer(0), row.text(1), row.integer(2), row.integer(3), row.text(4), row.text(5), row.text(6),
                    row.text(7), row.text(8), std::uint32_t(row.integer(9))});
  return list;
}

std::vector<std::string> ResultsDatabase::parts(std::int64_t sitting) {
  std::vector<std::string> logs;
  sqlite::Statement row(connection_, "SELECT log_size, log FROM sitting_part WHERE sitting = ? ORDER BY part");
  row.bind(1, sitting);
  while (row.step()) {
    const auto log = unpack(row, 0);
    if (!log) fail("sitting " + std::to_string(sitting), "its log is damaged");
    logs.push_back(*log);
  }
  return logs;
}

void ResultsDatabase::take_out(std::int64_t sitting) {
  sqlite::Statement(connection_, "DELETE FROM sitting WHERE number = ?").bind(1, sitting).step();
  if (connection_.number("SELECT changes()") == 0) refuse_gone(file(), sitting);
}

void ResultsDatabase::remove(std::int64_t sitting) {
  sqlite::Transaction transaction(connection_);
  take_out(sitting);
  connection_.run(
      "DELETE FROM learner WHERE id NOT IN (SELECT learner FROM attempt) AND id NOT IN (SELECT learner FROM sitting)");
  transaction.commit();
}

}  // namespace insonate
