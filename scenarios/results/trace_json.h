#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/runner.h"

namespace insonate {

/// What a report draws of a run as JSON: `"format": 1` and a list for each quantity, all equally long, so that it packs
/// well. Numbers with as many digits as bring back the same double; what a point does not know (the pose and the
/// picture of an invalid one, and what is not finite) is null and comes back as in a new TracePoint.
std::string to_json(std::span<const TracePoint> trace);

/// The way back. Throws InputError naming `name` when the text is no such JSON.
std::vector<TracePoint> trace_from_json(std::string_view text, const std::string& name);

}  // namespace insonate
