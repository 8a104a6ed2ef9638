#pragma once

#include <glm/vec3.hpp>

#include "sim/core/grid.h"

namespace insonate {

/// A scattering volume (Kutter, Shams, Navab 2009): the envelope S of the scatterers' echo, computed once for a patient
/// and a viewpoint, and sampled where the simulator would otherwise draw scatterers. 1 is the mean in liver. Only the
/// paper's sums use it, without Settings::waves. S is then that of the sample alone: the beam's width is in the volume
/// already.
using StoredSpeckle = Volume<float>;

/// Returns S at a place: trilinear, with a margin of 0 around the grid.
double stored_speckle_at(const StoredSpeckle& speckle, const glm::dvec3& patient_mm);

}  // namespace insonate
