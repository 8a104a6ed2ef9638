#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "scenarios/results/database/results_database.h"
#include "scenarios/words.h"
#include "sim/core/input_error.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct Listed {
  std::filesystem::path database;
  std::string learner;
  std::string mode;  ///< empty: any
};

/// Seconds suffice; more digits would only widen the list.
std::string shown_time(std::int64_t since_1970_ms) {
  return utc_time(since_1970_ms).substr(0, 19) + "Z";
}

int list_attempts(const Listed& given) {
  ResultsDatabase database = ResultsDatabase::open(given.database);
  const auto mode = find_attempt_mode(given.mode);
  std::printf("%7s  %-20s  %-20s  %-9s  %-10s %9s  %-16s  %s\n", "attempt", "learner", "finished", "mode", "",
              "percent", "digest", "scenario");
  std::set<std::int64_t> shown;
  for (const AttemptSummary& a : database.attempts())
    if ((given.learner.empty() || a.learner == given.learner) && (!mode || is_of(a.mode, *mode))) {
      shown.insert(a.number);
      std::printf("%7lld  %-20s  %-20s  %-9s  %-10s %9.2f  %-16s  %s\n", static_cast<long long>(a.number),
                  a.learner.c_str(), shown_time(a.finished_ms).c_str(), name_of(a.mode).c_str(),
                  a.passed ? "passed" : "not passed", a.percent, a.scenario_digest.c_str(), a.title.c_str());
    }
  for (const Comment& comment : database.comments())
    if (shown.contains(comment.attempt))
      std::printf("comment %lld on attempt %lld%s, %s: %s\n", static_cast<long long>(comment.number),
                  static_cast<long long>(comment.attempt),
                  comment.author.empty() ? "" : (" by " + in_one_line(comment.author)).c_str(),
                  shown_time(comment.written_ms).c_str(), in_one_line(comment.text).c_str());
  if (mode && mode != AttemptMode::exam) return 0;
  for (const Sitting& s : database.sittings())
    if (given.learner.empty() || s.learner == given.learner)
      std::printf("sitting %lld of %s, begun %s, is not handed in: %s\n", static_cast<long long>(s.number),
                  s.learner.c_str(), shown_time(s.began_ms).c_str(), s.title.c_str());
  return 0;
}

/// `passed` and `best` cover graded exams only.
int list_learners(const Listed& given) {
  std::printf("%-20s  %8s  %5s  %6s  %12s  %s\n", "learner", "attempts", "exams", "passed", "best percent",
              "last attempt");
  for (const LearnerSummary& l : ResultsDatabase::open(given.database).learners())
    std::printf("%-20s  %8d  %5d  %6d  %12s  %s\n", l.id.c_str(), l.attempts, l.exams, l.passed,
                l.best_percent ? fixed(*l.best_percent, 2).c_str() : "", shown_time(l.last_ms).c_str());
  return 0;
}

}  // namespace

void add_list_commands(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<Listed>();
  CLI::App* attempts =
      arguments.add_subcommand("attempts", "List the attempts in a database of results, and the comments on them");
  attempts->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  attempts->add_option("--learner", given->learner, "List only the attempts of this learner")->type_name("ID");
  add_mode_option(*attempts, given->mode,
                  "List only attempts of this mode: exams that counted, practice, or recorded scans");
  attempts->callback([given, &run] { run = [given] { return list_attempts(*given); }; });

  CLI::App* learners = arguments.add_subcommand(
      "learners", "List the learners in a database of results, with their attempts, exams, passed exams and best exam");
  learners->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  learners->callback([given, &run] { run = [given] { return list_learners(*given); }; });
}

}  // namespace insonate
