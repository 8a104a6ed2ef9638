#pragma once

#include <optional>

#include "scenarios/result.h"
#include "scenarios/scenario.h"

namespace insonate {

/// The mark of one criterion: points fall on a straight line from `full` to `zero`. Without a value there are none, and
/// `why_no_value` says why.
CriterionScore score_criterion(const Criterion& criterion, std::optional<double> value,
                               const std::string& why_no_value = {});

/// Adds up the marks, decides, and gives the reasons: fills points, percent, passed and reasons of a result whose steps
/// and marks are there. An exam is passed when the percentage reaches the pass mark and no critical criterion failed.
void decide(ExamResult& result);

}  // namespace insonate
