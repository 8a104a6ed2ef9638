#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

#include "sim/shaders/shared/model_constants.h"

namespace insonate {

/// Point scatterers on a cubic lattice that fills space periodically. Each point has a complex amplitude whose real and
/// imaginary parts are independent and close to normal, with mean 0 and variance 1.
///
/// They are drawn by a counter-based hash and stored as the 16-bit numbers that the GPU receives, so that every user
/// gets the same bits. With the hash of sim/core/hash.h, stored number j is drawn from the key h = hash(seed, j):
///
///     u = sum of unit_float(hash(h, i)), i = 0 to 3               four uniform numbers
///     x = (u - 2) sqrt(3)                                         mean 0, variance 1
///     y = (x + kTail (x^3 - 3 x)) / sqrt(kVariance)
///     stored = y / kScattererScale * 32767, rounded to the nearest
///
/// The third Hermite polynomial, the first term of the Cornish-Fisher expansion, gives y the tails of the normal
/// distribution. Without it the envelope is not Rayleigh distributed. The formula is arithmetic only, so that all
/// machines draw the same bits; |y| is below 3.99.
struct ScattererLattice {
  static constexpr int kSide = 128;              ///< points along an axis before the lattice repeats
  static constexpr double kTail = 0.01625;       ///< gives the signal to noise ratio of a Rayleigh distribution, 1.913
  static constexpr double kVariance = 0.991235;  ///< 1 + 2 kTail (m4 - 3) + kTail^2 (m6 - 6 m4 + 9), m4 = 2.7,
                                                 ///< m6 = 10.9286: the moments of x
  static constexpr double kRotation_rad = 0.6;  ///< rotation of the lattice against the patient's axes, so that no scan
                                                ///< line or image row runs along its axes
  static constexpr glm::dvec3 kRotationAxis{1.0, 0.7, 0.4};  ///< axis of this rotation, right-handed; of any length

  std::vector<std::int16_t> stored;  ///< kSide^3 pairs (re, im), x fastest
};

/// Returns the lattice of a seed, any number.
ScattererLattice make_scatterers(std::uint32_t seed);

/// Returns the map from patient mm to lattice periods: a rotation by kRotation_rad about kRotationAxis, then one period
/// per kSide cells. Point i of an axis is at (i + 1/2) / kSide of a period. Between points, amplitudes are interpolated
/// linearly along the three axes and divided by the root of the sum of the eight squared weights, which keeps their
/// variance at 1.
/// @param cell_mm  distance between two points, above 0
glm::dmat4 lattice_from_patient(double cell_mm);

}  // namespace insonate
