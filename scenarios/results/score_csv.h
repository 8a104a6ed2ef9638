#pragma once

#include <string>

#include "scenarios/result.h"
#include "scenarios/results/attempt.h"

namespace insonate {

/// A result as CSV (RFC 4180, UTF-8, decimal points): a header line, then a row for each metric of each step and of
/// the whole exam, so that the files of many attempts can be put one below the other. The columns:
///   attempt, uuid, learner, finished  of the attempt; empty for a score that is in no database
///   mode                              "exam", "practice" or "recording" (attempt_mode.h); empty when nobody said
///   exam, exam_digest                 title and digest of the scenario
///   seed, variant                     what was drawn of it; variant is empty where there are none
///   percent, passed                   of the whole attempt; passed is 1 or 0
///   step, title                       from 1, and its title; both empty for the whole exam
///   metric, unit, value               value is empty when it could not be measured
///   full, zero, weight, critical, points, why   of the criterion; empty where the metric was not judged
/// Numbers have as many digits as bring back the same double. Text that a spreadsheet would take for a formula has an
/// apostrophe in front.
std::string score_csv(const Attempt& attempt, const ExamResult& result);

}  // namespace insonate
