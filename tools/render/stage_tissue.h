#pragma once

#include "sim/core/image.h"
#include "sim/model/beam.h"
#include "tools/render/stages.h"

namespace insonate {

/// What the sound meets at each sample of a plane of lines, as the model defines it: x line, y sample.
struct Tissue {
  Image<float> hounsfield;    ///< of the volume, trilinear; gel as water
  Image<float> echogenicity;  ///< dB relative to liver
  Image<float> impedance;     ///< MRayl
  Image<float> absorption;    ///< dB/(cm MHz), one way
  Image<float> alpha;         ///< (1)
  Image<float> incidence;     ///< |d . n|, 0 where nothing rises
};

/// @param plane  of the slice, beside the imaging plane or in it
Tissue tissue_along(const ScanLines& lines, const RenderedScene& scene, const SlicePlane& plane);

}  // namespace insonate
