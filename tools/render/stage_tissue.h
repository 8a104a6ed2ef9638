#pragma once

#include "sim/core/image.h"
#include "sim/model/beam.h"
#include "tools/render/stages.h"

namespace insonate {

/// The tissue at each sample of a plane of lines, as the model defines it: x line, y sample.
struct Tissue {
  Image<float> hounsfield;    ///< trilinear sample of the volume; gel as water
  Image<float> echogenicity;  ///< dB relative to liver
  Image<float> impedance;     ///< MRayl
  Image<float> absorption;    ///< dB/(cm MHz), one way
  Image<float> alpha;         ///< (1)
  Image<float> incidence;     ///< |d . n|, 0 where the gradient is zero
};

/// Returns the tissue along the lines.
/// @param plane  of the slice
Tissue tissue_along(const ScanLines& lines, const RenderedScene& scene, const SlicePlane& plane);

}  // namespace insonate
