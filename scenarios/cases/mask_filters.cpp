#include "scenarios/cases/mask_filters.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <vector>

namespace insonate {

void filter_box(Volume<std::uint8_t>& mask, const glm::ivec3& radius, bool grow) {
  const glm::ivec3 size = mask.grid.size;
  const std::ptrdiff_t strides[3] = {1, size.x, std::ptrdiff_t(size.x) * size.y};
  for (int axis = 0; axis < 3; ++axis) {
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2, n = size[axis];
    tbb::parallel_for(tbb::blocked_range<int>(0, size[b]), [&](const auto& range) {
      std::vector<std::uint8_t> line(static_cast<std::size_t>(n));
      for (int v = range.begin(); v != range.end(); ++v)
        for (int u = 0; u < size[a]; ++u) {
          std::uint8_t* at = mask.voxels.data() + u * strides[a] + v * strides[b];
          for (int i = 0; i < n; ++i) line[std::size_t(i)] = at[i * strides[axis]];
          // Distance to the last voxel of the spreading value; then the same from the other end.
          const std::uint8_t spreads = grow ? 1 : 0;
          int away = radius[axis] + 1;
          for (int i = 0; i < n; ++i) {
            away = line[std::size_t(i)] == spreads ? 0 : away + 1;
            if (away <= radius[axis]) at[i * strides[axis]] = spreads;
          }
          away = radius[axis] + 1;
          for (int i = n - 1; i >= 0; --i) {
            away = line[std::size_t(i)] == spreads ? 0 : away + 1;
            if (away <= radius[axis]) at[i * strides[axis]] = spreads;
          }
        }
    });
  }
}

void keep_largest_piece(Volume<std::uint8_t>& mask) {
  const glm::ivec3 size = mask.grid.size;
  std::vector<std::uint32_t> piece_of(mask.voxels.size());
  std::vector<std::size_t> stack;
  std::uint32_t pieces = 0, largest = 0;
  std::size_t most = 0;
  for (std::size_t seed = 0; seed < mask.voxels.size(); ++seed) {
    if (!mask.voxels[seed] || piece_of[seed]) continue;
    ++pieces;
    std::size_t count = 0;
    piece_of[seed] = pieces;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::size_t v = stack.back();
      stack.pop_back();
      ++count;
      const int x = int(v % std::size_t(size.x)), y = int(v / std::size_t(size.x) % std::size_t(size.y)),
                z = int(v / (std::size_t(size.x) * std::size_t(size.y)));
      const auto visit = [&](bool there, std::size_t next) {
        if (!there || !mask.voxels[next] || piece_of[next]) return;
        piece_of[next] = pieces;
        stack.push_back(next);
      };
      const std::size_t row = std::size_t(size.x), slice = row * std::size_t(size.y);
      visit(x > 0, v - 1);
      visit(x + 1 < size.x, v + 1);
      visit(y > 0, v - row);
      visit(y + 1 < size.y, v + row);
      visit(z > 0, v - slice);
      visit(z + 1 < size.z, v + slice);
    }
    if (count > most) {
      most = count;
      largest = pieces;
    }
  }
  for (std::size_t v = 0; v < mask.voxels.size(); ++v) mask.voxels[v] = largest != 0 && piece_of[v] == largest;
}

}  // namespace insonate
