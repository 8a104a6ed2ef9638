#pragma once

#include <glm/vec3.hpp>

#include <complex>
#include <cstddef>
#include <vector>

#include "sim/acoustics/pulse.h"
#include "sim/acoustics/scan_beam.h"

namespace insonate {

/// A point that scatters equally in all directions and at all frequencies.
struct PointScatterer {
  glm::dvec3 position_mm{0.0};  ///< probe's frame
  double amplitude = 1;

  bool operator==(const PointScatterer&) const = default;
};

/// What a scan line receives. The real part of a sample is the RF signal, the magnitude its envelope (analytic signal).
struct EchoLine {
  double first_us = 0;  ///< time of sample 0 after the transmission
  double step_us = 0.01;
  double speed_mm_us = 1.54;
  std::vector<std::complex<double>> samples;

  double time_us(double k) const { return first_us + k * step_us; }
  /// Returns the distance along the line from which sample k comes.
  double distance_mm(double k) const { return time_us(k) * speed_mm_us / 2; }
  std::vector<double> envelope() const;
};

/// Returns the echo of one scatterer of amplitude 1. It is the pulse convolved with the spatial responses of both
/// apertures (Jensen, J. Acoust. Soc. Am. 89, 1991), attenuated over the point's distance from the line's start, there
/// and back:
///
///     echo(t) = pulse * h_transmit * h_receive,        attenuation: 10^(-a f 2 r / 20), without dispersion
EchoLine point_echo(const ScanBeam& beam, const Pulse& pulse, const glm::dvec3& point_mm);

/// Returns the sum of the echoes of scatterers, of the part of a line from `from_mm` to `to_mm`. Echoes that end before
/// or begin behind that part are left out. The attenuation is interpolated linearly between distances so close that the
/// error is below 0.1 % at the centre frequency.
/// @param from_mm  0 or more, below to_mm
EchoLine echo_line(const ScanBeam& beam, const Pulse& pulse, const std::vector<PointScatterer>& scatterers,
                   double from_mm, double to_mm);

/// Returns echo_line() for each scan line, computed by all processors.
std::vector<EchoLine> echo_lines(const Transducer& transducer, const Beamforming& beamforming,
                                 const std::vector<ScanLine>& lines, const std::vector<PointScatterer>& scatterers,
                                 double from_mm, double to_mm);

}  // namespace insonate
