#include "tests/tools/render/synthetic_ct.h"

#include <cmath>
#include <fstream>

namespace outsider {
namespace {

/// From 0 to 1 while `distance` goes from -1.5 to 1.5 mm: interfaces as wide as a scanner draws them.
double step(double distance) {
  return 0.5 + 0.5 * std::tanh(distance / 0.75);
}

double body(const Vec3& p) {
  const double fat = 8 + 1.5 * std::sin(p[0] / 9);
  double hu = -1000 + 900 * step(p[1]);                                             // fat
  hu += 155 * step(p[1] - fat);                                                     // parenchyma
  hu += 12 * std::sin(p[0] / 2.1) * std::sin(p[1] / 1.7 + p[2]);                    // grain
  hu -= 50 * step(9 - std::hypot(p[0] - 12, p[1] - 32));                            // a cyst
  hu += 500 * step(3 - std::hypot(p[1] - 16, p[2] - 1) - std::abs(p[0] + 22) / 5);  // a rib's end
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

double SyntheticCt::hounsfield(const Vec3& patient_mm) const {
  const Vec3 p = patient_mm - origin;
  double f[3];
  int i[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double index = dot(p, axes[a]);  // the axes are orthonormal and a voxel is 1 mm
    i[a] = int(std::floor(index));
    f[a] = index - i[a];
  }
  double hu = 0;
  for (int dk = 0; dk < 2; ++dk)
    for (int dj = 0; dj < 2; ++dj)
      for (int di = 0; di < 2; ++di) {
        const int u = i[0] + di, v = i[1] + dj, w = i[2] + dk;
        const bool inside = u >= 0 && v >= 0 && w >= 0 && u < size[0] && v < size[1] && w < size[2];
        hu += (di ? f[0] : 1 - f[0]) * (dj ? f[1] : 1 - f[1]) * (dk ? f[2] : 1 - f[2]) *
              (inside ? voxels[std::size_t((w * size[1] + v) * size[0] + u)] : -1000);
      }
  return hu;
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
