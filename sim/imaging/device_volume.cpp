#include "sim/imaging/device_volume.h"

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace insonate::gl {
namespace {

constexpr int kFirst_hu = -1024;  // as in acoustic_volume.glsl
constexpr int kLookupSize = 4096;

// Normalised 16-bit integers are exact. 8 bits would make steps of 16 HU over a CT's 4096. A single such step, as an
// interface of soft tissue, reflects 2e-4, as much as that of an organ.
Texture upload(const AcousticVolume& volume) {
  const glm::ivec3 size = volume.grid.size + 2 * kAirMargin;
  Texture texture = Texture::make_3d(GL_RG16_SNORM, size.x, size.y, size.z, Filter::linear, Wrap::edge);
  texture.write_inside(GL_RG, GL_SHORT, volume.voxels.data(), AcousticVoxel{});
  return texture;
}

// Returns what acoustic_volume.glsl reads per whole HU: the values, and their increase to the next HU.
TexelBuffer tabulate(const TissueTable& table) {
  std::vector<glm::vec4> lookup;
  for (int i = 0; i < kLookupSize; ++i) {
    const TissueKnot knot = table.at(kFirst_hu + i), next = table.at(kFirst_hu + i + 1);
    lookup.emplace_back(knot.impedance_mrayl, knot.absorption_db_cm_mhz, next.impedance_mrayl - knot.impedance_mrayl,
                        next.absorption_db_cm_mhz - knot.absorption_db_cm_mhz);
  }
  return TexelBuffer(GL_RGBA32F, lookup.size(), lookup.data());
}

// Returns the smallest box of indices around all voxels that sound can distinguish from the air outside.
std::pair<glm::ivec3, glm::ivec3> body_box(const AcousticVolume& volume, const TissueTable& table) {
  const AcousticVoxel outside;
  const int densest_air = table.densest_air_hu();
  glm::ivec3 low = volume.grid.size, high(-1);
  std::size_t v = 0;
  for (int z = 0; z < volume.grid.size.z; ++z)
    for (int y = 0; y < volume.grid.size.y; ++y) {
      const auto body = [&](const AcousticVoxel& voxel) {
        return voxel.hu > densest_air || voxel.echogenicity_cdb != outside.echogenicity_cdb;
      };
      const auto row = volume.voxels.begin() + std::ptrdiff_t(v), end = row + volume.grid.size.x;
      v += std::size_t(volume.grid.size.x);
      const auto first = std::find_if(row, end, body);
      if (first == end) continue;
      const auto last = std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(first), body);
      low = glm::min(low, glm::ivec3(int(first - row), y, z));
      high = glm::max(high, glm::ivec3(int(last.base() - row) - 1, y, z));
    }
  return {low, high};
}

}  // namespace

DeviceVolume::DeviceVolume(const AcousticVolume& volume, const TissueTable& table)
    : texture_(upload(volume)), tissue_lookup_(tabulate(table)) {
  // Texels' centres lie at (i + 1/2) / size.
  const glm::dvec3 size(volume.grid.size + 2 * kAirMargin);
  const glm::dmat4 texture_from_index =
      glm::translate(glm::scale(glm::dmat4(1.0), 1.0 / size), glm::dvec3(kAirMargin + 0.5));
  texture_from_patient_ = texture_from_index * glm::inverse(volume.grid.matrix());

  // Interpolation carries a voxel as far as its neighbours' centres.
  const auto [low, high] = body_box(volume, table);
  body_low_ = (glm::dvec3(low + kAirMargin) - 0.5) / size;
  body_high_ = (glm::dvec3(high + kAirMargin) + 1.5) / size;
}

std::pair<double, double> DeviceVolume::meets_body(const glm::dvec3& start, const glm::dvec3& step,
                                                   const glm::dvec3& margin) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (body_high_.x < body_low_.x) return {kFar, -kFar};  // air everywhere
  double first = -kFar, last = kFar;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = body_low_[axis] - margin[axis] - start[axis],
                 high = body_high_[axis] + margin[axis] - start[axis];
    if (step[axis] == 0) {
      if (low > 0 || high < 0) return {kFar, -kFar};
      continue;
    }
    const auto [in, out] = std::minmax({low / step[axis], high / step[axis]});
    first = std::max(first, in);
    last = std::min(last, out);
  }
  return {first, last};
}

}  // namespace insonate::gl
