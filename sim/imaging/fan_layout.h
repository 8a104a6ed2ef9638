#pragma once

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/core/image.h"
#include "sim/gl/work_division.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

/// Where the pixels of the picture lie among the scan lines. It depends on probe, depth and size, not on the pose.
struct FanLayout {
  static constexpr glm::ivec2 kBlock{64, 4};  ///< pixels that one work group serves, as in fan_blocks.glsl

  ImageGeometry geometry;
  Image<std::uint8_t> inside;              ///< 1 inside the fan
  std::vector<glm::vec2> line_and_sample;  ///< per pixel, continuous positions; (-2, -2) outside the fan
  /// The blocks that the fan touches, counted in blocks. Some that lie outside the picture follow, to fill the last row
  /// of work groups.
  std::vector<glm::ivec2> blocks;
  glm::ivec2 groups{0};  ///< work groups for the blocks: per row, rows

  FanLayout() = default;
  FanLayout(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height,
            const WorkDivision& division = {});

  /// Becomes another layout in place: no new memory is needed for a picture of the same size.
  void lay_out(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height,
               const WorkDivision& division);

  /// Returns how many pixels of the picture lie in those blocks.
  std::size_t pixels_in_blocks() const;
};

/// Returns where a picture's pixels lie among lines that may be steered, as FanLayout::line_and_sample.
std::vector<glm::vec2> places_among(const ScanLines& lines, const ImageGeometry& geometry);

}  // namespace insonate::gl
