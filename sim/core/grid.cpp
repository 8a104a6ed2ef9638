#include "sim/core/grid.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace insonate {

glm::dvec3 Grid::index_from_patient(const glm::dvec3& p) const {
  return (glm::inverse(direction) * (p - origin)) / spacing;
}

glm::dmat4 Grid::matrix() const {
  glm::dmat4 m(direction);
  for (int c = 0; c < 3; ++c) m[c] *= spacing[c];
  m[3] = glm::dvec4(origin, 1.0);
  return m;
}

double sample_trilinear(const Volume<std::int16_t>& ct, const glm::dvec3& index) {
  const glm::dvec3 floor = glm::floor(index);
  if (glm::any(glm::lessThan(floor, glm::dvec3(-1))) ||
      glm::any(glm::greaterThanEqual(floor, glm::dvec3(ct.grid.size))) || !(index.x == index.x))
    return kAirHu;
  const glm::ivec3 base(floor);
  const glm::dvec3 f = index - floor;
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const glm::ivec3 i = base + step;
    const double weight = (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z);
    value += weight * (ct.grid.contains(i) ? double(ct.at(i)) : kAirHu);
  }
  return value;
}

std::uint8_t sample_nearest(const Volume<std::uint8_t>& labels, const glm::dvec3& index) {
  const glm::dvec3 nearest = glm::floor(index + 0.5);
  // Compared before the cast: a position far outside does not fit an int.
  if (!(glm::all(glm::greaterThanEqual(nearest, glm::dvec3(0))) &&
        glm::all(glm::lessThan(nearest, glm::dvec3(labels.grid.size)))))
    return 0;
  return labels.at(glm::ivec3(nearest));
}

}  // namespace insonate
