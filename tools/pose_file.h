#pragma once

#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// Reads a pose file: 16 numbers a pose, row-major patient_from_probe, as JSON (an array, or an object with the array
/// under "patient_from_probe") or as plain text. Empty when their count does not fit. Throws InputError.
std::vector<Pose> read_poses(const std::string& file);

/// The same of exactly one pose; another number is an InputError.
Pose read_pose(const std::string& file);

}  // namespace insonate
