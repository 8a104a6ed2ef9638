#include "sim/model/stored_speckle.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

namespace insonate {

double stored_speckle_at(const StoredSpeckle& speckle, const glm::dvec3& patient_mm) {
  const glm::dvec3 index = speckle.grid.index_from_patient(patient_mm), below = glm::floor(index);
  if (glm::any(glm::lessThan(below, glm::dvec3(-1))) ||
      glm::any(glm::greaterThanEqual(below, glm::dvec3(speckle.grid.size))))
    return 0;
  const glm::dvec3 f = index - below;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, corner >> 1 & 1, corner >> 2 & 1), at = glm::ivec3(below) + step;
    if (!speckle.grid.contains(at)) continue;
    sum += (step.x ? f.x : 1 - f.x) * (step.y ? f.y : 1 - f.y) * (step.z ? f.z : 1 - f.z) * double(speckle.at(at));
  }
  return sum;
}

}  // namespace insonate
