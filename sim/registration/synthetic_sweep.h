#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/registration/tracked_sweep.h"
#include "sim/tissue/acoustic_volume.h"
#include "sim/tissue/tissue.h"

namespace insonate {

/// Returns the poses of a hand that sweeps a probe over the skin: it tilts the probe about its face along the elevation
/// from -tilt_deg to tilt_deg and slides it by slide_mm meanwhile, both evenly.
/// @param patient_from_probe  the middle of the sweep
std::vector<Pose> hand_sweep(const Pose& patient_from_probe, int images, double tilt_deg, double slide_mm);

/// Returns the sweep that model S, with all its effects, shows of a patient. It is what registration is measured with:
/// its speckle, shadows, attenuation, clutter and noise are not those of model W. Needs an OpenGL context. Throws what
/// gl::Simulator throws.
/// @param patient_from_probe  of each image; they are the sweep's poses too, so the truth is the identity
/// @param width, height       of the images, pixels; they are averages over a picture of three times the size
TrackedSweep synthetic_sweep(const AcousticVolume& volume, const TissueTable& table, const Probe& probe,
                             double depth_mm, const Settings& settings, const std::vector<Pose>& patient_from_probe,
                             int width, int height);

/// Returns the patient after a deformation: the voxel at p holds what the volume has at `moved(p)`, trilinear. Beyond
/// the volume is air. So where a sweep of the result shows p, the truth is `moved(p)` in the volume.
AcousticVolume deformed(const AcousticVolume& volume, const std::function<glm::dvec3(const glm::dvec3&)>& moved);

/// Returns what a breath does to the organs under the probe, as a map for deformed(). The tissue moves by up to most_mm
/// along the patient's z axis and by up to a third of that along y. It does so most at a depth, and hardly in the skin
/// and far away: a Gaussian with a standard deviation of 30 mm about `centre`.
std::function<glm::dvec3(const glm::dvec3&)> breath(const glm::dvec3& centre, double most_mm);

}  // namespace insonate
