#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <string>
#include <vector>

#include "sim/core/grid.h"

namespace insonate {

/// A map of points (LPS, mm) as ITK describes it.
struct ItkTransform {
  std::string type;  ///< the name of ITK's class, with its precision and dimensions
  std::vector<double> fixed_parameters;
  std::vector<double> parameters;
};

/// Returns an affine map: the matrix by rows, then the translation. The fixed parameters are its centre, 0.
ItkTransform itk_affine(const glm::dmat4& map);

/// Returns a map as a displacement field: at each voxel p of the grid, map(p) - p. The fixed parameters are the grid's
/// size, origin, spacing and direction matrix by rows. Beyond the grid ITK leaves points where they are.
ItkTransform itk_displacements(const Grid& grid, const std::function<glm::dvec3(const glm::dvec3&)>& map);

/// Returns the text of a .tfm file (Insight Transform File V1.0), with a comment of one line.
std::string as_tfm(const ItkTransform& transform, const std::string& comment);

/// Returns the bytes of an .h5 file (HDF5), as ITK's HDF5TransformIO reads it; equal transforms give equal bytes.
/// @param applied_last_to_first  one transform or more, which become a composite transform
/// @param comment                becomes an attribute of the file
/// Throws std::bad_alloc, and std::runtime_error if the library fails otherwise. Not for several threads at once.
std::string as_hdf5(const std::vector<ItkTransform>& applied_last_to_first, const std::string& comment);

}  // namespace insonate
