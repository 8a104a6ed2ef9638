#pragma once

#include <string>
#include <vector>

#include "scenarios/action.h"
#include "sim/volume/case.h"

namespace insonate {

/// Returns the actions that a plan's `do` text describes (plan.h), in the picture taken from a pose. Throws InputError
/// if the text is not valid, or names something that the case or the picture does not have.
std::vector<Action> made_of(const std::string& doing, const Case& subject, const Pose& patient_from_probe);

}  // namespace insonate
