#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/result.h"

namespace insonate {

/// One value of a result: what was measured, and the mark if it was judged.
struct Measured {
  std::optional<std::size_t> step;  ///< counted from 0; empty for the whole exam
  Metric metric{};
  std::optional<double> value;           ///< empty when it was judged but could not be measured
  const CriterionScore* mark = nullptr;  ///< in the result; nullptr when it was not judged
};

/// Everything that a result measured or judged, step by step and then the whole exam, each in the order of metrics().
std::vector<Measured> measured(const ExamResult& result);

}  // namespace insonate
