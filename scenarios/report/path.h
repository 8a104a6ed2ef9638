#pragma once

#include <span>
#include <string>

#include "scenarios/result.h"
#include "scenarios/runner.h"

namespace insonate {

/// The way of the probe's face over the patient, as HTML to put into a page: seen from the front and from the feet, in
/// the patient's proportions, and a drawing that can be turned with the mouse. Empty without a valid point.
std::string path_html(const ExamResult& result, std::span<const TracePoint> trace);

}  // namespace insonate
