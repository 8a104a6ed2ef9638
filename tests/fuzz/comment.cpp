// An instructor's comment: the author's id up to the first line break, then the text. What is valid is shown as it is;
// what another program has put into the database must not keep a report from being written.
#include "scenarios/results/database/comment.h"

#include <nlohmann/json.hpp>

#include "scenarios/result_json.h"
#include "scenarios/results/export/report_files.h"
#include "scenarios/results/learner_id.h"
#include "scenarios/results/trace_json.h"
#include "sim/files/files.h"
#include "tests/fuzz/fuzz_target.h"

namespace insonate::fuzz {
namespace {

/// Returns the text of the comment in score.json.
std::string comment_in(const std::filesystem::path& score) {
  return nlohmann::json::parse(read_file(score)).at("comments").at(0).at("text");
}

/// Returns an attempt whose report is short, because only its comments are read here: without what it scored, and
/// without a number, so that no statements are made.
Attempt plain_attempt() {
  const std::filesystem::path scores = std::filesystem::path(INSONATE_FUZZ_CORPORA) / "score";
  ExamResult result = result_from_json(read_file(scores / "passed"), "passed");
  result.steps.clear();
  result.criteria.clear();
  Attempt attempt;
  attempt.learner = "L-01";
  attempt.score_json = to_json(result);
  attempt.trace_json = to_json(std::span<const TracePoint>());
  return attempt;
}

const Target comment_target("comment", [](std::string_view bytes) -> std::string {
  Comment comment;
  const std::size_t end = std::min(bytes.find('\n'), bytes.size());
  comment.author = bytes.substr(0, end);
  comment.text = bytes.substr(std::min(end + 1, bytes.size()));
  comment.number = comment.attempt = 1;
  // Any time, as a damaged database may have it.
  for (const char byte : comment.text) comment.written_ms = std::int64_t(std::uint64_t(comment.written_ms) * 31) + byte;
  bool is_valid = true;
  const std::string broken = broken_by([&]() -> std::string {
    is_valid = false;
    check_comment(comment, "command line");
    is_valid = true;
    return "";
  });
  if (!broken.empty()) return broken;
  if (is_valid !=
      (why_no_comment(comment.text).empty() && (comment.author.empty() || why_no_learner_id(comment.author).empty())))
    return "the check and the reasons disagree";

  static const Attempt plain = plain_attempt();
  Attempt attempt = plain;
  attempt.comments = {comment};
  const ResultFiles files = write_report_files(file_with("report/.made", "").parent_path(), attempt, "");
  if (is_valid && comment_in(files.score) != comment.text) return "the score has another comment";
  return "";
});

}  // namespace
}  // namespace insonate::fuzz
