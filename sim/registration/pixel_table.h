#pragma once

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

#include "sim/core/image.h"
#include "sim/gl/objects.h"
#include "sim/imaging/fan_layout.h"
#include "sim/probe/probe.h"

/// Pixels as model W's stages take them (shared/wein_scan.glsl): shared out to the invocations that convert them.
namespace insonate::gl {

/// Where a pixel lies among the scan lines: behind which sample of a scan, -1 outside the fan; how far, as a float's
/// bits, from there to the next sample and to the next line; what more a stage wants to know.
using PixelPlace = glm::ivec4;

/// Of each pixel of the fan's picture, row by row.
/// @param row_samples  from a line of the scan to the next, a line's samples or more
std::vector<PixelPlace> places_in_scan(const FanLayout& fan, const ScanLines& lines, int row_samples);

/// A column an invocation, with a row a step; as many columns as whole groups of so many have.
struct PixelTable {
  std::size_t columns = 0;
  std::size_t pixels = 0;  ///< inside the fan; others fill up words and shorter columns
  TexelBuffer places;

  explicit operator bool() const { return columns > 0; }
};

/// Pixels that a picture's grid holds in a word, stored at once.
inline constexpr int kWordPixels = 4;

/// For wein_picture.comp: the words of a picture that the fan touches, each as its pixels one after the other, of which
/// the first tells where it goes, row and word of the row.
/// @param group  invocations of a work group, 1 or more
PixelTable picture_pixels(const std::vector<PixelPlace>& places, int width, int height, std::size_t group);

/// For lc2_parts.comp: the pixels inside the fan that are numbers, each with its value, brought to mean 0 and variance
/// 1: LC2 feels neither gain nor offset, and single precision would. A flat image has 0 everywhere. With up
/// to kMostPatches patches, and groups of up to 128, no more columns than a texture holds sums of.
/// @param patch  side in pixels of the squares that are compared each by itself, a column each; 0 for the whole
PixelTable compared_pixels(const std::vector<PixelPlace>& places, const Image<float>& image, int patch,
                           std::size_t group);

}  // namespace insonate::gl
