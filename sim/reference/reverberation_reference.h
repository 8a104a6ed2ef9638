#pragma once

#include <complex>

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns V of sim/model/reverberation.h before the beam's width, from I and R of the scan lines; all x line, y
/// sample.
Image<double> reverberation_reference(const Image<double>& intensity, const Image<double>& reflection,
                                      const ScanLines& lines, const Settings& settings);

/// Adds the images of sim/model/mirror_image.h to e of the scan lines, from I and R of the slice's middle plane.
void add_mirror_images(Image<std::complex<double>>& echo, const Image<double>& intensity,
                       const Image<double>& reflection, const ScanLines& lines, const Settings& settings);

}  // namespace insonate
