#include "tests/tools/render/synthetic_ct.h"

#include <cmath>
#include <fstream>

namespace outsider {
namespace {

/// Returns a step from 0 to 1 while `distance` goes from -1.5 to 1.5 mm: interfaces as wide as a scanner shows them.
double step(double distance) {
  return 0.5 + 0.5 * std::tanh(distance / 0.75);
}

double body(const Vec3& p) {
  const double fat = 8 + 1.5 * std::sin(p[0] / 9);
  double hu = -1000 + 900 * step(p[1]);                                              // fat
  hu += 155 * step(p[1] - fat);                                                      // parenchyma
  hu += 12 * std::sin(p[0] / 2.1) * std::sin(p[1] / 1.7 + p[2]);                     // grain
  hu -= 50 * step(9 - std::hypot(p[0] - 12, p[1] - 32));                             // a cyst
  hu += 1500 * step(3 - std::hypot(p[1] - 16, p[2] - 1) - std::abs(p[0] + 22) / 5);  // a rib's end
  return hu;
}

}  // namespace

SyntheticCt::SyntheticCt() {
  origin = {0, 28, 0};
  for (int a = 0; a < 3; ++a) origin = origin - (size[std::size_t(a)] - 1) / 2.0 * axes[std::size_t(a)];
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j)
      for (int i = 0; i < size[0]; ++i)
        voxels.push_back(
            std::int16_t(std::lround(body(origin + double(i) * axes[0] + double(j) * axes[1] + double(k) * axes[2]))));
}

void SyntheticCt::write_nrrd(const std::filesystem::path& file) const {
  std::ofstream stream(file, std::ios::binary);
  stream.precision(17);
  const auto vector = [&](const Vec3& v) { stream << " (" << v[0] << ',' << v[1] << ',' << v[2] << ')'; };
  stream << "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: " << size[0] << ' ' << size[1]
         << ' ' << size[2] << "\nspace directions:";
  for (const Vec3& axis : axes) vector(axis);
  stream << "\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin:";
  vector(origin);
  stream << "\n\n";
  stream.write(reinterpret_cast<const char*>(voxels.data()), std::streamsize(voxels.size() * sizeof(std::int16_t)));
}

}  // namespace outsider
