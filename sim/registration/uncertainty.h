#pragma once

#include <cstddef>
#include <vector>

#include "sim/registration/minimise.h"
#include "sim/registration/motion.h"
#include "sim/registration/tracked_sweep.h"

namespace insonate {

/// How well the similarity fixes the parameters of a registration.
struct Uncertainty {
  bool is_maximum = false;        ///< the similarity falls in every direction; otherwise there are no numbers
  std::vector<double> deviation;  ///< standard deviation per parameter, mm
  double expected_error_mm = 0;   ///< root mean square error over the target points
};

/// Returns how many independent values a sweep's known pixels are worth. Speckle correlates neighbouring pixels: with
/// the correlations r between neighbours along rows and columns, about their mean over 8 x 8 pixels, each pixel counts
/// (1 - r_x) / (1 + r_x) (1 - r_y) / (1 + r_y), as in an autoregressive process of first order.
double independent_pixels(const TrackedSweep& sweep);

/// Returns the uncertainty at a maximum, from the curvature there. `evaluate` returns the share s of the ultrasound's
/// variance that the CT explains. With n independent pixels and normal residuals the log-likelihood is -n/2 ln(1 - s).
/// The inverse of its negative Hessian is the parameters' covariance. The Hessian is one of differences over
/// kCurvatureStep_mm, taken in one call. What the images and the CT differ in besides noise is not in it, so the true
/// errors are larger; docs/registration.md measures by how much.
/// @param targets  in the sweep's frame
Uncertainty uncertainty_at(const Parameters& at, const Motion& motion, const EvaluateAll& evaluate,
                           double independent_pixels, const std::vector<glm::dvec3>& targets);

/// Long enough to bridge the steps of pixels and voxels.
inline constexpr double kCurvatureStep_mm = 1;

}  // namespace insonate
