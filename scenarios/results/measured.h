#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/result.h"

namespace insonate {

/// One value of a result, with its score if a criterion judged it.
struct Measured {
  std::optional<std::size_t> step;  ///< counted from 0; empty for the whole exam
  Metric metric{};
  std::optional<double> value;           ///< empty if it was judged but could not be measured
  const CriterionScore* mark = nullptr;  ///< points into the result; nullptr if it was not judged
};

/// Returns every measured or judged value of a result: step by step, then the whole exam, each in the order of
/// metrics(). The values point into `result`.
std::vector<Measured> measured(const ExamResult& result);

}  // namespace insonate
