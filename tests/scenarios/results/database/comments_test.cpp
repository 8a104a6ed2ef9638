#include <catch2/catch.hpp>

#include "scenarios/results/database/results_database.h"
#include "sim/core/input_error.h"
#include "tests/scenarios/results/made_attempt.h"

using namespace insonate;

namespace {

Comment comment_on(std::int64_t attempt, const std::string& text, const std::string& author = "") {
  Comment comment;
  comment.attempt = attempt;
  comment.author = author;
  comment.written_ms = 1'795'284'309'250;
  comment.text = text;
  return comment;
}

std::string times(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

}  // namespace

TEST_CASE("comments are stored with their attempt, and removed, and the attempt stays as it is") {
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  for (const char* learner : {"L-01", "L-02"}) {
    Attempt attempt = made_attempt(learner, tiny_exam(0), std::string("bytes\0\xff", 7));
    database.add(attempt);
  }
  const Attempt before = database.read(1);
  CHECK(before.comments.empty());
  Comment first = comment_on(1, "Slow down: \u201cribs\u201d, 5 \u00b0 \U0001f600", "T-02"), other = comment_on(2, "x"),
          second = comment_on(1, "'; DROP TABLE attempt; --");
  for (Comment* comment : {&first, &other, &second}) database.add(*comment);
  CHECK(first.number == 1);
  CHECK(second.number == 3);

  ResultsDatabase again = ResultsDatabase::open(folder / "results.db");
  const Attempt after = again.read(1);
  REQUIRE(after.comments.size() == 2);
  CHECK(after.comments[0].number == 1);
  CHECK(after.comments[0].attempt == 1);
  CHECK(after.comments[0].author == "T-02");
  CHECK(after.comments[0].written_ms == first.written_ms);
  CHECK(after.comments[0].text == first.text);
  CHECK(after.comments[1].author.empty());
  CHECK(after.comments[1].text == second.text);
  CHECK(after.log == before.log);
  CHECK(after.score_json == before.score_json);
  CHECK(after.trace_json == before.trace_json);
  CHECK(after.uuid == before.uuid);
  CHECK(again.comments().size() == 3);
  CHECK(again.comments(2).size() == 1);
  CHECK(again.read_score(1).score_json == before.score_json);
  CHECK(again.read_score(1).log.empty());
  again.check();

  again.remove_comment(1);
  CHECK(again.comments(1).size() == 1);
  CHECK_THROWS_WITH(again.remove_comment(1), Catch::Contains("there is no comment 1; list them"));
  Comment next = comment_on(1, "next");
  again.add(next);
  CHECK(next.number == 4);  // never used twice

  INFO("a learner's comments go with the learner");
  sqlite::Connection connection(folder / "results.db", false);
  connection.run("PRAGMA foreign_keys = ON; DELETE FROM learner WHERE id = 'L-01'");
  CHECK(again.comments().size() == 1);
  again.check();
}

TEST_CASE("a comment is one paragraph of UTF-8 by nobody or an opaque id") {
  for (const std::string& good :
       {std::string("a"), std::string(" a"), std::string("caf\u00e9 \u2013 \u4e2d \U0001f600"), times(2000, "\u00e9"),
        std::string("\u00a0x"), std::string("\U0010ffff")})
    CHECK(why_no_comment(good).empty());
  const std::pair<std::string, const char*> bad[] = {
      {"", "is empty"},
      {"   ", "is empty"},
      {"a\nb", "character 2 of the comment is a line break"},
      {"\u00e9\r", "character 2 of the comment is a line break"},
      {"ab\t", "character 3 of the comment is a control character"},
      {std::string("a\0", 2), "is a control character"},
      {"\x1b[2J", "character 1 of the comment is a control character"},
      {"\x7f", "is a control character"},
      {"\u0085", "is a control character"},
      {"a\xff", "character 2 of the comment is not UTF-8"},
      {"\xc3", "is not UTF-8"},
      {"\xe2\x82", "is not UTF-8"},
      {"\xc0\xaf", "is not UTF-8"},
      {"\xe0\x80\xaf", "is not UTF-8"},
      {"\xed\xa0\x80", "is not UTF-8"},
      {"\xf4\x90\x80\x80", "is not UTF-8"},
      {"\x80", "is not UTF-8"},
      {times(2001, "x"), "has 2001 characters, above the limit of 2000"}};
  const ResultsFolder folder;
  ResultsDatabase database = ResultsDatabase::open_or_make(folder / "results.db");
  Attempt attempt = made_attempt("L-01", tiny_exam(0));
  database.add(attempt);
  for (const auto& [text, words] : bad) {
    Comment comment = comment_on(1, text);
    CHECK_THROWS_WITH(database.add(comment), Catch::Contains(words));
    CHECK(comment.number == 0);
  }
  Comment named = comment_on(1, "x", "Ada Lovelace");
  CHECK_THROWS_WITH(database.add(named), Catch::Contains("author: 'Ada Lovelace' is not an id"));
  Comment lost = comment_on(7, "x");
  CHECK_THROWS_WITH(database.add(lost), Catch::Contains("there is no attempt 7"));
  CHECK(database.comments().empty());
}
