#include "scenarios/cases/body.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "sim/model/skin_contact.h"

namespace insonate {
namespace {

constexpr double kPeeled_mm = 3.5;  // removed from each side
constexpr int kRimVoxels = 2;

/// Erosion (or dilation): each voxel becomes the minimum (or maximum) within `radius` voxels along each axis. Values
/// beyond the border equal those on it, so that a body cut by the CT is not eroded there.
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

/// Keeps the largest piece of face-connected voxels. Among equal ones, keeps the first in memory.
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

/// Fills everything that is enclosed in a slice perpendicular to the body's length.
void fill_slices(Volume<std::uint8_t>& mask) {
  const Grid& grid = mask.grid;
  const glm::ivec3 size = grid.size;
  const std::ptrdiff_t strides[3] = {1, size.x, std::ptrdiff_t(size.x) * size.y};
  int across = 2;
  for (const int axis : {0, 1})
    if (std::abs(grid.direction[axis].z) > std::abs(grid.direction[across].z)) across = axis;
  const int a = across == 0 ? 1 : 0, b = across == 2 ? 1 : 2;
  tbb::parallel_for(tbb::blocked_range<int>(0, size[across]), [&](const auto& slices) {
    std::vector<std::uint8_t> outside(std::size_t(size[a]) * std::size_t(size[b]));
    std::vector<glm::ivec2> stack;
    for (int s = slices.begin(); s != slices.end(); ++s) {
      std::fill(outside.begin(), outside.end(), 0);
      std::uint8_t* slice = mask.voxels.data() + s * strides[across];
      const auto visit = [&](int u, int v) {
        if (u < 0 || v < 0 || u >= size[a] || v >= size[b]) return;
        std::uint8_t& mark = outside[std::size_t(v) * std::size_t(size[a]) + std::size_t(u)];
        if (mark || slice[u * strides[a] + v * strides[b]]) return;
        mark = 1;
        stack.emplace_back(u, v);
      };
      for (int u = 0; u < size[a]; ++u)
        for (const int v : {0, size[b] - 1}) visit(u, v);
      for (int v = 0; v < size[b]; ++v)
        for (const int u : {0, size[a] - 1}) visit(u, v);
      while (!stack.empty()) {
        const glm::ivec2 at = stack.back();
        stack.pop_back();
        visit(at.x - 1, at.y);
        visit(at.x + 1, at.y);
        visit(at.x, at.y - 1);
        visit(at.x, at.y + 1);
      }
      for (int v = 0; v < size[b]; ++v)
        for (int u = 0; u < size[a]; ++u)
          slice[u * strides[a] + v * strides[b]] = !outside[std::size_t(v) * std::size_t(size[a]) + std::size_t(u)];
    }
  });
}

}  // namespace

BodyMask find_body(const Volume<std::int16_t>& ct) {
  BodyMask dense{ct.grid, std::vector<std::uint8_t>(ct.voxels.size())};
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) dense.voxels[v] = ct.voxels[v] > kSkinHu;
  const glm::ivec3 radius = glm::ivec3(glm::max(glm::dvec3(1.0), glm::round(kPeeled_mm / ct.grid.spacing)));
  BodyMask body = dense;
  filter_box(body, radius, false);
  keep_largest_piece(body);
  if (std::find(body.voxels.begin(), body.voxels.end(), 1) == body.voxels.end()) return {};
  filter_box(body, radius + 1, true);
  for (std::size_t v = 0; v < body.voxels.size(); ++v) body.voxels[v] &= dense.voxels[v];
  fill_slices(body);
  return body;
}

std::size_t clear_around(const BodyMask& body, Volume<std::int16_t>& ct) {
  BodyMask kept = body;
  filter_box(kept, glm::ivec3(kRimVoxels), true);
  std::atomic<std::size_t> cleared{0};
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ct.voxels.size(), 1u << 18), [&](const auto& range) {
    std::size_t here = 0;
    for (std::size_t v = range.begin(); v != range.end(); ++v) {
      if (kept.voxels[v]) continue;
      here += ct.voxels[v] > kSkinHu;
      ct.voxels[v] = std::int16_t(kAirHu);
    }
    cleared += here;
  });
  return cleared;
}

}  // namespace insonate
