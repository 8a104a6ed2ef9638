#pragma once

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/acoustics/spatial_response.h"
#include "sim/acoustics/transducer.h"

namespace insonate::test {

/// Returns the spectrum of a response at a frequency, without what its samples did to it.
inline std::complex<double> spectrum_of(const SampledResponse& response, double frequency_mhz,
                                        const Sampling& sampling) {
  std::complex<double> sum = 0;
  for (std::size_t k = 0; k < response.samples.size(); ++k)
    sum += response.samples[k] *
           std::polar(sampling.step_us(), -glm::two_pi<double>() * frequency_mhz * sampling.step_us() *
                                              double(response.first + std::int64_t(k)));
  return sum / hat_spectrum(frequency_mhz, sampling);
}

/// Returns the bundled transducer of a probe, from the source tree.
inline Transducer shipped(const std::string& probe) {
  return read_transducer(std::filesystem::path(INSONATE_ASSETS_FOLDER) / "transducers" / (probe + ".toml"));
}

/// Returns a rectangle about the origin that faces +y.
inline Rectangle piston(double width_mm, double height_mm) {
  Rectangle rectangle;
  rectangle.width_mm = width_mm;
  rectangle.height_mm = height_mm;
  return rectangle;
}

/// Returns strips that together have the area of a disc about the origin that faces +y.
inline Aperture disc(double radius_mm, int strips) {
  Aperture aperture;
  const double width = 2 * radius_mm / strips;
  // The area of the disc to the left of x, from its middle.
  const auto area = [&](double x) {
    return x * std::sqrt(radius_mm * radius_mm - x * x) + radius_mm * radius_mm * std::asin(x / radius_mm);
  };
  for (int i = 0; i < strips; ++i) {
    const double left = std::max(-radius_mm, -radius_mm + i * width), right = std::min(radius_mm, left + width);
    Rectangle strip = piston(width, (area(right) - area(left)) / width);
    strip.centre.x = (left + right) / 2;
    aperture.push_back(strip);
  }
  return aperture;
}

}  // namespace insonate::test
