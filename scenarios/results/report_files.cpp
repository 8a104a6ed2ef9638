#include "scenarios/results/report_files.h"

#include <algorithm>
#include <system_error>

#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/results/score_csv.h"
#include "scenarios/results/trace_json.h"
#include "scenarios/results/xapi.h"
#include "sim/core/files.h"

namespace insonate {

std::filesystem::path attempt_folder(const std::filesystem::path& folder, const Attempt& attempt) {
  const std::filesystem::path scenario = std::filesystem::path(attempt.scenario_file).stem();
  return free_path(folder / "attempts" / (file_time(attempt.finished_ms) + "_" + scenario.string()));
}

ResultFiles write_report_files(const std::filesystem::path& folder, const Attempt& attempt,
                               const std::string& home_page) {
  const bool kept = attempt.number > 0;
  const std::string name = kept ? "attempt " + std::to_string(attempt.number) : "the attempt";
  const ExamResult result = result_from_json(attempt.score_json, name);
  ReportSubject subject;
  if (kept) {
    subject.learner = attempt.learner;
    subject.attempt = std::to_string(attempt.number);
    const std::string finished = utc_time(attempt.finished_ms);  // shown to the minute
    subject.finished = finished.substr(0, 10) + " " + finished.substr(11, 5) + " UTC";
  }
  subject.pictures = attempt.pictures;

  const ResultFiles files{folder / "report.html", folder / "score.json", folder / "score.csv",
                          kept ? folder / "xapi.json" : std::filesystem::path()};
  write_file(files.report, report_html(result, trace_from_json(attempt.trace_json, name), subject));
  write_file(files.score, attempt.score_json);
  write_file(files.table, score_csv(attempt, result));
  if (kept) {
    write_file(files.statements, xapi_statements(attempt, result, home_page));
  } else {
    std::error_code none;
    std::filesystem::remove(folder / "xapi.json", none);  // may be left from another attempt
  }
  return files;
}

std::vector<std::filesystem::path> ResultFiles::all() const {
  std::vector<std::filesystem::path> files{report, score, table};
  if (!statements.empty()) files.push_back(statements);
  return files;
}

}  // namespace insonate
