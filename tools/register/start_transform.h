#pragma once

#include <glm/mat4x4.hpp>

#include <optional>
#include <string>

#include "sim/core/grid.h"
#include "sim/registration/tracked_sweep.h"

namespace insonate {

/// Where a search begins.
struct StartTransform {
  glm::dmat4 ct_from_sweep{1.0};
  std::optional<double> landmark_error_mm;  ///< root mean square, if landmarks were fitted
};

/// Returns the rigid map that fits pairs of points best, in the sense of least squares. The file is text with six
/// numbers per pair: the point in the sweep's frame and the same point in the CT (LPS), mm. Throws InputError if it has
/// fewer than three pairs, if the points of either side lie on a line, or if they do not fit within 30 mm.
StartTransform start_from_landmarks(const std::string& file);

/// Throws InputError if the CT does not hold the region that the sweep shows, or if the sweep looks away from the body.
/// @param ct_file  as the user named it; empty for the built-in patient
void check_start(const std::string& ct_file, const Volume<std::int16_t>& ct, const TrackedSweep& sweep,
                 const glm::dmat4& ct_from_sweep);

}  // namespace insonate
