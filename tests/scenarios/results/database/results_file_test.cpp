#include <catch2/catch.hpp>
#include <sqlite3.h>

#include <fstream>

#include "scenarios/results/database/results_database.h"
#include "scenarios/results/database/results_schema.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "tests/core/system_faults.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

/// Statements as another program would run them.
void run_sql(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* handle = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &handle) == SQLITE_OK);
  char* error = nullptr;
  const int code = sqlite3_exec(handle, sql.c_str(), nullptr, nullptr, &error);
  INFO((error ? error : ""));
  CHECK(code == SQLITE_OK);
  sqlite3_free(error);
  sqlite3_close(handle);
}

/// Makes a database of results with one attempt.
void make(const std::filesystem::path& file) {
  Attempt attempt = made_attempt("L-01", tiny_exam(0), std::string(100'000, 'x'));
  ResultsDatabase::open_or_make(file).add(attempt);
}

void refused(const std::filesystem::path& file, const std::string& words) {
  for (const auto& opening : {ResultsDatabase::open, ResultsDatabase::open_or_make}) {
    try {
      opening(file).check();
      FAIL("not refused");
    } catch (const InputError& error) {
      INFO(error.what());
      const std::string said = error.what();
      CHECK(said.find(words) != std::string::npos);
      CHECK(said.find(file.string()) == 0);
      CHECK(said.find('\n') == std::string::npos);
    }
  }
}

}  // namespace

TEST_CASE("files that are not a database of results are refused and left as they are") {
  const ResultsFolder folder;
  write_file(folder / "text.db",
             "not a database, but longer than the header of one, which has a hundred bytes in all: "
             "0123456789 0123456789\n");
  write_file(folder / "short.db", "x");
  run_sql(folder / "foreign.db", "CREATE TABLE bookmarks (url TEXT)");
  make(folder / "newer.db");
  run_sql(folder / "newer.db", "PRAGMA user_version = 1000");
  const std::pair<const char*, const char*> files[] = {{"text.db", "not a database of results"},
                                                       {"short.db", "not a database of results"},
                                                       {"foreign.db", "of another program"},
                                                       {"newer.db", "its schema is 1000"}};
  for (const auto& [name, words] : files) {
    const std::string before = read_file(folder / name);
    refused(folder / name, words);
    CHECK(read_file(folder / name) == before);
  }
  refused(kShorterThanItClaims, "cannot be opened for writing");
  std::filesystem::create_directory(folder / "folder.db");
  refused(folder / "folder.db", "");
  write_file(folder / "file", "x");
  CHECK_THROWS_AS(ResultsDatabase::open_or_make(folder / "file" / "results.db"), InputError);
}

TEST_CASE("a missing and an empty file are not databases to read, but one to make") {
  const ResultsFolder folder;
  CHECK_THROWS_AS(ResultsDatabase::open(folder / "none.db"), InputError);
  CHECK_FALSE(std::filesystem::exists(folder / "none.db"));
  std::ofstream(folder / "empty.db").close();
  CHECK_THROWS_AS(ResultsDatabase::open(folder / "empty.db"), InputError);
  make(folder / "empty.db");
  CHECK(ResultsDatabase::open(folder / "empty.db").attempts().size() == 1);
}

TEST_CASE("a database where SQLite cannot keep a log beside it is refused") {
  sqlite::Connection in_memory(":memory:", true);
  CHECK_THROWS_WITH(bring_up_to_date(in_memory, true, newest_results_schema()),
                    ":memory:: its folder does not allow a write-ahead log; keep the database on a disk of this "
                    "computer, not on the network.");
}

TEST_CASE("a damaged database is refused in a sentence") {
  const ResultsFolder folder;
  make(folder / "results.db");
  const std::string whole = read_file(folder / "results.db");
  REQUIRE(whole.size() > 12'000);

  SECTION("cut off") {
    write_file(folder / "results.db", whole.substr(0, whole.size() / 2));
    refused(folder / "results.db", "damaged");
  }
  SECTION("pages overwritten") {
    for (std::size_t page = 4096; page + 4096 <= whole.size(); page += 4096) {
      std::string spoiled = whole;
      spoiled.replace(page, 4096, std::string(4096, '\xa5'));
      write_file(folder / "results.db", spoiled);
      CHECK_THROWS_AS(ResultsDatabase::open(folder / "results.db").check(), InputError);
    }
  }
  SECTION("tables missing") {
    run_sql(folder / "results.db", "DROP TABLE attempt");
    refused(folder / "results.db", "damaged");
  }
  SECTION("an attempt of nobody") {
    run_sql(folder / "results.db", "DELETE FROM learner");
    refused(folder / "results.db", "a row without what it belongs to");
  }
  SECTION("values changed") {
    const std::pair<const char*, const char*> changes[] = {
        {"log = x'00'", "its log is damaged"},
        {"log_size = 99999", "its log is damaged"},
        {"log_size = -1", "its log is damaged"},
        {"log_size = 9000000000000000000", "its log is damaged"},
        {"trace = zeroblob(1000)", "its trace is damaged"},
        {"scenario = scenario || ' '", "its scenario is damaged"},
        {"log_digest = ''", "its log is damaged"},
        {"percent = percent; UPDATE picture SET step = -1 - step", "its pictures are damaged"}};
    for (const auto& [change, words] : changes) {
      write_file(folder / "results.db", whole);
      run_sql(folder / "results.db", std::string("UPDATE attempt SET ") + change);
      refused(folder / "results.db", words);
    }
  }
  SECTION("an exam under way") {
    Sitting sitting;
    sitting.learner = "L-02";
    sitting.scenario_text = kTinyScenario;
    ResultsDatabase::open(folder / "results.db").begin(sitting, "the first part");
    run_sql(folder / "results.db", "UPDATE sitting_part SET log = x'00'");
    ResultsDatabase database = ResultsDatabase::open(folder / "results.db");
    CHECK_THROWS_WITH(database.parts(sitting.number), Catch::Contains("results.db: sitting 1: its log is damaged"));
    run_sql(folder / "results.db", "UPDATE sitting SET scenario = scenario || ' '");
    refused(folder / "results.db", "sitting 1: its scenario is damaged; go back to a copy");
  }
  SECTION("something that would run") {
    run_sql(folder / "results.db", "CREATE TRIGGER t AFTER INSERT ON attempt BEGIN UPDATE attempt SET passed = 1; END");
    refused(folder / "results.db", "not those of results");
  }
}

TEST_CASE("a database of the first schema is brought up to date and keeps its attempts") {
  const ResultsFolder folder;
  {
    sqlite::Connection old(folder / "old.db", true);
    bring_up_to_date(old, true, 1);
    old.run("INSERT INTO learner VALUES ('L-01')");
    old.run(
        "INSERT INTO attempt VALUES (5, 'uuid', 'L-01', 0, 'title', 1, 50, 0, '2d06800538d394c2', '', '', '', "
        "'2d06800538d394c2', 0, x'789c030000000001', 0, x'789c030000000001', '{}')");
    old.run(
        "INSERT INTO attempt SELECT 4, 'other', learner, 0, title, 1, 50, 0, scenario_digest, '', '', '', log_digest, "
        "0, "
        "log, 0, trace, '{\"log\": \"a.igs.mha\",\"log_digest\": \"\"}' FROM attempt");
    CHECK(old.number("PRAGMA user_version") == 1);
    CHECK_THROWS_AS(old.run("SELECT * FROM picture"), InputError);
  }
  ResultsDatabase database = ResultsDatabase::open(folder / "old.db");
  database.check();
  CHECK(database.read(5).learner == "L-01");
  CHECK(database.read(5).pictures.empty());
  CHECK(database.attempts()[0].mode == AttemptMode::recording);  // its score names a log
  CHECK(database.attempts()[1].mode == std::nullopt);
  Attempt next = made_attempt("L-02", tiny_exam(0));
  database.add(next);
  CHECK(next.number == 6);
  CHECK(database.read(6).pictures.size() == 3);
  CHECK(sqlite::Connection(folder / "old.db", false).number("PRAGMA user_version") == newest_results_schema());
}

TEST_CASE("a database without comments is brought up to date, keeps its bytes, and takes them") {
  const ResultsFolder folder;
  {
    sqlite::Connection old(folder / "old.db", true);
    bring_up_to_date(old, true, 4);
    old.run("INSERT INTO learner VALUES ('L-01')");
    old.run(
        "INSERT INTO attempt VALUES (5, 'uuid', 'L-01', 0, 'title', 1, 50, 0, '2d06800538d394c2', '', '', '', "
        "'2d06800538d394c2', 0, x'789c030000000001', 0, x'789c030000000001', '{}', 'practice')");
    CHECK(old.number("PRAGMA user_version") == 4);
    CHECK_THROWS_AS(old.run("SELECT * FROM comment"), InputError);
  }
  ResultsDatabase database = ResultsDatabase::open(folder / "old.db");
  database.check();
  CHECK(database.comments().empty());
  CHECK(database.attempts()[0].mode == AttemptMode::practice);
  Comment comment;
  comment.attempt = 5;
  comment.text = "Well held";
  database.add(comment);
  CHECK(database.read(5).comments.size() == 1);
  database.check();

  INFO("a comment that another program has spoiled is damage");
  run_sql(folder / "old.db", "UPDATE comment SET text = 'two' || char(10) || 'lines'");
  CHECK_THROWS_WITH(database.check(), Catch::Contains("old.db: comment 1: it is damaged"));
}
