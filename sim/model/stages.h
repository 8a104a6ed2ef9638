#pragma once

#include <cstdint>

#include "sim/core/image.h"

namespace insonate {

/// What crosses the stages of model S, for those who check or take apart a picture.
///
/// The first six lie among the scan lines: x is the line, y the sample. The last three are as the picture.
template <typename Real>
struct Stages {
  Image<Real> intensity;        ///< I, 0 to 1 (5)
  Image<Real> reflection;       ///< R before the beam's width, 0 to 1 (3)
  Image<Real> reflection_beam;  ///< R after it (4)
  Image<Real> transmission;     ///< T of (6): I, or I^2 where the echo's way back counts
  Image<Real> repeated;         ///< V behind the beam's width, of reverberation.h; 0 where there is none
  Image<Real> speckle;          ///< S: envelope of the scatterers' echo, mean 1 in liver
  Image<Real> fused;            ///< U (6), before gain
  Image<std::uint8_t> inside;   ///< 1 inside the fan
  Image<std::uint8_t> grey;     ///< after log compression (7), 0 to 255
};

}  // namespace insonate
