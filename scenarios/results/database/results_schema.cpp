#include "scenarios/results/database/results_schema.h"

#include <array>
#include <chrono>
#include <optional>
#include <thread>

#include "sim/core/input_error.h"

namespace insonate {
namespace {

/// "INSO": identifies the file's owner in its header (PRAGMA application_id).
constexpr std::int64_t kApplication = 0x494e534f;

/// The upgrades from each schema to the next. Only append to this list, never change it: databases of every version are
/// in use. docs/results.md explains the tables.
constexpr std::array kSteps{R"sql(
CREATE TABLE identity (
  id TEXT NOT NULL                      -- 32 random hexadecimal digits: tells this database from all others
) STRICT;
INSERT INTO identity VALUES (lower(hex(randomblob(16))));

CREATE TABLE learner (
  id TEXT PRIMARY KEY NOT NULL
) STRICT;

CREATE TABLE attempt (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  uuid TEXT NOT NULL UNIQUE,
  learner TEXT NOT NULL REFERENCES learner (id) ON DELETE CASCADE,
  finished_ms INTEGER NOT NULL,         -- since 1970 UTC
  title TEXT NOT NULL,                  -- title to passed: out of the score, for lists
  complete INTEGER NOT NULL,
  percent REAL NOT NULL,
  passed INTEGER NOT NULL,
  scenario_digest TEXT NOT NULL,
  scenario_file TEXT NOT NULL,
  scenario TEXT NOT NULL,
  patient TEXT NOT NULL,
  log_digest TEXT NOT NULL,
  log_size INTEGER NOT NULL,            -- in bytes, before zlib
  log BLOB NOT NULL,
  trace_size INTEGER NOT NULL,
  trace BLOB NOT NULL,
  score TEXT NOT NULL                   -- JSON
) STRICT;
CREATE INDEX attempt_by_learner ON attempt (learner, number);
)sql",
                            R"sql(
CREATE TABLE picture (
  attempt INTEGER NOT NULL REFERENCES attempt (number) ON DELETE CASCADE,
  step INTEGER NOT NULL,                -- from 0
  kind TEXT NOT NULL,                   -- 'best' or 'reference'
  png BLOB NOT NULL,
  PRIMARY KEY (attempt, step, kind)
) STRICT;
)sql",
                            R"sql(
CREATE TABLE sitting (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  learner TEXT NOT NULL REFERENCES learner (id) ON DELETE CASCADE,
  began_ms INTEGER NOT NULL,            -- since 1970 UTC
  title TEXT NOT NULL,
  scenario_digest TEXT NOT NULL,
  scenario_file TEXT NOT NULL,
  scenario TEXT NOT NULL,
  patient TEXT NOT NULL,
  seed INTEGER NOT NULL,
  UNIQUE (learner, scenario_digest)
) STRICT;

CREATE TABLE sitting_part (
  sitting INTEGER NOT NULL REFERENCES sitting (number) ON DELETE CASCADE,
  part INTEGER NOT NULL,                -- from 1
  kept_ms INTEGER NOT NULL,             -- since 1970 UTC
  log_size INTEGER NOT NULL,            -- in bytes, before zlib
  log BLOB NOT NULL,
  PRIMARY KEY (sitting, part)
) STRICT;
)sql",
                            R"sql(
-- Out of the score: 'exam', 'practice' or 'recording'; of attempts from before '', but for scores that name a log.
ALTER TABLE attempt ADD COLUMN mode TEXT NOT NULL DEFAULT '';
UPDATE attempt SET mode = 'recording' WHERE score GLOB '*"log": "[^"]*';
)sql",
                            R"sql(
CREATE TABLE comment (
  number INTEGER PRIMARY KEY AUTOINCREMENT,
  attempt INTEGER NOT NULL REFERENCES attempt (number) ON DELETE CASCADE,
  author TEXT NOT NULL,                 -- an opaque id, as a learner's; '' for none
  written_ms INTEGER NOT NULL,          -- since 1970 UTC
  text TEXT NOT NULL
) STRICT;
CREATE INDEX comment_by_attempt ON comment (attempt, number);
)sql"};

struct Header {
  std::int64_t application;
  std::int64_t schema;
  std::int64_t tables;
  std::int64_t programs;  ///< triggers and views
};

/// Reads a consistent header even if another process is creating the tables. The savepoint works inside and outside a
/// transaction.
Header header_of(sqlite::Connection& connection) {
  connection.run("SAVEPOINT header");
  const Header header{connection.number("PRAGMA application_id"), connection.number("PRAGMA user_version"),
                      connection.number("SELECT count(*) FROM sqlite_schema"),
                      connection.number("SELECT count(*) FROM sqlite_schema WHERE type IN ('trigger', 'view')")};
  connection.run("RELEASE header");
  return header;
}

/// Returns true if the tables must be created or upgraded.
bool behind(sqlite::Connection& connection, bool make, int schema) {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    throw InputError(connection.file().string(), "", problem, remedy);
  };
  const Header header = header_of(connection);
  if (header.application == 0 && header.schema == 0 && header.tables == 0) {
    if (!make) refuse("there are no results in it", "name a database that the trainer has written");
    return true;
  }
  if (header.application != kApplication)
    refuse("this is the database of another program", "name one that the trainer has written");
  if (header.schema > newest_results_schema())
    refuse("its schema is " + std::to_string(header.schema) + ", and this program knows them up to " +
               std::to_string(newest_results_schema()),
           "use the newer version of Insonate that wrote it");
  if (header.schema < 1 || header.tables == 0 || header.programs > 0)
    refuse("its tables are not those of results", "go back to a copy of it from before");
  return header.schema < schema;
}

/// Lets readers continue while another process writes. The file stores this mode. Until it does, two processes may set
/// it at once, and SQLite does not wait for the other one here.
void use_write_ahead_log(sqlite::Connection& connection) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::milliseconds(sqlite::Connection::kPatience_ms);
  std::optional<std::string> mode;
  while (!mode) {
    try {
      mode = connection.text("PRAGMA journal_mode = WAL");
    } catch (const InputError&) {
      if (std::chrono::steady_clock::now() > give_up) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  // Interference from another process makes SQLite fail. A different mode in the answer is final.
  if (mode != "wal")
    throw InputError(connection.file().string(), "", "its folder does not allow a write-ahead log",
                     "keep the database on a disk of this computer, not on the network");
}

}  // namespace

int newest_results_schema() {
  return int(kSteps.size());
}

void bring_up_to_date(sqlite::Connection& connection, bool make, int schema) {
  if (!behind(connection, make, schema)) return;
  use_write_ahead_log(connection);
  sqlite::Transaction transaction(connection);
  if (!behind(connection, make, schema)) return;  // another process did it first
  for (std::int64_t step = connection.number("PRAGMA user_version"); step < schema; ++step)
    connection.run(kSteps[std::size_t(step)]);
  connection.run("PRAGMA application_id = " + std::to_string(kApplication));
  connection.run("PRAGMA user_version = " + std::to_string(schema));
  transaction.commit();
}

}  // namespace insonate
