#pragma once

#include <vector>

#include "sim/acoustics/scan_beam.h"
#include "sim/acoustics/transducer.h"

namespace insonate {

/// The envelope of speckle that the direct sum gives (echo_line()).
struct SpeckleSample {
  std::vector<double> all;          ///< every sample
  std::vector<double> independent;  ///< of places 1.5 axial widths apart, whose speckle is correlated by less than 1 %
};

/// Returns the central line's envelope about the transmit focus, through one uniform_block() after another.
///
/// A block reaches a full width (beam_profile()) to either side of the line, where a focused beam has lost 24 dB. The
/// part of a line reaches `cells` axial widths to either side of the focus. Each depth is divided by the smooth curve,
/// linear in dB, on which speckle falls with the depth. All processors compute.
/// @param per_cell  scatterers per resolution cell at the focus, above 0
/// @param lines     blocks, 1 or more
/// @param cells     1 to 100
SpeckleSample sample_speckle(const Transducer& transducer, const Beamforming& beamforming, double per_cell, int lines,
                             double cells);

}  // namespace insonate
