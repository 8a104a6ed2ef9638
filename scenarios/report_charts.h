#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// The drawings of a report, as SVG elements to put into a page. Colours are CSS classes of the report's style.

/// Distance, angle, what the sound reaches, and speed over time, one below the other on one time axis: the steps, the
/// times the pictures are judged by, the values that earn full points, and where tracking was lost.
std::string time_charts_svg(const ExamResult& result, std::span<const TracePoint> trace);

/// The way of the probe's face over the patient, seen from the front and from the feet, in the patient's proportions.
std::string path_charts_svg(const ExamResult& result, std::span<const TracePoint> trace);

}  // namespace insonate
