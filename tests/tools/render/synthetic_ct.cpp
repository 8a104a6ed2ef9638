#include "tests/tools/render/synthetic_ct.h"

#include <cmath>

namespace insonate::test {
namespace {

/// Returns a step from 0 to 1 while `distance` goes from -1.5 to 1.5 mm: interfaces as wide as a scanner shows them.
double step(double distance) {
  return 0.5 + 0.5 * std::tanh(distance / 0.75);
}

double body(const glm::dvec3& p) {
  const double fat = 8 + 1.5 * std::sin(p.x / 9);
  double hu = -1000 + 900 * step(p.y);                                            // fat
  hu += 155 * step(p.y - fat);                                                    // parenchyma
  hu += 12 * std::sin(p.x / 2.1) * std::sin(p.y / 1.7 + p.z);                     // grain
  hu -= 50 * step(9 - std::hypot(p.x - 12, p.y - 32));                            // a cyst
  hu += 1500 * step(3 - std::hypot(p.y - 16, p.z - 1) - std::abs(p.x + 22) / 5);  // a rib's end
  return hu;
}

}  // namespace

Volume<std::int16_t> synthetic_ct() {
  Volume<std::int16_t> ct;
  ct.grid.size = {150, 112, 48};
  ct.grid.direction = {{0.96, 0.28, 0}, {-0.28, 0.96, 0}, {0, 0, -1}};
  ct.grid.origin = glm::dvec3(0, 28, 0) - ct.grid.direction * ((glm::dvec3(ct.grid.size) - 1.0) / 2.0);
  for (int k = 0; k < ct.grid.size.z; ++k)
    for (int j = 0; j < ct.grid.size.y; ++j)
      for (int i = 0; i < ct.grid.size.x; ++i)
        ct.voxels.push_back(std::int16_t(std::lround(body(ct.grid.patient_from_index({i, j, k})))));
  return ct;
}

}  // namespace insonate::test
