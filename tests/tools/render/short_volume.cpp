#include "tests/tools/render/short_volume.h"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/tools/render/render_program.h"

namespace outsider {

ShortVolume::ShortVolume(const std::filesystem::path& file) {
  const std::string bytes = bytes_of(file);
  const std::size_t end = std::min(bytes.find("\n\n"), bytes.size());
  std::istringstream header(bytes.substr(0, end));
  const auto vector = [](std::istream& from) {
    char mark;
    Vec3 v{};
    from >> mark >> v[0] >> mark >> v[1] >> mark >> v[2] >> mark;
    return v;
  };
  for (std::string line; std::getline(header, line);) {
    std::istringstream value(line.substr(std::min(line.find(": ") + 2, line.size())));
    if (line.starts_with("sizes:")) value >> size[0] >> size[1] >> size[2];
    if (line.starts_with("space origin:")) origin = vector(value);
    if (line.starts_with("space directions:"))
      for (Vec3& axis : step) axis = vector(value);
  }
  const std::size_t count = std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  if (header.str().find("space: left-posterior-superior") == std::string::npos || count == 0 ||
      bytes.size() != end + 2 + 2 * count)
    throw std::runtime_error(file.string() + " is not as documented");
  voxels.resize(count);
  std::memcpy(voxels.data(), bytes.data() + end + 2, 2 * count);
}

double ShortVolume::at(const Vec3& patient_mm, double outside) const {
  double f[3];
  int first[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double index = dot(patient_mm - origin, step[a]) / dot(step[a], step[a]);
    first[a] = int(std::floor(index));
    f[a] = index - first[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int i[3];
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      const int up = corner >> a & 1;
      weight *= up ? f[a] : 1 - f[a];
      i[a] = first[a] + up;
      inside = inside && i[a] >= 0 && i[a] < size[std::size_t(a)];
    }
    sum += weight * (inside ? voxel(i[0], i[1], i[2]) : outside);
  }
  return sum;
}

}  // namespace outsider
