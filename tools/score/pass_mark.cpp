#include "scenarios/results/pass_mark.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>

#include "scenarios/results/roster.h"
#include "sim/core/input_error.h"
#include "sim/files/digest.h"
#include "sim/files/files.h"
#include "tools/score/commands.h"

namespace insonate {
namespace {

struct PassMarkRequest {
  std::filesystem::path database;
  std::filesystem::path novices;
  std::filesystem::path experts;
  std::filesystem::path scenario;
  std::string mode{name_of(AttemptMode::exam)};
};

using Ids = std::set<std::string>;

Ids ids_of(const std::filesystem::path& roster) {
  const std::vector<std::string> ids = read_roster(roster);
  return {ids.begin(), ids.end()};
}

/// Returns the digest of the exam: of the named scenario, or of the only one that the two groups took.
std::string exam_of(const PassMarkRequest& given, const std::vector<AttemptSummary>& attempts, const Ids& novices,
                    const Ids& experts) {
  if (!given.scenario.empty()) return digest_of(read_file(given.scenario));
  std::set<std::string> digests;
  for (const AttemptSummary& attempt : attempts)
    if (novices.contains(attempt.learner) || experts.contains(attempt.learner)) digests.insert(attempt.scenario_digest);
  if (digests.size() > 1)
    throw InputError(given.database.string(), "",
                     "the two groups took " + std::to_string(digests.size()) + " different scenarios",
                     "name the one to set a mark for with --scenario FILE");
  return digests.empty() ? "" : *digests.begin();
}

/// Returns the score of the first complete attempt of each learner in a group. Later attempts show practised people.
std::vector<double> first_scores(const std::vector<AttemptSummary>& attempts, const std::string& exam, Ids group) {
  std::vector<double> scores;
  for (const AttemptSummary& attempt : attempts)
    if (attempt.complete && attempt.scenario_digest == exam && group.erase(attempt.learner) > 0)
      scores.push_back(attempt.percent);
  return scores;
}

void print_group(const char* name, const GroupScores& scores, std::size_t listed) {
  std::printf("%s: %d of %zu took it, mean %.2f %%, standard deviation %.2f %%\n", name, scores.count, listed,
              scores.mean, scores.deviation);
}

void print_misjudged(const char* name, const Misjudged& share) {
  std::printf("%s: %.1f %% observed, %.1f %% by the normal\n", name, share.observed_percent, share.theoretical_percent);
}

/// Returns the attempts of one mode. People with help, or in their third attempt, score differently than in an exam.
std::vector<AttemptSummary> attempts_of(ResultsDatabase database, AttemptMode mode) {
  std::vector<AttemptSummary> attempts = database.attempts();
  std::erase_if(attempts, [&](const AttemptSummary& attempt) { return !is_of(attempt.mode, mode); });
  return attempts;
}

int pass_mark(const PassMarkRequest& given) {
  const Ids novices = ids_of(given.novices), experts = ids_of(given.experts);
  for (const std::string& id : novices)
    if (experts.contains(id))
      throw InputError(given.experts.string(), "", "'" + id + "' is a novice as well",
                       "let each learner be in one list");
  const std::vector<AttemptSummary> attempts =
      attempts_of(ResultsDatabase::open(given.database), find_attempt_mode(given.mode).value());
  const std::string exam = exam_of(given, attempts, novices, experts);
  try {
    const PassMark mark =
        contrasting_groups(first_scores(attempts, exam, novices), first_scores(attempts, exam, experts));
    std::printf("pass mark: %.2f %%\n", mark.percent);
    print_group("novices", mark.novices, novices.size());
    print_group("experts", mark.experts, experts.size());
    print_misjudged("false passes", mark.false_passes);
    print_misjudged("false fails", mark.false_fails);
  } catch (const std::domain_error& error) {
    throw InputError(given.database.string(), "", error.what(),
                     "let more learners of both groups take the exam, or count other attempts with --mode");
  }
  return 0;
}

}  // namespace

void add_pass_mark_command(CLI::App& arguments, CommandRun& run) {
  const auto given = std::make_shared<PassMarkRequest>();
  CLI::App* command =
      arguments.add_subcommand("pass-mark",
                               "Find a lab's own pass mark for an exam by contrasting groups: the score at which the "
                               "normal distributions of novices and of experts cross. The first complete attempt of "
                               "each learner counts");
  command->add_option("DATABASE", given->database, "Use this database of results")->type_name("FILE")->required();
  command
      ->add_option("--novices", given->novices,
                   "Read the novices' ids from this file: CSV with the header 'learner', or TOML")
      ->type_name("FILE")
      ->required();
  command->add_option("--experts", given->experts, "Read the experts' ids from this file, in the same form")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--scenario", given->scenario,
                   "Use the attempts at this scenario file, if the groups took several; the file must be unchanged")
      ->type_name("FILE");
  add_mode_option(*command, given->mode, "Count attempts of this mode: exams, practice, or recorded scans")
      ->capture_default_str();
  command->callback([given, &run] { run = [given] { return pass_mark(*given); }; });
}

}  // namespace insonate
