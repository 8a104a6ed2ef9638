#include "sim/view/body/macro_cells.h"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace insonate::view {
namespace {

constexpr std::array<std::int16_t, 2> kHidden{1, 0};  // an empty range: no value lies in it

}  // namespace

MacroCells::MacroCells(const Volume<std::int16_t>& ct) : size_((ct.grid.size + kSide - 1) / kSide) {
  ranges_.resize(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z));
  tbb::parallel_for(0, size_.z, [&](int cz) {
    std::size_t cell = std::size_t(cz) * std::size_t(size_.x) * std::size_t(size_.y);
    for (int cy = 0; cy < size_.y; ++cy)
      for (int cx = 0; cx < size_.x; ++cx, ++cell) {
        // A sample at a cell's face lies between a voxel of the cell and one beyond it.
        const glm::ivec3 first = glm::ivec3(cx, cy, cz) * kSide - 1, end = first + kSide + 2;
        const glm::ivec3 low = glm::max(first, glm::ivec3(0)), high = glm::min(end, ct.grid.size);
        std::int16_t least = 32767, greatest = -32768;
        for (int z = low.z; z < high.z; ++z)
          for (int y = low.y; y < high.y; ++y) {
            const std::int16_t* row = ct.voxels.data() + ct.grid.offset({0, y, z});
            for (int x = low.x; x < high.x; ++x) {
              least = std::min(least, row[x]);
              greatest = std::max(greatest, row[x]);
            }
          }
        if (low != first || high != end) least = std::min(least, std::int16_t(kAir_hu));
        ranges_[cell] = {least, greatest};
      }
  });
}

void MacroCells::hide(const std::vector<std::uint8_t>& hidden) {
  for (std::size_t cell = 0; cell < ranges_.size(); ++cell)
    if (hidden[cell]) ranges_[cell] = kHidden;
}

std::vector<std::uint8_t> MacroCells::occupied(const VisibleRanges& visible) const {
  std::vector<std::uint8_t> occupied(ranges_.size());
  const std::size_t plane = std::size_t(size_.x) * std::size_t(size_.y);
  tbb::parallel_for(0, size_.z, [&](int z) {
    for (std::size_t cell = std::size_t(z) * plane; cell < std::size_t(z + 1) * plane; ++cell) {
      const auto& [least, greatest] = ranges_[cell];
      occupied[cell] = least <= greatest && visible.shows(least, greatest) ? 1 : 0;
    }
  });
  return occupied;
}

}  // namespace insonate::view
