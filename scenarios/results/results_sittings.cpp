// The database's exams that are not handed in yet.

#include "scenarios/results/compression.h"
#include "scenarios/results/learner_id.h"
#include "scenarios/results/packed_column.h"
#include "scenarios/results/results_database.h"
#include "sim/core/digest.h"
#include "sim/core/input_error.h"

namespace insonate {

void ResultsDatabase::begin(Sitting& sitting, std::string_view log) {
  check_learner_id(sitting.learner, file().string(), "learner");
  const std::string digest = digest_of(sitting.scenario_text);
  sqlite::Transaction transaction(connection_);
  for (const Sitting& other : sittings())
    if (other.learner == sitting.learner && digest_of(other.scenario_text) == digest)
      throw InputError(file().string(), "learner '" + sitting.learner + "'",
                       "this learner is taking the exam at another station, or it was broken off there",
                       "end it there, or hand in what there is of it with 'insonate-score hand-in'");
  sqlite::Statement(connection_, "INSERT INTO learner VALUES (?) ON CONFLICT DO NOTHING")
      .bind(1, sitting.learner)
      .step();
  sqlite::Statement insert(connection_,
                           "INSERT INTO sitting (learner, began_ms, title, scenario_digest, scenario_file, scenario, "
                           "patient, seed) VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, sitting.learner).bind(2, sitting.began_ms).bind(3, sitting.title).bind(4, digest);
  insert.bind(5, sitting.scenario_file).bind(6, sitting.scenario_text).bind(7, sitting.patient);
  insert.bind(8, std::int64_t(sitting.seed));
  insert.step();
  const std::int64_t number = connection_.last_row();
  insert_part(number, log, sitting.began_ms);
  transaction.commit();
  sitting.number = number;
  sitting.kept_ms = sitting.began_ms;
}

void ResultsDatabase::add_part(std::int64_t sitting, std::string_view log, std::int64_t now_ms) {
  sqlite::Transaction transaction(connection_);
  if (!sqlite::Statement(connection_, "SELECT 1 FROM sitting WHERE number = ?").bind(1, sitting).step())
    throw InputError(file().string(), "sitting " + std::to_string(sitting), "it has been handed in meanwhile",
                     "look at the attempts with 'insonate-score attempts'");
  insert_part(sitting, log, now_ms);
  transaction.commit();
}

void ResultsDatabase::insert_part(std::int64_t sitting, std::string_view log, std::int64_t now_ms) {
  sqlite::Statement insert(connection_,
                           "INSERT INTO sitting_part SELECT ?1, coalesce(max(part), 0) + 1, ?2, ?3, ?4 "
                           "FROM sitting_part WHERE sitting = ?1");
  insert.bind(1, sitting).bind(2, now_ms).bind(3, std::int64_t(log.size())).bind_bytes(4, compressed(log));
  insert.step();
}

std::vector<Sitting> ResultsDatabase::sittings() {
  std::vector<Sitting> list;
  sqlite::Statement row(connection_,
                        "SELECT number, learner, began_ms, max(kept_ms), title, scenario, scenario_file, patient, "
                        "scenario_digest, seed FROM sitting JOIN sitting_part ON sitting = number "
                        "GROUP BY number ORDER BY number");
  while (row.step()) {
    list.push_back({row.integer(0), row.text(1), row.integer(2), row.integer(3), row.text(4), row.text(5), row.text(6),
                    row.text(7), std::uint32_t(row.integer(9))});
    if (digest_of(list.back().scenario_text) != row.text(8))
      fail("sitting " + std::to_string(list.back().number), "its scenario is damaged");
  }
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

void ResultsDatabase::remove(std::int64_t sitting) {
  sqlite::Statement(connection_, "DELETE FROM sitting WHERE number = ?").bind(1, sitting).step();
}

}  // namespace insonate
