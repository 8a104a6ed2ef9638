#pragma once

#include <cstdint>

#include "sim/core/image.h"

namespace insonate {

/// The results of model W's stages (sim/wein/wein_settings.h). The first three lie among the scan lines: x is
/// the line, y the sample. The others have the image's size, and are 0 outside the fan.
template <typename Real>
struct WeinStages {
  Image<Real> intensity;          ///< I, 0 to 1
  Image<Real> scan_echogenicity;  ///< E, scaled by I with WeinSettings::shadows, 0 to 1
  Image<Real> scan_reflection;    ///< R, 0 to 1
  Image<Real> echogenicity;       ///< E, scan-converted: the first term of LC2
  Image<Real> reflection;         ///< R, scan-converted: the second term of LC2
  Image<std::uint8_t> grey;       ///< s R + (1 - s) E, 255 for 1
};

}  // namespace insonate
