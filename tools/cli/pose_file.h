#pragma once

#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// Reads a pose file with one or more matrices patient_from_probe, row by row. The file is plain text with 16 numbers
/// per pose, or JSON. The JSON is an array, or an object with the array under "patient_from_probe". The array holds 16
/// numbers per pose, four rows of four, or several such matrices. Each matrix must be a rotation and a translation in
/// mm (why_not_rigid()). Throws InputError.
std::vector<Pose> read_poses(const std::string& file);

/// Reads a file with exactly one pose. Throws InputError for any other number.
Pose read_pose(const std::string& file);

}  // namespace insonate
