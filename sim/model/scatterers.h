#pragma once

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace insonate {

/// Point scatterers on a cubic lattice that fills space periodically: at each point a complex amplitude whose real and
/// imaginary parts are independent and close to normal, with mean 0 and variance 1.
///
/// Drawn by a counter-based hash and stored as the 16-bit numbers that the GPU is given, so every user sees equal bits.
struct ScattererLattice {
  static constexpr int kSide = 128;      ///< points along an axis before the lattice repeats
  static constexpr double kScale = 4.0;  ///< amplitude = stored / 32767 * kScale

  std::vector<std::int16_t> stored;  ///< kSide^3 pairs (re, im), x fastest
};

ScattererLattice make_scatterers(std::uint32_t seed);

/// Patient mm -> lattice periods. Turned against the patient's axes, so that no scan line or image row runs along the
/// lattice's.
glm::dmat4 lattice_from_patient(double cell_mm);

}  // namespace insonate
