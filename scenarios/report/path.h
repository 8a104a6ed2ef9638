#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// Returns the path of the probe's face over the patient as HTML for a page. It contains views from the front and from
/// the feet, to scale, and a drawing that the reader can rotate with the mouse. Empty without a valid point.
std::string path_html(const ExamResult& result, std::span<const TracePoint> trace);

}  // namespace insonate
