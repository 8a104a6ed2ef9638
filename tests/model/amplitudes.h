#pragma once

#include "sim/model/settings.h"

namespace insonate::test {

/// Returns the trainer's settings with the paper's sums instead of waves: scatterers as amplitudes on a lattice,
/// interfaces as intensities, smoothed in the picture.
inline Settings trainer_with_amplitudes(double frequency_mhz, double depth_mm) {
  Settings settings = trainer_settings(frequency_mhz, depth_mm);
  settings.waves = false;
  settings.f_number = 6;
  settings.speckle_cell_mm = 0.65;
  settings.transmission_sigma_mm = 1;
  return settings;
}

}  // namespace insonate::test
