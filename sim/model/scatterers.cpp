#include "sim/model/scatterers.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "sim/core/hash.h"

namespace insonate {
namespace {

// The sum of four uniform numbers, brought to mean 0 and variance 1, and its tails drawn out to those of the normal
// distribution by the first term of Cornish and Fisher's expansion, the third Hermite polynomial; without it the
// envelope is no Rayleigh distribution. Arithmetic alone, so that all machines draw equal bits; within 3.99 of 0, so
// that it fits kScale.
double nearly_normal(std::uint32_t key) {
  constexpr double kTail = 0.01625;       // for the signal to noise ratio of a Rayleigh distribution, 1.913
  constexpr double kVariance = 0.991235;  // 1 + 2 kTail (m4 - 3) + kTail^2 (m6 - 6 m4 + 9), m4 = 2.7, m6 = 10.9286
  double sum = 0;
  for (std::uint32_t i = 0; i < 4; ++i) sum += unit_float(hash(key, i));
  const double x = (sum - 2.0) * std::sqrt(3.0);
  return (x + kTail * (x * x * x - 3 * x)) / std::sqrt(kVariance);
}

}  // namespace

ScattererLattice make_scatterers(std::uint32_t seed) {
  constexpr std::uint32_t kPoints =
      std::uint32_t(ScattererLattice::kSide) * ScattererLattice::kSide * ScattererLattice::kSide;
  ScattererLattice lattice;
  lattice.stored.resize(2 * std::size_t(kPoints));
  for (std::uint32_t i = 0; i < 2 * kPoints; ++i)
    lattice.stored[i] = std::int16_t(std::lround(nearly_normal(hash(seed, i)) / ScattererLattice::kScale * 32767.0));
  return lattice;
}

glm::dmat4 lattice_from_patient(double cell_mm) {
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.6, glm::normalize(glm::dvec3(1.0, 0.7, 0.4)));
  return glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / (cell_mm * ScattererLattice::kSide))) * turned;
}

}  // namespace insonate
