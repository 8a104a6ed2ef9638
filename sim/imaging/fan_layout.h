#pragma once

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/core/image.h"
#include "sim/gl/work_division.h"
#include "sim/probe/probe.h"

namespace insonate::gl {

/// Where the pixels of the picture lie among the scan lines; changes with probe, depth and size, not with the pose.
struct FanLayout {
  static constexpr glm::ivec2 kBlock{64, 4};  ///< pixels that one work group serves, as in fan_blocks.glsl

  ImageGeometry geometry;
  Image<std::uint8_t> inside;              ///< 1 inside the fan
  std::vector<glm::vec2> line_and_sample;  ///< per pixel, continuous; (-2, -2) outside the fan
  /// Those that the fan touches, counted in blocks; behind them some that lie outside the picture, as far as rows of
  /// work groups are to be filled.
  std::vector<glm::ivec2> blocks;
  glm::ivec2 groups{0};  ///< work groups for the blocks, a row's and rows

  FanLayout() = default;
  FanLayout(const Probe& probe, double depth_mm, const ScanLines& lines, int width, int height,
            const WorkDivision& division = {});

  /// The pixels of the picture in those blocks.
  std::size_t pixels_in_blocks() const;
};

}  // namespace insonate::gl
