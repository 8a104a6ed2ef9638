// The database of results: opened, checked, listed and read as insonate-score does.
#include "scenarios/result_json.h"
#include "scenarios/results/database/results_database.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

const Target database_target("database", [](std::string_view bytes) -> std::string {
  const std::filesystem::path file = file_with("results.db", bytes);
  for (const char* beside : {"-wal", "-shm", "-journal"}) std::filesystem::remove(file.string() + beside);
  ResultsDatabase database = ResultsDatabase::open(file);
  database.identity();
  const std::size_t attempts = database.attempts().size();
  std::size_t by_learner = 0;
  for (const LearnerSummary& learner : database.learners()) by_learner += std::size_t(learner.attempts);
  if (by_learner != attempts) return "the learners' attempts are not all attempts";
  for (const AttemptSummary& summary : database.attempts()) {
    const std::string broken = broken_by([&]() -> std::string {
      const Attempt attempt = database.read(summary.number);
      result_from_json(attempt.score_json, "score");
      return attempt.number == summary.number ? "" : "another attempt was read than the one asked for";
    });
    if (!broken.empty()) return broken;
  }
  for (const Comment& comment : database.comments())
    for (const Comment& on_attempt : database.comments(comment.attempt))
      if (on_attempt.attempt != comment.attempt) return "a comment on another attempt was read";
  for (const Sitting& sitting : database.sittings()) database.parts(sitting.number);
  database.check();
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
