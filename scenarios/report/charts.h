#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// Distance, angle, what the sound reaches, and speed over time, one below the other on one time axis: the steps, the
/// times the pictures are judged by, the values that earn full points, and where tracking was lost. An SVG element to
/// put into a page; colours are CSS classes of the report's style.
std::string time_charts_svg(const ExamResult& result, std::span<const TracePoint> trace);

}  // namespace insonate
