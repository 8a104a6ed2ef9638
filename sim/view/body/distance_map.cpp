#include "sim/view/body/distance_map.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace insonate::view {
namespace {

/// Lowers the cells of a row to one more than the least of their neighbours in other rows, and then of the cell before,
/// in the direction of `step`. The rows have a cell more at each end.
void lower(std::uint8_t* row, const std::array<const std::uint8_t*, 4>& others, std::uint8_t* least, int count,
           int step) {
  for (int x = -1; x <= count; ++x) {
    const std::uint8_t a = others[0][x] < others[1][x] ? others[0][x] : others[1][x];
    const std::uint8_t b = others[2][x] < others[3][x] ? others[2][x] : others[3][x];
    least[x] = a < b ? a : b;
  }
  for (int x = 0; x < count; ++x) {
    const std::uint8_t a = least[x - 1] < least[x] ? least[x - 1] : least[x];
    const std::uint8_t b = std::uint8_t((a < least[x + 1] ? a : least[x + 1]) + 1);
    row[x] = b < row[x] ? b : row[x];
  }
  int before = kMaxDistance;
  for (int i = 0, x = step > 0 ? 0 : count - 1; i < count; ++i, x += step)
    row[x] = std::uint8_t(before = std::min(before + 1, int(row[x])));
}

}  // namespace

// Two passes over all cells, each from the neighbours that it has passed already, are exact for this distance
// (Rosenfeld, Pfaltz 1968, "Distance functions on digital pictures").
std::vector<std::uint8_t> distance_map(const glm::ivec3& size, const std::vector<std::uint8_t>& busy) {
  // With a layer of cells around the box that are as far as can be.
  const std::ptrdiff_t row = size.x + 2, plane = row * (size.y + 2);
  std::vector<std::uint8_t> padded(std::size_t(plane) * std::size_t(size.z + 2), kMaxDistance);
  std::vector<std::uint8_t> least(padded.begin(), padded.begin() + row);
  const auto cells_of = [&](int y, int z) { return padded.data() + (z + 1) * plane + (y + 1) * row + 1; };
  const auto offset_of = [&](int y, int z) {
    return (std::ptrdiff_t(z) * size.y + std::ptrdiff_t(y)) * std::ptrdiff_t(size.x);
  };
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      std::transform(busy.begin() + offset_of(y, z), busy.begin() + offset_of(y, z) + size.x, cells_of(y, z),
                     [](std::uint8_t is_busy) { return std::uint8_t(is_busy ? 0 : kMaxDistance); });
  for (const int step : {1, -1})
    for (int j = 0; j < size.z; ++j)
      for (int i = 0; i < size.y; ++i) {
        const int z = step > 0 ? j : size.z - 1 - j, y = step > 0 ? i : size.y - 1 - i;
        std::uint8_t* cells = cells_of(y, z);
        const std::uint8_t* before = cells - step * plane;
        lower(cells, {before - row, before, before + row, cells - step * row}, least.data() + 1, size.x, step);
      }
  std::vector<std::uint8_t> distance(busy.size());
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y) std::copy_n(cells_of(y, z), size.x, distance.begin() + offset_of(y, z));
  return distance;
}

}  // namespace insonate::view
