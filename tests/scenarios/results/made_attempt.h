#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "scenarios/result_json.h"
#include "scenarios/results/attempt.h"
#include "scenarios/results/trace_json.h"
#include "scenarios/runner.h"
#include "tests/core/temporary_folder.h"
#include "tests/scenarios/tiny_case.h"

namespace insonate {

/// A temporary folder for databases, removed at the end.
struct ResultsFolder : TemporaryFolder {
  void clear() const {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  std::filesystem::path operator/(const char* name) const { return path / name; }
};

struct TinyExam {
  ExamResult result;
  std::vector<TracePoint> trace;
  Attempt attempt;  ///< without a learner
};

/// Returns the tiny case's exam, taken with the plane `offset_mm` off the ball: 0 passes, 70 fails.
inline TinyExam tiny_exam(double offset_mm) {
  const Case subject = tiny_case();
  Runner runner(parse_scenario(kTinyScenario, "exam.toml"), subject, tiny_tissues());
  runner.feed(samples_of(25, 30, [&](double t) {
    return turned(0, {1, 0, 0}, {0, 0, offset_mm + 10 * std::exp(-t)});
  }));
  runner.end();
  return {runner.result(), runner.trace(), attempt_of(runner, runner.result(), "")};
}

/// Returns an attempt at that exam, ready for a database. The log may be any bytes.
inline Attempt made_attempt(const std::string& learner, const TinyExam& exam, const std::string& log = "log") {
  Attempt attempt = exam.attempt;
  attempt.learner = learner;
  attempt.finished_ms = 1'795'284'309'250;
  attempt.log = log;
  attempt.pictures = {{0, ReportPicture::Kind::best, "best" + log},
                      {0, ReportPicture::Kind::reference, "reference" + log},
                      {1, ReportPicture::Kind::reference, std::string("\0\x89", 2)}};
  return attempt;
}

}  // namespace insonate
