#pragma once

#include "sim/core/pose.h"
#include "sim/probe/probe.h"

/// What a simulator can be asked to look at. Programs refuse more than this where numbers enter them, with the file and
/// the place; here a caller that lets any through is told so before a picture is made of it.
namespace insonate::gl {

inline constexpr double kLeastDepthMm = 0.1, kMostDepthMm = 1000;

/// From the volume's frame to the probe. Above what a CT's origin may be off by (1e6 mm an axis) and what trackers and
/// the transforms that register them reach beyond it.
inline constexpr double kMostReachMm = 1e7;

/// Throw std::invalid_argument that begins with the simulator's name: for a depth beyond these, or a probe of which a
/// number that places its lines lies outside the range that Probe gives it; and for a pose that is not rigid, not
/// finite or further away.
void check_probe(const char* simulator, const Probe& probe, double depth_mm);
void check_pose(const char* simulator, const Pose& patient_from_probe);

}  // namespace insonate::gl
