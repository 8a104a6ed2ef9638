#pragma once

#include <glm/mat4x4.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "sim/core/grid.h"
#include "sim/registration/free_form_field.h"
#include "sim/registration/tracked_sweep.h"

namespace insonate {

/// The pictures that compare one image of a sweep with the CT. Paths of PNG files.
struct ComparisonPictures {
  std::size_t image = 0;  ///< index into the sweep's images
  std::string ultrasound, ct_before, blend_before, ct_after, blend_after;
  std::string ct_deformed, blend_deformed;  ///< empty without a deformation
};

/// Writes pictures of some images of a sweep, evenly spread among the half that varies most in depth, into a new
/// folder, by their numbers from 1: the ultrasound, the CT's slice in the same plane before and after registration, and
/// both blended: ultrasound in orange, the CT in blue, and white where both are bright. The probe's marker is on the
/// left. Throws InputError if they cannot be written.
/// @param folder       returned paths begin with its last part
/// @param deformation  of the sweep, before the map `after`; null: none
std::vector<ComparisonPictures> write_comparison(const std::filesystem::path& folder, const TrackedSweep& sweep,
                                                 const Volume<std::int16_t>& ct, const glm::dmat4& before,
                                                 const glm::dmat4& after, const FreeFormField* deformation,
                                                 std::size_t count);

}  // namespace insonate
