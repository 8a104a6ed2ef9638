#include "sim/model/scatterers.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

#include "sim/core/hash.h"

namespace insonate {
namespace {

double nearly_normal(std::uint32_t key) {
  double sum = 0;
  for (std::uint32_t i = 0; i < 4; ++i) sum += unit_float(hash(key, i));
  const double x = (sum - 2.0) * std::sqrt(3.0);
  return (x + ScattererLattice::kTail * (x * x * x - 3 * x)) / std::sqrt(ScattererLattice::kVariance);
}

}  // namespace

ScattererLattice make_scatterers(std::uint32_t seed) {
  constexpr std::uint32_t kPoints =
      std::uint32_t(ScattererLattice::kSide) * ScattererLattice::kSide * ScattererLattice::kSide;
  ScattererLattice lattice;
  lattice.stored.resize(2 * std::size_t(kPoints));
  for (std::uint32_t i = 0; i < 2 * kPoints; ++i)
    lattice.stored[i] = std::int16_t(std::lround(nearly_normal(hash(seed, i)) / kScattererScale * 32767.0));
  return lattice;
}

glm::dmat4 lattice_from_patient(double cell_mm) {
  const glm::dmat4 turned =
      glm::rotate(glm::dmat4(1.0), ScattererLattice::kRotation_rad, glm::normalize(ScattererLattice::kRotationAxis));
  return glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / (cell_mm * ScattererLattice::kSide))) * turned;
}

}  // namespace insonate
