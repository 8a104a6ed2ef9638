#include "sim/core/grid.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

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
  // Compare before the cast: a position far outside does not fit an int.
  if (!(glm::all(glm::greaterThanEqual(index, glm::dvec3(-1))) &&
        glm::all(glm::lessThan(index, glm::dvec3(ct.grid.size)))))
    return kAir_hu;
  const glm::ivec3 base(floor_of(index.x), floor_of(index.y), floor_of(index.z));
  const glm::dvec3 f = index - glm::dvec3(base), g = 1.0 - f;
  const double weights[8] = {g.x * g.y * g.z, f.x * g.y * g.z, g.x * f.y * g.z, f.x * f.y * g.z,
                             g.x * g.y * f.z, f.x * g.y * f.z, g.x * f.y * f.z, f.x * f.y * f.z};
  const bool inside = ct.grid.contains(base) && ct.grid.contains(base + 1);
  const std::size_t row = std::size_t(ct.grid.size.x), slice = row * std::size_t(ct.grid.size.y);
  const std::int16_t* first = inside ? ct.voxels.data() + ct.grid.offset(base) : nullptr;
  double value = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const glm::ivec3 at = base + glm::ivec3(x, y, z);
    const double hu = inside ? first[z * slice + y * row + x] : ct.grid.contains(at) ? ct.at(at) : kAir_hu;
    value += weights[corner] * hu;
  }
  return value;
}

std::uint8_t sample_nearest(const Volume<std::uint8_t>& labels, const glm::dvec3& index) {
  const glm::dvec3 rounded = index + 0.5;
  if (!(glm::all(glm::greaterThanEqual(rounded, glm::dvec3(0))) &&
        glm::all(glm::lessThan(rounded, glm::dvec3(labels.grid.size)))))
    return 0;
  return labels.at(glm::ivec3(rounded));
}

}  // namespace insonate
