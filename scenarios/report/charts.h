#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// Returns an SVG element with charts of distance, angle, insonated target and speed over time, stacked on one time
/// axis. They show the steps, the judged times, the values that earn full points, and tracking losses. Colours are CSS
/// classes of the report's style.
std::string time_charts_svg(const ExamResult& result, std::span<const TracePoint> trace);

}  // namespace insonate
