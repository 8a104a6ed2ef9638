#include "scenarios/results/export/results_export.h"

#include <algorithm>
#include <map>
#include <optional>

#include "scenarios/result_json.h"
#include "scenarios/results/export/csv.h"
#include "scenarios/results/export/score_csv.h"
#include "sim/core/input_error.h"
#include "sim/files/files.h"
#include "sim/files/new_folder.h"

namespace insonate {
namespace {

const char* yes_or_no(bool value) {
  return value ? "1" : "0";
}

std::string learners_csv(const std::vector<LearnerSummary>& learners) {
  std::string csv = "learner,attempts,exams,passed,best_percent,last_finished\r\n";
  for (const LearnerSummary& learner : learners)
    csv += csv::row({csv::text(learner.id), std::to_string(learner.attempts), std::to_string(learner.exams),
                     std::to_string(learner.passed), learner.best_percent ? csv::number(*learner.best_percent) : "",
                     utc_time(learner.last_ms)});
  return csv;
}

std::string comments_csv(const std::vector<Comment>& comments, const std::map<std::int64_t, std::string>& learner_of) {
  std::string csv = "comment,attempt,learner,author,written,text\r\n";
  for (const Comment& comment : comments)
    if (const auto learner = learner_of.find(comment.attempt); learner != learner_of.end())
      csv += csv::row({std::to_string(comment.number), std::to_string(comment.attempt), csv::text(learner->second),
                       csv::text(comment.author), utc_time(comment.written_ms), csv::text(comment.text)});
  return csv;
}

constexpr const char* kAttemptsHead =
    "attempt,learner,finished,mode,exam,exam_digest,percent,passed,complete,comments,uuid,seed,variant,"
    "pass_mark_percent,points,points_possible,time_s,hints,points_lost_to_hints,guide_times,guide_s,log,"
    "scoring_version,program_version\r\n";

/// Returns the row of an attempt.
/// @param result  empty if the score cannot be read
std::string attempt_row(const AttemptSummary& attempt, std::size_t comments, const std::string& uuid,
                        const std::optional<ExamResult>& result) {
  std::vector<std::string> cells{std::to_string(attempt.number),
                                 csv::text(attempt.learner),
                                 utc_time(attempt.finished_ms),
                                 name_of(attempt.mode),
                                 csv::text(attempt.title),
                                 csv::text(attempt.scenario_digest),
                                 csv::number(attempt.percent),
                                 yes_or_no(attempt.passed),
                                 yes_or_no(attempt.complete),
                                 std::to_string(comments),
                                 csv::text(uuid)};
  if (!result) {
    const auto columns = std::size_t(std::count(kAttemptsHead, kAttemptsHead + std::string(kAttemptsHead).size(), ','));
    cells.resize(columns + 1);
    return csv::row(cells);
  }
  int hints = 0, guide_times = 0;
  double lost = 0, guide_s = 0;
  for (const StepResult& step : result->steps) {
    hints += step.hints_taken;
    lost += step.lost_to_hints();
    guide_times += step.guide_times;
    guide_s += step.guide_s;
  }
  for (const std::string& cell :
       {std::to_string(result->provenance.seed), csv::text(result->provenance.variant),
        csv::number(result->pass_mark_percent), csv::number(result->points), csv::number(result->points_possible),
        csv::number(result->motion.time_s), std::to_string(hints), csv::number(lost), std::to_string(guide_times),
        csv::number(guide_s), csv::text(result->provenance.log), std::to_string(result->provenance.scoring_version),
        csv::text(result->provenance.program_version)})
    cells.push_back(cell);
  return csv::row(cells);
}

}  // namespace

ExportedResults export_results(ResultsDatabase& database, const std::filesystem::path& folder) {
  refuse_taken(folder);
  const std::vector<AttemptSummary> attempts = database.attempts();
  const std::vector<Comment> comments = database.comments();
  std::map<std::int64_t, std::string> learner_of;
  std::map<std::int64_t, std::size_t> comments_on;
  for (const AttemptSummary& attempt : attempts) learner_of[attempt.number] = attempt.learner;
  for (const Comment& comment : comments) ++comments_on[comment.attempt];

  ExportedResults exported;
  std::string attempts_csv = kAttemptsHead, scores_csv = score_csv_head();
  for (const AttemptSummary& summary : attempts) {
    std::string uuid;
    std::optional<ExamResult> result;
    try {
      const std::string name = database.file().string() + ": attempt " + std::to_string(summary.number);
      const Attempt attempt = database.read_score(summary.number);
      uuid = attempt.uuid;
      result = result_from_json(attempt.score_json, name);
      scores_csv += score_csv_rows(attempt, *result);
    } catch (const InputError& error) {
      exported.problems.emplace_back(error.what());
    }
    attempts_csv += attempt_row(summary, comments_on[summary.number], uuid, result);
  }
  write_folder(folder, [&](const std::filesystem::path& made) {
    write_file(made / "learners.csv", learners_csv(learners_of(attempts)));
    write_file(made / "attempts.csv", attempts_csv);
    write_file(made / "scores.csv", scores_csv);
    write_file(made / "comments.csv", comments_csv(comments, learner_of));
  });
  for (const char* name : {"learners.csv", "attempts.csv", "scores.csv", "comments.csv"})
    exported.files.push_back(folder / name);
  return exported;
}

}  // namespace insonate
