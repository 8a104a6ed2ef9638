#pragma once

#include "tools/register/read_sweep.h"

namespace insonate {

/// Reads a 2D DICOM ultrasound clip with a pose per image (SweepInput::poses) as a sweep. DICOM has no tracking.
///
/// Without SweepInput::probe_from_pixel, the poses are those of the fan: their origin is the middle of the probe's
/// face, x runs along the rows of the images and y along their columns, and the clip's ultrasound region gives the size
/// of a pixel. With it, the poses are those of the probe's frame. Only the region is used; a clip without one is used
/// whole. Throws InputError if there is not one pose per image, if the size of a pixel is not known or differs from
/// that of the matrix by more than 5 %, or if the place of a named probe's face is not known. Throws what read_sweep()
/// throws for images without a fan.
ReadSweep read_dicom_sweep(const SweepInput& input);

}  // namespace insonate
