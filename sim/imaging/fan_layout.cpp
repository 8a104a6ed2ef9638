#include "sim/imaging/fan_layout.h"

#include <glm/common.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace insonate::gl {
namespace {

constexpr glm::ivec2 kOutside(1 << 20);  // in blocks: beyond every picture

}  // namespace

FanLayout::FanLayout(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height,
                     const WorkDivision& division) {
  lay_out(probe, depth_mm, lines, width, height, division);
}

void FanLayout::lay_out(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height,
                        const WorkDivision& division) {
  geometry = image_geometry(probe, depth_mm, width, height);
  inside.width = width;
  inside.height = height;
  inside.pixels.resize(std::size_t(width) * std::size_t(height));
  line_and_sample.resize(inside.pixels.size());
  const double dr_mm = lines.dr_mm();
  tbb::parallel_for(0, height, [&](int y) {
    std::uint8_t* is_inside = &inside.at(0, y);
    glm::vec2* place = line_and_sample.data() + (is_inside - inside.pixels.data());
    // A picture's right half is the mirror image of its left one.
    for (int x = 0, mirrored = width - 1; x <= mirrored; ++x, --mirrored) {
      const auto at = line_position(probe, depth_mm, geometry.plane_mm(x, y));
      is_inside[x] = is_inside[mirrored] = at ? 1 : 0;
      place[x] = place[mirrored] = glm::vec2(-2);
      if (!at) continue;
      const double sample = at->r_mm / dr_mm - 0.5;
      place[mirrored] = glm::vec2(probe.lines - 1 - at->line, sample);
      place[x] = glm::vec2(at->line, sample);
    }
  });

  const auto touched = [&](const glm::ivec2& low) {
    for (int y = low.y; y < std::min(low.y + kBlock.y, height); ++y)
      for (int x = low.x; x < std::min(low.x + kBlock.x, width); ++x)
        if (inside.at(x, y)) return true;
    return false;
  };
  blocks.clear();
  for (int y = 0; y * kBlock.y < height; ++y)
    for (int x = 0; x * kBlock.x < width; ++x)
      if (touched(glm::ivec2(x, y) * kBlock)) blocks.emplace_back(x, y);
  groups = division.in_rows(blocks.size());
  blocks.resize(std::size_t(groups.x) * std::size_t(groups.y), kOutside);
}

std::vector<glm::vec2> places_among(const ScanLines& lines, const ImageGeometry& geometry) {
  std::vector<glm::vec2> places(std::size_t(geometry.width) * std::size_t(geometry.height), glm::vec2(-2));
  tbb::parallel_for(0, geometry.height, [&](int y) {
    glm::vec2* place = places.data() + std::size_t(y) * std::size_t(geometry.width);
    for (int x = 0; x < geometry.width; ++x, ++place)
      if (const auto at = position_within(lines, geometry.plane_mm(x, y)))
        *place = glm::vec2(at->line, at->r_mm / lines.dr_mm() - 0.5);
  });
  return places;
}

std::size_t FanLayout::pixels_in_blocks() const {
  std::size_t count = 0;
  for (const glm::ivec2& block : blocks) {
    const glm::ivec2 size = glm::clamp(glm::ivec2(inside.width, inside.height) - block * kBlock, glm::ivec2(0), kBlock);
    count += std::size_t(size.x) * std::size_t(size.y);
  }
  return count;
}

}  // namespace insonate::gl
