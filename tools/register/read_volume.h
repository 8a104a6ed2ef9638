#pragma once

#include <glm/vec3.hpp>

#include <string>

#include "tools/register/read_sweep.h"

namespace insonate {

/// Reads a 3D ultrasound volume (NRRD, MetaImage, NIfTI) as the sweep that filled it. Its own geometry is the sweep's
/// frame (LPS). How its planes lie, tilted about a line or parallel, and the fan in them are found from the outline of
/// the voxels that are known (find_swept_planes(), find_fan()): those of 0 and more if a 100th is below, else those
/// above 0. A volume without a fan, such as one that was cropped to a box, is read as parallel slices along the beam,
/// as if a linear probe as wide as the volume had made them. Throws InputError if it cannot be read, if it is too large
/// or too small for a probe, or if it shows nothing.
/// @param beam  the direction in which the sound ran in the middle of the volume, LPS; any length above 0
ReadSweep read_volume_sweep(const std::string& file, const glm::dvec3& beam, const SweepInput& input);

}  // namespace insonate
