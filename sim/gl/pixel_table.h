#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

#include "sim/gl/objects.h"

/// Pixels as shared/wein_scan.glsl takes them: shared out to the invocations that convert them.
namespace insonate::gl {

/// Where a pixel lies among the scan lines: behind which sample of a scan; how far, as a float's bits, from there to
/// the next sample and to the next line; what more a stage wants to know.
using PixelPlace = glm::ivec4;
inline const PixelPlace kNowhere(-1, 0, 0, 0);

/// A column an invocation, with a row a step; as many columns as whole groups of so many have.
struct PixelTable {
  PixelTable() = default;
  /// @param filler  below columns that are shorter than others
  /// @param group   invocations of a work group, 1 or more
  PixelTable(const std::vector<std::vector<PixelPlace>>& of_columns, const PixelPlace& filler, std::size_t group);
  explicit operator bool() const { return columns > 0; }

  std::size_t columns = 0, pixels = 0;  ///< pixels: fillers among the columns included
  TexelBuffer places;
};

/// About 64 pixels a column, `together` in one after the other, so that a group takes neighbours at a step; empty
/// without pixels.
/// @param together  what the number of pixels is a multiple of
PixelTable shared_out(const std::vector<PixelPlace>& pixels, std::size_t together, const PixelPlace& filler,
                      std::size_t group);

}  // namespace insonate::gl
