#pragma once

#include "sim/core/pose.h"
#include "sim/probe/probe.h"

/// The limits of what a simulator accepts. Programs refuse more than this where numbers enter them, with the file and
/// the place. These checks refuse what a caller lets through, before a picture is made of it.
namespace insonate::gl {

inline constexpr double kMinViewDepth_mm = 0.1, kMaxViewDepth_mm = 1000;

/// Largest distance from the volume's frame to the probe, mm. It exceeds what a CT's origin may be off by (1e6 mm per
/// axis) plus what trackers and their registration transforms can add.
inline constexpr double kMaxDistance_mm = 1e7;

/// Throw std::invalid_argument whose text begins with the simulator's name. check_probe() refuses a depth outside these
/// limits, and a probe with a number for its lines outside the range that Probe documents. check_pose() refuses a pose
/// that is not rigid, not finite or further away.
void check_probe(const char* simulator, const Probe& probe, double depth_mm);
void check_pose(const char* simulator, const Pose& patient_from_probe);

}  // namespace insonate::gl
