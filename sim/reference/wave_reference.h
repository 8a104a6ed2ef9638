#pragma once

#include <complex>

#include "sim/core/image.h"
#include "sim/core/pose.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns n of sim/model/waves.h: x line, y sample. Without speckle it is 1.
Image<std::complex<double>> scatterers_reference(const ScanLines& lines, const Settings& settings,
                                                 const Pose& patient_from_probe);

/// Returns f of sim/model/waves.h, the echo behind the pulse and the beam.
Image<std::complex<double>> wave_reference(const Image<std::complex<double>>& echo, const ScanLines& lines,
                                           const Settings& settings);

}  // namespace insonate
