#pragma once

#include <glm/vec3.hpp>

#include <string>

#include "tools/register/read_sweep.h"

namespace insonate {

/// Reads a 3D ultrasound volume (NRRD, MetaImage, NIfTI) as a sweep of parallel slices along the beam, as if a linear
/// probe as wide as the volume had made them. Its own geometry is the sweep's frame (LPS). Voxels of 0 or less are not
/// known. A fan's lines spread in truth: shadows and attenuation are simulated along the stated direction alone. Throws
/// InputError if it cannot be read, if the volume is too large or too small for a probe, or if it shows nothing.
/// @param beam  the direction in which the sound ran in the middle of the volume, LPS; any length above 0
ReadSweep read_volume_sweep(const std::string& file, const glm::dvec3& beam, const SweepInput& input);

}  // namespace insonate
