#pragma once

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <string>

#include "sim/core/grid.h"
#include "sim/registration/free_form.h"
#include "tools/register/itk_transform.h"

namespace insonate {

/// The grids on which both directions of a deformed map are written: all that the field moves, and nothing more.
struct DeformationGrids {
  Grid of_sweep;  ///< in the sweep's frame, voxels of an eighth of the control points' spacing
  Grid of_ct;     ///< the box around what the map makes of that, in the CT, with voxels as large
};
DeformationGrids deformation_grids(const FreeFormField& field, const glm::dmat4& ct_from_sweep);

/// Writes the displacements of itk_displacements(grid, ...) as ITK and 3D Slicer read an image of vectors (NRRD): 3
/// floats per voxel. Between voxels they are linear, so that an affine map is exact. Throws InputError if it cannot be
/// written.
void write_displacements(const std::filesystem::path& nrrd_file, const Grid& grid, const ItkTransform& displacements);

/// Returns how a deformation ended, in one sentence: "Deformation: ..." or "No deformation: ...".
std::string sentence_about(const FreeFormRegistration& found);

}  // namespace insonate
