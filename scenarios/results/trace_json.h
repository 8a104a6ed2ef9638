#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/runner.h"

namespace insonate {

/// Returns the curves of a report as JSON: `"format": 1` and one list per quantity, all of equal length, which compress
/// well. Numbers have enough digits to restore the same double. Unknown values are null: the pose and the picture of an
/// invalid point, and values that are not finite. They are read back as in a new TracePoint.
std::string to_json(std::span<const TracePoint> trace);

/// Parses the output of to_json(). Throws InputError naming `name` if the text is not such JSON.
std::vector<TracePoint> trace_from_json(std::string_view text, const std::string& name);

}  // namespace insonate
