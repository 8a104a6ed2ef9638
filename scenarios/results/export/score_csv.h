#pragma once

#include <string>

#include "scenarios/result.h"
#include "scenarios/results/attempt.h"

namespace insonate {

/// Returns a result as CSV (RFC 4180, UTF-8, decimal points). After a header line, there is one row for each metric of
/// each step and of the whole exam. So the files of many attempts can be concatenated. The columns:
///   attempt, uuid, learner, finished  of the attempt; empty for a score that is not in a database
///   mode                              "exam", "practice" or "recording" (attempt_mode.h); empty if not recorded
///   exam, exam_digest                 title and digest of the scenario
///   seed, variant                     the seed and the selected variant; variant is empty if there are none
///   percent, passed                   of the whole attempt; passed is 1 or 0
///   step, title                       number from 1, and title; both empty for the whole exam
///   metric, unit, value               value is empty if it could not be measured
///   full, zero, weight, critical, points, why   of the criterion; empty if the metric was not judged
/// Numbers have enough digits to restore the same double. Text that a spreadsheet would read as a formula begins with
/// an apostrophe.
std::string score_csv(const Attempt& attempt, const ExamResult& result);

/// Return the parts of it, for a table of many attempts.
std::string score_csv_head();
std::string score_csv_rows(const Attempt& attempt, const ExamResult& result);

}  // namespace insonate
