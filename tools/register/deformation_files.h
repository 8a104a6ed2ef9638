#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <filesystem>
#include <functional>
#include <string>

#include "sim/core/grid.h"
#include "sim/registration/free_form.h"

namespace insonate {

/// The grids on which both directions of a deformed map are written: all that the field moves, and nothing more.
struct DeformationGrids {
  Grid of_sweep;  ///< in the sweep's frame, voxels of an eighth of the control points' spacing
  Grid of_ct;     ///< the box around what the map makes of that, in the CT, with voxels as large
};
DeformationGrids deformation_grids(const FreeFormField& field, const glm::dmat4& ct_from_sweep);

/// Writes a displacement field as ITK and 3D Slicer read it (NRRD): at each voxel p of the grid, map(p) - p, mm, LPS,
/// 3 floats. Between voxels it is linear, so that an affine map is exact. Beyond the grid ITK and Slicer leave points
/// where they are. Throws InputError if it cannot be written.
void write_displacements(const std::filesystem::path& nrrd_file, const Grid& grid,
                         const std::function<glm::dvec3(const glm::dvec3&)>& map);

/// Returns how a deformation ended, in one sentence: "Deformation: ..." or "No deformation: ...".
std::string sentence_about(const FreeFormRegistration& found);

}  // namespace insonate
