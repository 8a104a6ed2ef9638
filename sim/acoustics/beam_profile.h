#pragma once

#include "sim/acoustics/scan_beam.h"
#include "sim/acoustics/transducer.h"

namespace insonate {

/// The resolution cell of a scan line at one distance: full widths of the envelope of a point's echo, mm.
struct BeamProfile {
  double distance_mm = 0;   ///< from the face, along the line
  double axial_mm = 0;      ///< of the envelope in time, times c / 2
  double lateral_mm = 0;    ///< of the envelope's maximum, the point moved across the line in the imaging plane
  double elevation_mm = 0;  ///< the same, moved along the elevation
  double amplitude = 0;     ///< the envelope's maximum on the line, mm^2
};

/// The levels of beam_profile(). For an unapodized aperture at its focus, whose amplitude is sinc^2(x D / (lambda z))
/// both ways, the lateral widths are 0.886 and 0.638 lambda z / D.
inline constexpr double kHalfAmplitude = 0.5;        ///< -6 dB
inline constexpr double kHalfPower = 0.70710678118;  ///< -3 dB

/// Returns the widths at `level` times the maximum. Where an echo or a beam crosses the level several times, a width
/// reaches from the first crossing to the last.
/// @param distance_mm  along the line, 1 to 1000
/// @param level        0.05 to 0.95
BeamProfile beam_profile(const Transducer& transducer, const Beamforming& beamforming, const ScanLine& line,
                         double distance_mm, double level = kHalfAmplitude);

}  // namespace insonate
