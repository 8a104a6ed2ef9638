#pragma once

#include <complex>
#include <vector>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns n_p of sim/model/waves.h for each slice plane: x line, y sample. Without speckle it is the plane's weight.
std::vector<Image<std::complex<double>>> scatterers_reference(const ScanLines& lines, const Settings& settings,
                                                              const Pose& patient_from_probe);

/// Returns f of sim/model/waves.h, the echo behind the pulse and the beam.
Image<std::complex<double>> wave_reference(const Image<std::complex<double>>& echo, const ScanLines& lines,
                                           const Settings& settings);

}  // namespace insonate
