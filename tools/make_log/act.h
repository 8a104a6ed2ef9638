#pragma once

#include <string>
#include <vector>

#include "scenarios/action.h"
#include "sim/volume/case.h"

namespace insonate {

/// The actions that a plan's `do` text stands for (make_log_plan.h), in the picture taken from a pose. Throws
/// InputError when the text is none, or names what the case or the picture does not have.
std::vector<Action> made_of(const std::string& doing, const Case& subject, const Pose& patient_from_probe);

}  // namespace insonate
