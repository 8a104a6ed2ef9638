#include "scenarios/cases/body.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "scenarios/cases/mask_filters.h"
#include "sim/tissue/skin_contact.h"

namespace insonate {
namespace {

constexpr double kPeeled_mm = 3.5;  // removed from each side
constexpr int kRimVoxels = 2;

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
  for (std::size_t v = 0; v < ct.voxels.size(); ++v) dense.voxels[v] = ct.voxels[v] > kSkin_hu;
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
      here += ct.voxels[v] > kSkin_hu;
      ct.voxels[v] = std::int16_t(kAir_hu);
    }
    cleared += here;
  });
  return cleared;
}

}  // namespace insonate
