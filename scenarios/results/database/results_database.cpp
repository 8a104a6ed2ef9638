#include "scenarios/results/database/results_database.h"

#include <algorithm>
#include <array>
#include <map>

#include "scenarios/result_json.h"
#include "scenarios/results/database/compression.h"
#include "scenarios/results/database/packed_column.h"
#include "scenarios/results/database/results_schema.h"
#include "scenarios/results/learner_id.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"

namespace insonate {
namespace {

namespace fs = std::filesystem;

/// Returns `file` after creating its folder, which SQLite does not do.
const fs::path& with_folder(const fs::path& file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error)
    throw InputError(file.parent_path().string(), "", "the folder cannot be made (" + error.message() + ")",
                     "name a folder that may be written");
  return file;
}

const fs::path& existing(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError(file.string(), "", "there is no such file", "check the name");
  if (!fs::is_regular_file(file, error)) throw InputError(file.string(), "", "this is not a file", "name a database");
  return file;
}

constexpr const char* kScoreColumns =
    "uuid, learner, finished_ms, scenario, scenario_file, patient, score, scenario_digest";

struct PictureKindName {
  ReportPicture::Kind kind;
  const char* name;
};
constexpr std::array kPictureKinds{PictureKindName{ReportPicture::Kind::best, "best"},
                                   PictureKindName{ReportPicture::Kind::reference, "reference"}};

/// Returns a random UUID (RFC 4122, version 4) from 32 random hexadecimal digits.
std::string as_uuid(std::string digits) {
  digits[12] = '4';
  digits[16] = "89ab"[std::size_t(digits[16]) % 4];
  for (const std::size_t at : {20, 16, 12, 8}) digits.insert(at, "-");
  return digits;
}

}  // namespace

ResultsDatabase::ResultsDatabase(const fs::path& file, bool make) : connection_(file, make) {
  connection_.run("PRAGMA foreign_keys = ON");
  connection_.run("PRAGMA synchronous = FULL");
  connection_.run("PRAGMA secure_delete = ON");
  bring_up_to_date(connection_, make);
}

ResultsDatabase ResultsDatabase::open(const fs::path& file) {
  return {existing(file), false};
}

ResultsDatabase ResultsDatabase::open_or_make(const fs::path& file) {
  return {with_folder(file), true};
}

void ResultsDatabase::add(Attempt& attempt, std::int64_t sitting) {
  check_learner_id(attempt.learner, connection_.file().string(), "learner");
  const ExamResult result = result_from_json(attempt.score_json, connection_.file().string());
  const std::string log = compressed(attempt.log), trace = compressed(attempt.trace_json);

  sqlite::Transaction transaction(connection_);
  const std::string uuid = as_uuid(connection_.text("SELECT lower(hex(randomblob(16)))"));
  sqlite::Statement(connection_, "INSERT INTO learner VALUES (?) ON CONFLICT DO NOTHING")
      .bind(1, attempt.learner)
      .step();
  sqlite::Statement insert(connection_,
                           "INSERT INTO attempt (uuid, learner, finished_ms, title, complete, percent, passed, "
                           "scenario_digest, scenario_file, scenario, patient, log_digest, log_size, log, trace_size, "
                           "trace, score, mode) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, uuid).bind(2, attempt.learner).bind(3, attempt.finished_ms);
  insert.bind(4, result.title).bind(5, std::int64_t(result.complete)).bind(6, result.percent);
  insert.bind(7, std::int64_t(result.passed));
  insert.bind(8, digest_of(attempt.scenario_text)).bind(9, attempt.scenario_file).bind(10, attempt.scenario_text);
  insert.bind(11, attempt.patient);
  insert.bind(12, digest_of(attempt.log)).bind(13, std::int64_t(attempt.log.size())).bind_bytes(14, log);
  insert.bind(15, std::int64_t(attempt.trace_json.size())).bind_bytes(16, trace).bind(17, attempt.score_json);
  insert.bind(18, name_of(result.provenance.mode));
  insert.step();
  const std::int64_t number = connection_.last_row();
  for (const ReportPicture& picture : attempt.pictures)
    for (const PictureKindName& kind : kPictureKinds)
      if (kind.kind == picture.kind)
        sqlite::Statement(connection_, "INSERT INTO picture VALUES (?, ?, ?, ?)")
            .bind(1, number)
            .bind(2, std::int64_t(picture.step))
            .bind(3, kind.name)
            .bind_bytes(4, picture.png)
            .step();
  if (sitting != 0) take_out(sitting);
  const std::string identity = this->identity();
  transaction.commit();
  attempt.database = identity;
  attempt.uuid = uuid;
  attempt.number = number;
}

Attempt ResultsDatabase::read_score(std::int64_t number) {
  sqlite::Statement row(connection_, std::string("SELECT ") + kScoreColumns + " FROM attempt WHERE number = ?");
  return read_score(row, number);
}

/// Steps to the row, whose first columns are kScoreColumns.
Attempt ResultsDatabase::read_score(sqlite::Statement& row, std::int64_t number) {
  if (!row.bind(1, number).step()) refuse_missing(number);
  Attempt attempt;
  attempt.number = number;
  attempt.uuid = row.text(0);
  attempt.learner = row.text(1);
  attempt.finished_ms = row.integer(2);
  attempt.scenario_text = row.text(3);
  attempt.scenario_file = row.text(4);
  attempt.patient = row.text(5);
  attempt.score_json = row.text(6);
  if (digest_of(attempt.scenario_text) != row.text(7))
    fail("attempt " + std::to_string(number), "its scenario is damaged");
  attempt.database = identity();
  return attempt;
}

Attempt ResultsDatabase::read(std::int64_t number) {
  // One statement, because another process may remove the attempt between two.
  sqlite::Statement row(connection_,
                        std::string("SELECT ") + kScoreColumns +
                            ", log_digest, log_size, log, trace_size, trace FROM attempt WHERE number = ?");
  Attempt attempt = read_score(row, number);
  const std::string place = "attempt " + std::to_string(number);
  const auto unpacked = [&](int size_column, const char* what) {
    const auto bytes = unpack(row, size_column);
    if (!bytes) fail(place, std::string("its ") + what + " is damaged");
    return *bytes;
  };
  attempt.log = unpacked(9, "log");
  attempt.trace_json = unpacked(11, "trace");
  if (digest_of(attempt.log) != row.text(8)) fail(place, "its log is damaged");

  sqlite::Statement picture(connection_, "SELECT step, kind, png FROM picture WHERE attempt = ? ORDER BY step, kind");
  picture.bind(1, number);
  while (picture.step()) {
    const std::string name = picture.text(1);
    const auto kind = std::find_if(kPictureKinds.begin(), kPictureKinds.end(),
                                   [&](const PictureKindName& k) { return k.name == name; });
    if (kind == kPictureKinds.end() || picture.integer(0) < 0) fail(place, "its pictures are damaged");
    attempt.pictures.push_back({std::size_t(picture.integer(0)), kind->kind, picture.bytes(2)});
  }
  attempt.comments = comments(number);
  return attempt;
}

std::vector<AttemptSummary> ResultsDatabase::attempts() {
  std::vector<AttemptSummary> list;
  sqlite::Statement row(connection_,
                        "SELECT number, learner, mode, finished_ms, title, scenario_digest, complete, percent, passed "
                        "FROM attempt ORDER BY number");
  while (row.step())
    list.push_back({row.integer(0), row.text(1), find_attempt_mode(row.text(2)), row.integer(3), row.text(4),
                    row.text(5), row.integer(6) != 0, row.real(7), row.integer(8) != 0});
  return list;
}

std::vector<LearnerSummary> ResultsDatabase::learners() {
  return learners_of(attempts());
}

std::vector<LearnerSummary> learners_of(const std::vector<AttemptSummary>& attempts) {
  std::map<std::string, LearnerSummary> by_id;
  for (const AttemptSummary& attempt : attempts) {
    LearnerSummary& learner = by_id[attempt.learner];
    learner.id = attempt.learner;
    ++learner.attempts;
    learner.last_ms = std::max(learner.last_ms, attempt.finished_ms);
    if (!is_of(attempt.mode, AttemptMode::exam)) continue;
    ++learner.exams;
    learner.passed += attempt.passed ? 1 : 0;
    learner.best_percent = std::max(learner.best_percent.value_or(0), attempt.percent);
  }
  std::vector<LearnerSummary> list;
  for (const auto& [id, learner] : by_id) list.push_back(learner);
  return list;
}

std::string ResultsDatabase::identity() {
  return connection_.text("SELECT id FROM identity");
}

void ResultsDatabase::check() {
  const std::string verdict = connection_.text("PRAGMA integrity_check(1)");
  const bool orphans = sqlite::Statement(connection_, "PRAGMA foreign_key_check").step();
  if (verdict != "ok" || orphans)
    throw InputError(connection_.file().string(), "",
                     "the database is damaged (" + (orphans ? "a row without what it belongs to" : verdict) + ")",
                     "go back to a copy of it from before");
  for (const AttemptSummary& attempt : attempts()) read(attempt.number);
  for (const Comment& comment : comments())
    if (!why_no_comment(comment.text).empty() || !(comment.author.empty() || why_no_learner_id(comment.author).empty()))
      fail("comment " + std::to_string(comment.number), "it is damaged");
  for (const Sitting& sitting : sittings()) {
    if (digest_of(sitting.scenario_text) != sitting.scenario_digest)
      fail("sitting " + std::to_string(sitting.number), "its scenario is damaged");
    parts(sitting.number);
  }
}

void ResultsDatabase::refuse_missing(std::int64_t attempt) const {
  throw InputError(connection_.file().string(), "", "there is no attempt " + std::to_string(attempt),
                   "list them with 'insonate-score attempts'");
}

void ResultsDatabase::fail(const std::string& place, const std::string& problem) const {
  throw InputError(connection_.file().string(), place, problem, "go back to a copy of the database from before");
}

}  // namespace insonate
