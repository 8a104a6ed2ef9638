#pragma once

#include <string>

#include "sim/core/image.h"
#include "sim/reference/reference.h"
#include "tests/accuracy/spread.h"
#include "tests/accuracy/stress_scene.h"

namespace insonate::test {

/// Compares the stages of echoes that add up as waves (sim/model/waves.h). Returns where they differ by more than
/// allowed; "" if nowhere. Otherwise sets the tolerance of U.
/// @param rounding  rounding_of_waves()
std::string disagreement_of_waves(const Scene& scene, const Stages<double>& expected, const Image<double>& rounding,
                                  const Stages<float>& got, const Spread& spread, Image<double>& fused_tolerance);

}  // namespace insonate::test
