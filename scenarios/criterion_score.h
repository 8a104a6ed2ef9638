#pragma once

#include <optional>

#include "scenarios/result.h"
#include "scenarios/scenario.h"

namespace insonate {

/// Returns the score of one criterion. Points fall linearly from `full` to `zero`. Without a value, the criterion earns
/// no points and `why_no_value` gives the reason.
CriterionScore score_criterion(const Criterion& criterion, std::optional<double> value,
                               const std::string& why_no_value = {});

/// Fills the points, percent, passed and reasons of a result from its steps and criterion scores. An exam is passed if
/// the percentage is at least the pass mark and no critical criterion failed.
void decide(ExamResult& result);

}  // namespace insonate
