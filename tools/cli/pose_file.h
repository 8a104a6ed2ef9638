#pragma once

#include <string>
#include <vector>

#include "sim/core/pose.h"

namespace insonate {

/// Reads a pose file: the matrices patient_from_probe, row by row. As plain text, 16 numbers each, or as JSON: an
/// array, or an object with the array under "patient_from_probe", of 16 numbers a pose, of four rows of four, or of
/// such matrices. Each is a rotation and a translation in mm, as why_not_rigid() has it. At least one. Throws
/// InputError.
std::vector<Pose> read_poses(const std::string& file);

/// The same of exactly one pose; another number is an InputError.
Pose read_pose(const std::string& file);

}  // namespace insonate
