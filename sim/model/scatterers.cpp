#include "sim/model/scatterers.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "sim/core/hash.h"

namespace insonate {
namespace {

// The sum of four uniform numbers, brought to mean 0 and variance 1: within 3.47 of 0, so it fits kScale.
double nearly_normal(std::uint32_t key) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 4; ++i) sum += unit_float(hash(key, i));
  return (sum - 2.0) * std::sqrt(3.0);
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
