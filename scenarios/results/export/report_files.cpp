#include "scenarios/results/export/report_files.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <system_error>

#include "scenarios/report/report.h"
#include "scenarios/result_json.h"
#include "scenarios/results/export/score_csv.h"
#include "scenarios/results/export/xapi.h"
#include "scenarios/results/trace_json.h"
#include "sim/files/files.h"

namespace insonate {
namespace {

/// Returns a time for people, to the minute.
std::string in_minutes(std::int64_t since_1970_ms) {
  const std::string time = utc_time(since_1970_ms);
  return time.substr(0, 10) + " " + time.substr(11, 5) + " UTC";
}

/// Returns the score with the comments as its last key. Without any it returns the score to the byte.
std::string with_comments(const Attempt& attempt) {
  if (attempt.comments.empty()) return attempt.score_json;
  using OrderedJson = nlohmann::ordered_json;
  OrderedJson score = OrderedJson::parse(attempt.score_json);
  OrderedJson& list = score["comments"] = OrderedJson::array();
  for (const Comment& comment : attempt.comments)
    list.push_back({{"comment", comment.number},
                    {"author", comment.author},
                    {"written", utc_time(comment.written_ms)},
                    {"text", comment.text}});
  // Another program may have written to the database. Invalid UTF-8 must not prevent the score from being written.
  return score.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::filesystem::path attempt_folder(const std::filesystem::path& folder, const Attempt& attempt) {
  const std::string scenario = std::filesystem::path(attempt.scenario_file).stem().string();
  const std::string name = file_time(attempt.finished_ms) + "_" + scenario;
  if (attempt.number > 0) return folder / "attempts" / (name + "_" + std::to_string(attempt.number));
  return free_path(folder / "attempts" / name, "");
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
    subject.finished = in_minutes(attempt.finished_ms);
  }
  subject.pictures = attempt.pictures;
  for (const Comment& comment : attempt.comments)
    subject.comments.push_back({comment.author, in_minutes(comment.written_ms), comment.text});

  const ResultFiles files{folder / "report.html", folder / "score.json", folder / "score.csv",
                          kept ? folder / "xapi.json" : std::filesystem::path()};
  write_file(files.report, report_html(result, trace_from_json(attempt.trace_json, name), subject));
  write_file(files.score, with_comments(attempt));
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
