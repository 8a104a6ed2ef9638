#pragma once

#include "sim/core/image.h"
#include "sim/model/settings.h"
#include "sim/probe/probe.h"

namespace insonate {

/// Returns V of sim/model/reverberation.h before the beam's width, from I and R of the scan lines; all x line, y
/// sample.
Image<double> reverberation_reference(const Image<double>& intensity, const Image<double>& reflection,
                                      const ScanLines& lines, const Settings& settings);

}  // namespace insonate
